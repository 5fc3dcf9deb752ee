#include <fmt/format.h>

#include <cmath>

#include "core/report_progress.hpp"
#include "igsp/errors.hpp"
#include "igsp/network.hpp"
#include "network/common_scale.hpp"
#include "network/contradictions.hpp"
#include "network/control.hpp"
#include "network/decide.hpp"
#include "network/feature_shelf.hpp"
#include "network/joint_refinement.hpp"
#include "network/likely_pairs.hpp"
#include "network/merged_neighbours.hpp"
#include "network/pairs.hpp"
#include "network/runners_up.hpp"
#include "network/settle.hpp"

namespace igsp {
namespace {

void check(const NetworkOptions& options) {
  validate(options.pair);
  const double confidence = options.min_unconfirmed_confidence;
  if (confidence >= 0.5 && confidence <= 1) return;
  throw InvalidArgument(fmt::format("min_unconfirmed_confidence is {}; it must be in [0.5, 1]", confidence));
}

// What is known of every scan from its features.
struct Gathered {
  explicit Gathered(std::size_t count) : scans(count), shapes(count), stations(count, Eigen::Vector3d::Zero()) {}
  std::vector<NetworkScan> scans;
  std::vector<ScanShape> shapes;
  std::vector<Eigen::Vector3d> stations;
  double voxel_size = 0;
};

void take(Gathered& gathered, const Features& features, std::size_t i) {
  if (features.points.empty()) throw InvalidArgument("no points");
  if (gathered.voxel_size == 0) gathered.voxel_size = features.voxel_size;
  if (features.voxel_size != gathered.voxel_size) {
    throw InvalidArgument(fmt::format("features with voxel_size {} among those with {}; all must be the same",
                                      features.voxel_size, gathered.voxel_size));
  }
  gathered.scans[i].points = features.cloud_points;
  gathered.shapes[i] = shape_of(features);
  gathered.stations[i] = station_of(features);
}

// What a source throws is that scan's problem.
Gathered gather(FeatureShelf& shelf, std::size_t count, const ProgressCallback& progress) {
  Gathered gathered(count);
  for (std::size_t i = 0; i < count; ++i) {
    report_progress(progress, "features", static_cast<double>(i) / static_cast<double>(count));
    try {
      take(gathered, *shelf.get(i), i);
    } catch (const Cancelled&) {
      throw;
    } catch (const std::exception& error) {
      gathered.scans[i].problem = error.what();
    }
  }
  report_progress(progress, "features", 1);
  return gathered;
}

std::vector<NetworkLink> registered_pairs(const Network& network, FeatureShelf& shelf,
                                          std::span<const ScanShape> shapes, const NetworkOptions& options,
                                          const PairStore& store, const ProgressCallback& progress) {
  const auto report = [&](double done) { report_progress(progress, "pairs", done); };
  std::vector<NetworkLink> links;
  if (options.pairs == PairRule::automatic) {
    links = register_likely_pairs(network, shelf, shapes, options, store, report);
  } else {
    const bool all = options.pairs == PairRule::all;
    links = register_pairs(all ? all_pairs(network.scans) : listed_pairs(network.scans, options.listed_pairs), shelf,
                           options.pair, store, report);
  }
  report(1);
  return links;
}

// From the pairs' answers, then a second look: at second best poses, and at scans alone against merged neighbours.
// Where pairs are listed no others are tried.
Network decided(const Network& start, std::vector<NetworkLink>& links, FeatureShelf& shelf,
                std::span<const ScanShape> shapes, const NetworkOptions& options, const ProgressCallback& progress) {
  SeenSpace space(shelf);
  Network network = settled_network(start, links, shapes, space, options);
  const auto take = [&](const std::vector<NetworkLink>& more) {
    if (more.empty()) return false;
    links.insert(links.end(), more.begin(), more.end());
    network = settled_network(start, links, shapes, space, options);
    return true;
  };
  take(runners_up(network, shelf, shapes, options));
  if (options.pairs == PairRule::listed) return network;
  MergedNeighbours neighbours(shelf, options);
  const auto report = [&](double done) { report_progress(progress, "neighbours", done); };
  while (take(neighbours.next(network, report))) {
  }
  return network;
}

}  // namespace

std::string_view to_string(LinkState state) {
  switch (state) {
    case LinkState::used:
      return "used";
    case LinkState::unconfirmed:
      return "unconfirmed";
    case LinkState::rejected:
      return "rejected";
    case LinkState::not_registered:
      return "not_registered";
  }
  return "unknown";
}

std::string_view to_string(LinkOrigin origin) {
  switch (origin) {
    case LinkOrigin::pair:
      return "pair";
    case LinkOrigin::runner_up:
      return "runner_up";
    case LinkOrigin::merged:
      return "merged";
  }
  return "unknown";
}

Network register_network(std::size_t scans, const FeatureSource& features, const NetworkOptions& options,
                         const ProgressCallback& progress, const PairStore& store) {
  check(options);
  check_control(options, scans);
  FeatureShelf shelf(scans, features, options.features_in_memory);
  Gathered gathered = gather(shelf, scans, progress);
  const auto& [_, shapes, stations, voxel_size] = gathered;
  Network start;
  start.scans = std::move(gathered.scans);
  start.voxel_size = voxel_size;
  std::vector<NetworkLink> links = registered_pairs(start, shelf, shapes, options, store, progress);
  Network network = decided(start, links, shelf, shapes, options, progress);
  report_progress(progress, "network", 0);
  const std::vector<bool> placed = move_to_control(network, stations, options);
  if (options.pair.refinement.enabled) refine_jointly(network, shelf, stations, options, placed);
  measure_control(network, stations, options, placed);
  measure_residuals(network, shapes);
  SeenSpace space(shelf);
  network.contradictions = contradictions_at(network, shapes, space);
  report_progress(progress, "network", 1);
  return network;
}

Network register_network(std::span<const Features> scans, const NetworkOptions& options,
                         const ProgressCallback& progress) {
  for (const Features& one : scans) {
    if (one.voxel_size == scans[0].voxel_size) continue;
    throw InvalidArgument(
        fmt::format("the features of two scans were extracted with voxel_size {} and {}; all must be "
                    "the same",
                    scans[0].voxel_size, one.voxel_size));
  }
  return register_network(
      scans.size(), [&](std::size_t i) { return scans[i]; }, options, progress);
}

Network register_network(std::span<const Scan> scans, const NetworkOptions& options, const ProgressCallback& progress) {
  check(options);
  NetworkOptions scaled = options;
  if (options.pair.scale.voxel_size == 0) {
    std::vector<double> own;
    for (std::size_t i = 0; i < scans.size(); ++i) {
      report_progress(progress, "scale", static_cast<double>(i) / static_cast<double>(scans.size()));
      try {
        own.push_back(own_voxel_size(scans[i], options.pair.scale));
      } catch (const InvalidArgument&) {
        // Said again, as the scan's problem, where its features are extracted.
      }
    }
    scaled.pair.scale.voxel_size = common_voxel_size(std::move(own));
  }
  const auto features = [&](std::size_t i) { return extract_features(scans[i], scaled.pair); };
  return register_network(scans.size(), features, scaled, progress);
}

}  // namespace igsp
