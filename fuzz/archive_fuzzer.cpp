// Features and results of igsp with some of their bytes changed and a checksum that holds again: what is read can be
// used, everything else is refused.
#include <string>

#include "archive/archive.hpp"
#include "archive/layouts.hpp"
#include "bytes.hpp"
#include "fuzzing.hpp"
#include "igsp/align.hpp"
#include "igsp/archive.hpp"

namespace {

using igsp::fuzzing::Bytes;

/// A corner of three walls: features of a few keypoints.
igsp::Points corner() {
  igsp::Points points;
  for (int i = 0; i < 12; ++i) {
    for (int j = 0; j < 12; ++j) {
      const double u = 0.5 * i, v = 0.5 * j;
      points.emplace_back(u, v, 0), points.emplace_back(u, 0, v), points.emplace_back(0, u, 0.5 * v);
    }
  }
  return points;
}

/// Every stage is passed, none for long: what is fuzzed is what was read.
igsp::Options quick_options(double voxel_size) {
  igsp::Options options;
  options.scale.voxel_size = voxel_size;
  options.threads = 1;
  options.hypotheses.max_proposed = 3;
  options.hypotheses.max_refined = 2;
  options.convergence.max_iterations = 3;
  return options;
}

template <typename T>
std::string body_of(const T& value) {
  const std::string bytes = igsp::to_bytes(value);
  return std::string(igsp::archive::opened(igsp::archive::Layout<T>::name, bytes));
}

/// Bytes replaced at places that the input names, and perhaps the end cut off.
template <typename T>
std::string changed(std::string body, Bytes& bytes) {
  while (!bytes.empty()) {
    const std::size_t place = bytes.take<std::uint32_t>() % body.size();
    const std::uint8_t count = bytes.byte();
    if (count == 255) body.resize(place + 1);
    for (std::size_t i = place; i < std::min(body.size(), place + count % 9); ++i) {
      body[i] = static_cast<char>(bytes.byte());
    }
  }
  return igsp::archive::sealed(igsp::archive::Layout<T>::name, body);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const igsp::Features features = igsp::extract_features(corner(), quick_options(0.5));
  igsp::fuzzing::require(features.keypoints.size() > 3);
  static const std::string features_body = body_of(features);
  static const std::string result_body = body_of(igsp::align(features, features, quick_options(0.5)));
  Bytes bytes(data, size);
  const bool result = bytes.byte() % 2 == 1;
  try {
    if (result) {
      const igsp::Result read = igsp::result_from_bytes(changed<igsp::Result>(result_body, bytes));
      igsp::fuzzing::require(!igsp::to_bytes(read).empty());
    } else {
      const igsp::Features read = igsp::features_from_bytes(changed<igsp::Features>(features_body, bytes));
      const igsp::Options options = quick_options(read.voxel_size);
      igsp::align(read, features, options);
      igsp::align(read, read, options);
    }
  } catch (const igsp::InvalidArgument&) {
  }
  return 0;
}
