// Two clouds out of arbitrary bytes, and options out of them: a documented error, or a proper rotation and a verdict.
#include <cmath>
#include <cstring>

#include "fuzzing.hpp"
#include "igsp/align.hpp"

namespace {

/// Bytes one after the other; zeros when they are used up.
class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}
  bool empty() const { return size_ == 0; }
  std::uint8_t byte() { return take<std::uint8_t>(); }
  double number() { return take<double>(); }

  /// Mostly a coordinate as clouds have them, in steps that coincide; sometimes any double there is.
  double coordinate() {
    const std::uint8_t kind = byte();
    return kind < 250 ? 0.1 * byte() + 0.001 * kind : number();
  }

 private:
  template <typename T>
  T take() {
    T value{};
    const std::size_t count = std::min(sizeof(T), size_);
    std::memcpy(&value, data_, count);
    data_ += count, size_ -= count;
    return value;
  }

  const std::uint8_t* data_;
  std::size_t size_;
};

igsp::Points points_of(Bytes& bytes, std::size_t most) {
  igsp::Points points;
  while (points.size() < most && !bytes.empty()) {
    const double x = bytes.coordinate(), y = bytes.coordinate(), z = bytes.coordinate();
    points.emplace_back(x, y, z);
  }
  return points;
}

igsp::Options options_of(Bytes& bytes) {
  igsp::Options options;
  options.threads = 1;
  const std::uint8_t kind = bytes.byte();
  if (kind & 1) options.degrees_of_freedom = 4;
  if (kind & 2) options.search = igsp::Search::direct;
  if (kind & 4) options.scale.voxel_size = 0.1 + 0.1 * bytes.byte();
  if (kind & 8) options.scale.voxel_size = bytes.number();
  if (kind & 16) options.keypoints.min_neighbours = bytes.byte() % 8;
  options.hypotheses.max_proposed = 20;
  options.hypotheses.max_refined = 5;
  return options;
}

void check(const igsp::Result& result) {
  using igsp::fuzzing::require;
  require(!result.reason.empty());
  require(std::isfinite(result.confidence) && result.confidence >= 0 && result.confidence <= 1);
  if (result.registered) require(result.has_estimate);
  if (!result.has_estimate) return;
  const Eigen::Matrix3d rotation = result.target_from_source.linear();
  require(result.target_from_source.matrix().allFinite());
  require((rotation * rotation.transpose()).isIdentity(1e-6) && rotation.determinant() > 0.999);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Bytes bytes(data, size);
  const igsp::Options options = options_of(bytes);
  const std::size_t sources = bytes.byte();
  const igsp::Points source = points_of(bytes, sources), target = points_of(bytes, 4096);
  try {
    check(igsp::align(source, target, options));
    check(igsp::align(source, source, options));
  } catch (const igsp::InvalidArgument&) {
  }
  return 0;
}
