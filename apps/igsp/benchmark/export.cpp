#include "benchmark/export.hpp"

#include <fmt/format.h>

#include <iostream>

#include "benchmark/pair.hpp"
#include "files/csv.hpp"
#include "files/output_file.hpp"
#include "igsp/errors.hpp"
#include "igsp/io.hpp"
#include "io/number_text.hpp"
#include "shell/interrupt.hpp"

namespace igsp::cli {
namespace {

namespace fs = std::filesystem;

std::string text_of(double number) {
  std::string text;
  io::append_number(text, number);
  return text;
}

std::optional<BenchmarkPair> try_read(const BenchmarkCase& one) {
  try {
    return read_pair(one);
  } catch (const FileError& error) {
    stop_if_interrupted();  // a read that was interrupted fails as a file does
    std::cerr << fmt::format("igsp: {}: left out: {}\n", one.name, error.what());
    return std::nullopt;
  }
}

std::string text_of(const std::optional<Eigen::Vector3d>& viewpoint) {
  if (!viewpoint) return "";
  return text_of(viewpoint->x()) + " " + text_of(viewpoint->y()) + " " + text_of(viewpoint->z());
}

// The line of the list; the names of cases make poor names of files, so those are numbered.
std::string write_case(const BenchmarkCase& one, const BenchmarkPair& pair, const fs::path& folder,
                       std::size_t number) {
  const auto file = [&](const char* what) { return fmt::format("{:03}_{}", number, what); };
  const bool known = one.truth == Truth::known;
  const WriteOptions options{.format = FileFormat::ply_binary_little_endian};
  write_points(folder / file("source.ply"), pair.source.points, options);
  write_points(folder / file("target.ply"), pair.target.points, options);
  if (known) write_transformation(folder / file("truth.txt"), pair.target_from_scrambled());
  return csv_line({one.name, one.group, file("source.ply"), file("target.ply"),
                   known ? file("truth.txt") : std::string(to_string(one.truth)), text_of(one.max_rotation_error_deg),
                   text_of(one.max_displacement), text_of(pair.source.viewpoint.viewpoint),
                   text_of(pair.target.viewpoint.viewpoint)});
}

}  // namespace

std::size_t export_cases(const std::vector<BenchmarkCase>& cases, const std::optional<std::uint64_t>& seed,
                         const fs::path& folder) {
  make_folder(folder);
  check_writable(folder / "cases.csv");
  std::string list = csv_line({"name", "group", "source", "target", "truth", "max_rotation_error_deg",
                               "max_translation_error_m", "source_viewpoint", "target_viewpoint"});
  std::size_t written = 0;
  for (const BenchmarkCase& one : cases) {
    stop_if_interrupted();
    std::optional<BenchmarkPair> pair = try_read(one);
    if (!pair) continue;
    if (seed) scramble_source(*pair, one, *seed);
    list += write_case(one, *pair, folder, ++written);
  }
  write_text(folder / "cases.csv", list);
  return written;
}

}  // namespace igsp::cli
