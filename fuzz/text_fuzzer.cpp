// Text files of points, with and without the columns named by the caller: points or a refusal, whatever the bytes.
#include "fuzzing.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto path = igsp::fuzzing::input_file(data, size, ".txt");
  igsp::fuzzing::check_reader(path);
  try {
    igsp::read_points(path, {.columns = {"2", "3", "1"}});
  } catch (const igsp::FileError&) {
  }
  return 0;
}
