// Option files: options that print as a file that reads the same, or a refusal, whatever the bytes.
#include "config/toml_file.hpp"
#include "fuzzing.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const igsp::Options options = igsp::options_from_toml({reinterpret_cast<const char*>(data), size}, "fuzz.toml");
    const std::string text = igsp::options_to_toml(options);
    igsp::fuzzing::require(igsp::options_to_toml(igsp::options_from_toml(text, "printed.toml")) == text);
  } catch (const igsp::FileError&) {
  } catch (const igsp::InvalidArgument&) {
  }
  return 0;
}
