// PLY files: points or a refusal, whatever the bytes.
#include "fuzzing.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  igsp::fuzzing::check_reader(igsp::fuzzing::input_file(data, size, ".ply"));
  return 0;
}
