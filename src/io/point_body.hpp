#pragma once

#include <cstdint>
#include <optional>
#include <variant>

#include "igsp/io.hpp"
#include "io/binary_records.hpp"
#include "io/file_format.hpp"
#include "io/input_file.hpp"
#include "io/las_header.hpp"
#include "io/text_table.hpp"

namespace igsp::io {

/// Points of a LAS file, of which `header.count` are still to be read.
struct LasRecords {
  LasHeader header;
  bool keep_noise = false;

  void fill(InputFile& file, Chunk& chunk);
};

/// A file whose header is read and whose points come next.
struct PointBody {
  FileFormat format = FileFormat::text;
  std::uint64_t declared_points = 0;
  std::optional<Eigen::Vector3d> viewpoint;  ///< what the header says of it
  std::variant<TextTable, FixedRecords, ListRecords, ColumnRecords, LasRecords> records = {};
};

PointBody open_ply(InputFile& file);
PointBody open_pcd(InputFile& file);
PointBody open_las(InputFile& file, bool keep_noise);
/// `columns` as in ReadOptions.
PointBody open_text(InputFile& file, const std::vector<std::string>& columns);

/// What the file is: by its content or, for text, the extension. To be called before anything is read. Fails for a file
/// that is not what its extension says.
FormatFamily find_family(InputFile& file);

/// Any of them.
PointBody open_body(InputFile& file, const ReadOptions& options);

}  // namespace igsp::io
