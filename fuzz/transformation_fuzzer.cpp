// Transformation files: a rigid motion or a refusal, whatever the bytes.
#include "fuzzing.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const auto motion = igsp::read_transformation(igsp::fuzzing::input_file(data, size, ".txt"));
    igsp::fuzzing::require(motion.matrix().allFinite() && motion.linear().determinant() > 0.9);
  } catch (const igsp::FileError&) {
  }
  return 0;
}
