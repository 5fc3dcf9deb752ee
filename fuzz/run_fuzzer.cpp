// Reports (JSON of igsp align --report): all that the page needs, or a refusal, whatever the bytes.
#include "fuzzing.hpp"
#include "report/run.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const igsp::cli::Json run = igsp::cli::read_run(igsp::fuzzing::input_file(data, size, ".json"));
    igsp::fuzzing::require(run.contains("verdict") && run["source"].contains("points"));
  } catch (const igsp::FileError&) {
  }
  return 0;
}
