#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "igsp/network.hpp"
#include "network/engine.hpp"
#include "network/inputs.hpp"

namespace igsp::cli {

/// Of the sources that the answers in a store are made by, see cmake/method_number.cmake.
extern const std::string_view method_number;

/// A result without what a network does not look at, which is most of it.
Result without_details(Result result);

/// What a run of `igsp network` has finished, in a folder: features by the content of their file, pairs by the features
/// of both, both by the options. A later run takes what still holds; a file that changed is another content. What
/// cannot be kept or read back is made again.
class NetworkStore {
 public:
  /// `options`: of the pairs; `engine` makes what is not here. Makes a folder named by the method's number in `folder`;
  /// throws FileError.
  NetworkStore(const std::filesystem::path& folder, const ScanReading& reading, const Options& options, Engine& engine);

  /// The voxel size of an earlier run with these options: it stays, so that a scan added later does not make all
  /// others new. 0: none.
  double voxel_size() const;
  void keep_voxel_size(double voxel_size);

  /// From here on with this voxel size, before any features.
  void use_voxel_size(double voxel_size);

  /// Tells the engine which features will be asked for and are not here.
  void expect_features(const ProgressCallback& progress);

  /// Throws FileError as read_features does.
  Features features(std::size_t scan, const ProgressCallback& progress);

  /// For register_network, after all features were asked for. Valid as long as the store.
  PairStore pairs();

  std::size_t features_taken() const { return features_taken_; }

 private:
  std::filesystem::path features_file(std::size_t scan, const ProgressCallback& progress);
  std::filesystem::path pair_file(std::size_t source, std::size_t target) const;
  void keep(std::size_t source, std::size_t target, const Result& result) const;
  void register_elsewhere(std::span<const ScanPair> pairs, const std::function<void(double)>& report);

  std::filesystem::path folder_;
  const ScanReading& reading_;
  Options options_;
  Engine& engine_;
  std::string options_text_;
  std::vector<std::string> keys_;  // of the scans' features
  std::size_t features_taken_ = 0;
};

}  // namespace igsp::cli
