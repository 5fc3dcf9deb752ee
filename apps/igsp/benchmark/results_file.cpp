#include "benchmark/results_file.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>

#include "files/output_file.hpp"
#include "igsp/errors.hpp"

namespace igsp::cli {

ResultsFile::ResultsFile(const std::filesystem::path& path, const std::vector<BenchmarkRow>& rows) : path_(path) {
  write_results(path, rows);
  file_ = std::fopen(path.c_str(), "ab");
  if (file_ == nullptr) fail(errno);
}

ResultsFile::~ResultsFile() {
  if (file_ != nullptr) std::fclose(file_);
}

void ResultsFile::add(const BenchmarkRow& row) {
  const std::string line = results_line(row);
  if (std::fwrite(line.data(), 1, line.size(), file_) != line.size() || std::fflush(file_) != 0) fail(errno);
}

void ResultsFile::fail(int error_number) const {
  throw FileError(fmt::format("{}: {}", path_.string(), std::strerror(error_number)));
}

void write_results(const std::filesystem::path& path, const std::vector<BenchmarkRow>& rows) {
  std::string text = results_header();
  for (const BenchmarkRow& row : rows) text += results_line(row);
  write_text(path, text);
}

}  // namespace igsp::cli
