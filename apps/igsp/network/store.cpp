#include "network/store.hpp"

#include <fmt/format.h>

#include <charconv>
#include <fstream>

#include "files/foreign_formats.hpp"
#include "files/output_file.hpp"
#include "igsp/archive.hpp"
#include "igsp/errors.hpp"
#include "igsp/version.hpp"
#include "network/fingerprint.hpp"
#include "report/json.hpp"

namespace igsp::cli {
namespace {

namespace fs = std::filesystem;

// Neither changes an answer.
Options what_matters(Options options) {
  options.threads = 0;
  return options;
}

// A full disk must not end a run whose answer may still fit: what is not kept is made again.
template <typename Write>
void if_possible(const Write& write) {
  try {
    write();
  } catch (const FileError&) {
  }
}

template <typename Read>
auto if_readable(const fs::path& path, const Read& read) -> std::optional<decltype(read(path))> {
  std::error_code ignored;
  if (!fs::exists(path, ignored)) return {};
  try {
    return read(path);
  } catch (const FileError&) {
    return {};  // of another version, or damaged: made again
  }
}

std::string text_of(const ScanReading& reading, std::size_t scan) {
  std::string text = fmt::format("{} {}", reading.max_points, fmt::join(reading.read.columns, ","));
  if (reading.read.keep_noise) text += " with noise";
  const auto viewpoint = reading.viewpoints.find(reading.files[scan]);
  if (viewpoint == reading.viewpoints.end()) return text;
  const Eigen::Vector3d& place = viewpoint->second;
  return text + fmt::format(" seen from {} {} {}", place.x(), place.y(), place.z());
}

}  // namespace

Result without_details(Result result) {
  result.source_keypoints.clear();
  result.target_keypoints.clear();
  result.iterations.clear();
  result.timings_s.clear();
  return result;
}

NetworkStore::NetworkStore(const fs::path& folder, const ScanReading& reading, const Options& options, Engine& engine)
    : folder_(folder / method_number),
      reading_(reading),
      options_(options),
      engine_(engine),
      keys_(reading.files.size()) {
  make_folder(folder_ / "features");
  make_folder(folder_ / "pairs");
  options_text_ = fmt::format("{} {}", version, to_json(what_matters(options_)).dump());
}

double NetworkStore::voxel_size() const {
  std::ifstream file(folder_ / ("voxel_size_" + fingerprint(options_text_)));
  std::string text;
  double number = 0;
  if (!std::getline(file, text)) return 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc{} && number > 0 ? number : 0;
}

void NetworkStore::keep_voxel_size(double voxel_size) {
  write_text(folder_ / ("voxel_size_" + fingerprint(options_text_)), fmt::format("{}\n", voxel_size));
}

void NetworkStore::use_voxel_size(double voxel_size) {
  options_.scale.voxel_size = voxel_size;
  options_text_ = fmt::format("{} {}", version, to_json(what_matters(options_)).dump());
}

fs::path NetworkStore::features_file(std::size_t scan, const ProgressCallback& progress) {
  const fs::path& file = reading_.files[scan];
  if (keys_[scan].empty()) {
    keys_[scan] =
        fingerprint(engine_.fingerprint(scan, progress) + (file_of_scan(file) == file ? "" : file.filename().string()) +
                    text_of(reading_, scan) + options_text_);
  }
  return folder_ / "features" / keys_[scan];
}

void NetworkStore::expect_features(const ProgressCallback& progress) {
  std::vector<std::size_t> missing;
  for (std::size_t i = 0; i < reading_.files.size(); ++i) {
    try {
      if (!fs::exists(features_file(i, progress))) missing.push_back(i);
    } catch (const FileError&) {
      // Said where its features are asked for.
    }
  }
  engine_.expect(missing, options_);
}

Features NetworkStore::features(std::size_t scan, const ProgressCallback& progress) {
  const fs::path kept = features_file(scan, progress);
  if (auto features = if_readable(kept, [](const fs::path& path) { return igsp::read_features(path); })) {
    ++features_taken_;
    return std::move(*features);
  }
  Features features = engine_.features(scan, options_, progress);
  if_possible([&] { write_features(kept, features); });
  return features;
}

fs::path NetworkStore::pair_file(std::size_t source, std::size_t target) const {
  return folder_ / "pairs" / fingerprint(keys_[source] + keys_[target]);
}

void NetworkStore::keep(std::size_t source, std::size_t target, const Result& result) const {
  if_possible([&] { write_result(pair_file(source, target), without_details(result)); });
}

void NetworkStore::register_elsewhere(std::span<const ScanPair> pairs, const std::function<void(double)>& report) {
  std::vector<ScanPair> missing;
  for (const auto& [source, target] : pairs) {
    std::error_code ignored;
    if (!fs::exists(pair_file(source, target), ignored)) missing.emplace_back(source, target);
  }
  if (missing.empty()) return;
  engine_.register_pairs(
      missing, options_, [&](const ScanPair& pair, const Result& result) { keep(pair.first, pair.second, result); },
      report);
}

PairStore NetworkStore::pairs() {
  return {
      [this](std::size_t source, std::size_t target) {
        return if_readable(pair_file(source, target), [](const fs::path& path) { return read_result(path); });
      },
      [this](std::size_t source, std::size_t target, const Result& result) { keep(source, target, result); },
      [this](std::span<const ScanPair> pairs, const std::function<void(double)>& report) {
        register_elsewhere(pairs, report);
      },
  };
}

}  // namespace igsp::cli
