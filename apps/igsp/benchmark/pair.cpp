#include "benchmark/pair.hpp"

#include <limits>

#include "benchmark/judgement.hpp"
#include "igsp/io.hpp"
#include "shell/interrupt.hpp"

namespace igsp::cli {
namespace {

// Relative to the first point: survey coordinates lose nothing.
Eigen::Vector3d centroid_of(PointView points) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points) sum += point - points.front();
  return points.front() + sum / static_cast<double>(points.size());
}

}  // namespace

BenchmarkPair read_pair(const BenchmarkCase& one) {
  const auto go_on = [](const Progress&) { return !interrupted(); };
  const std::size_t all_points = std::numeric_limits<std::size_t>::max();
  BenchmarkPair pair;
  if (one.truth == Truth::known) pair.truth = read_transformation(one.truth_file);
  pair.source = read_cloud(one.source, all_points, "read source", go_on);
  pair.target = read_cloud(one.target, all_points, "read target", go_on);
  settle_viewpoint(pair.source, one.source_viewpoint);
  settle_viewpoint(pair.target, one.target_viewpoint);
  pair.source_centroid = centroid_of(pair.source.points);
  return pair;
}

void scramble_source(BenchmarkPair& pair, const BenchmarkCase& one, std::uint64_t seed) {
  pair.motion = scramble(seed, one.name, centre_of(pair.source.bounds), pair.source.bounds.diagonal());
  for (Eigen::Vector3d& point : pair.source.points) point = pair.motion * point;
  std::optional<Eigen::Vector3d>& viewpoint = pair.source.viewpoint.viewpoint;
  if (viewpoint) viewpoint = pair.motion * *viewpoint;
  for (ScanPart& part : pair.source.viewpoint.parts) {
    if (part.viewpoint) part.viewpoint = pair.motion * *part.viewpoint;
  }
}

}  // namespace igsp::cli
