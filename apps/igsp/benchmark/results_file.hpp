#pragma once

#include <cstdio>
#include <filesystem>
#include <vector>

#include "benchmark/results.hpp"

namespace igsp::cli {

/// results.csv while a benchmark runs: every row is on the disk when add() returns. Throws FileError.
class ResultsFile {
 public:
  /// Replaces the file by the header and these rows.
  ResultsFile(const std::filesystem::path& path, const std::vector<BenchmarkRow>& rows);
  ~ResultsFile();
  ResultsFile(const ResultsFile&) = delete;
  ResultsFile& operator=(const ResultsFile&) = delete;

  void add(const BenchmarkRow& row);

 private:
  [[noreturn]] void fail(int error_number) const;

  std::filesystem::path path_;
  std::FILE* file_ = nullptr;
};

/// The whole file at once, or not at all.
void write_results(const std::filesystem::path& path, const std::vector<BenchmarkRow>& rows);

}  // namespace igsp::cli
