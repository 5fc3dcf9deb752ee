// Lists of pairs (CSV): rows as long as the header, or a refusal, whatever the bytes.
#include "files/csv.hpp"
#include "fuzzing.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto path = igsp::fuzzing::input_file(data, size, ".csv");
  for (const auto last_line : {igsp::cli::LastLine::any, igsp::cli::LastLine::ended}) {
    try {
      const igsp::cli::CsvTable table = igsp::cli::read_csv(path, last_line);
      for (const auto& record : table.records) igsp::fuzzing::require(record.fields.size() == table.header.size());
    } catch (const igsp::FileError&) {
    }
  }
  return 0;
}
