// LAS files: points, a moved copy that reads back, or a refusal, whatever the bytes.
#include <cmath>

#include "fuzzing.hpp"
#include "io/moved_copy.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace igsp;
  const auto path = fuzzing::input_file(data, size, ".las");
  fuzzing::check_reader(path);
  Transformation motion = Transformation::Identity();
  motion.linear() = Eigen::AngleAxisd(0.7, Eigen::Vector3d(2, -3, 9).normalized()).toRotationMatrix();
  motion.translation() = Eigen::Vector3d(1250.25, -310.5, 12.125);
  const auto moved = path.string() + ".moved.las";
  try {
    io::write_moved(path, moved, motion);
    fuzzing::require(read_points(path).points.size() == read_points(moved).points.size());
    io::other_properties(path);
  } catch (const FileError&) {
  }
  return 0;
}
