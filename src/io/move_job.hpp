#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "igsp/point_cloud.hpp"
#include "igsp/progress.hpp"
#include "io/atomic_file.hpp"
#include "io/input_file.hpp"
#include "io/moved_copy.hpp"

namespace igsp::io {

/// A moved copy in the making: what is read, what moves it, and what is written, through one buffer.
class MoveJob {
 public:
  MoveJob(InputFile& source, AtomicFile& destination, const Transformation& destination_from_source,
          const MoveOptions& options)
      : file(source),
        transformation(destination_from_source),
        viewpoint(options.viewpoint),
        destination_(destination),
        progress_(options.progress) {}

  InputFile& file;
  const Transformation& transformation;
  const std::optional<Eigen::Vector3d>& viewpoint;  ///< see MoveOptions
  std::string bytes;  ///< to be written; append here, then call flush_if_full or flush

  void flush_if_full();
  /// Writes the buffer and tells the progress. Throws Cancelled.
  void flush();

  /// The lines that `file` has consumed so far, each as `edited` returns it.
  void copy_lines_read(const std::function<std::string(std::string_view line)>& edited);
  /// The next `count` bytes of the file as they are.
  void copy(std::uint64_t count);
  /// All that is left of the file as it is.
  void copy_rest();

 private:
  AtomicFile& destination_;
  const ProgressCallback& progress_;
};

/// One for each family of formats; all that the file holds is read through and written. They return whether coordinates
/// are of another type than in the file.
bool move_ply(MoveJob& job, bool doubles);
bool move_pcd(MoveJob& job, bool doubles);
/// Coordinates are computed anew on a grid of the same resolution where that holds them; every other byte is a copy,
/// save the direction of waveforms, which turns.
void move_las(MoveJob& job);
void move_text(MoveJob& job, const std::vector<std::string>& columns);

}  // namespace igsp::io
