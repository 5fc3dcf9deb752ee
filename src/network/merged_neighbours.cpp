#include "network/merged_neighbours.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>

#include "core/parallel.hpp"
#include "igsp/align.hpp"
#include "network/pairs.hpp"
#include "network/shared_space.hpp"

namespace igsp {
namespace {

// More make the cloud larger without more of it that one scan could see.
constexpr std::size_t most_merged = 8;

// The scan of a frame that a scan alone is likest to, by what became of their pairs.
std::size_t likest_to(const Network& network, std::size_t scan, const std::vector<std::size_t>& frame) {
  std::map<std::size_t, double> confidence;
  for (const NetworkLink& link : network.links) {
    if (link.source != scan && link.target != scan) continue;
    double& best = confidence[link.source == scan ? link.target : link.source];
    best = std::max(best, link.confidence);
  }
  return *std::ranges::max_element(frame, {}, [&](std::size_t i) { return confidence[i]; });
}

// The scan given, then those that share most of its space, as the network has them.
std::vector<std::size_t> neighbours_of(std::size_t scan, const std::vector<std::size_t>& frame, const Network& network,
                                       FeatureShelf& features) {
  std::vector<std::pair<double, std::size_t>> others;
  const Space space(*features.get(scan));
  for (const std::size_t i : frame) {
    if (i == scan) continue;
    const double shared = frame.size() <= most_merged
                              ? 1
                              : shared_space(space, network.scans[scan].world_from_scan, Space(*features.get(i)),
                                             network.scans[i].world_from_scan);
    others.emplace_back(-shared, i);
  }
  std::ranges::sort(others);
  std::vector<std::size_t> merged = {scan};
  for (const auto& [_, i] : others) {
    if (merged.size() < most_merged) merged.push_back(i);
  }
  return merged;
}

// The scans as one cloud of several, in the frame of the first.
Features merged_features(const std::vector<std::size_t>& scans, const Network& network, FeatureShelf& shelf,
                         const Options& options) {
  Points points;
  std::vector<ScanPart> parts;
  for (const std::size_t i : scans) {
    const std::shared_ptr<const Features> scan = shelf.get(i);
    Transformation pose = network.scans[scans[0]].world_from_scan.inverse() * network.scans[i].world_from_scan;
    pose.translation() += pose.linear() * scan->origin;  // of what is local
    for (const Eigen::Vector3d& point : scan->fine_points) points.push_back(pose * point);
    std::optional<Eigen::Vector3d> viewpoint;
    if (scan->viewpoint) viewpoint = pose * *scan->viewpoint;
    parts.push_back({scan->fine_points.size(), viewpoint});
  }
  Scan cloud(points);
  cloud.parts = parts;
  Options same_scale = options;
  same_scale.scale.voxel_size = network.voxel_size;
  return extract_features(cloud, same_scale);
}

NetworkLink merged_link(std::size_t scan, const std::vector<std::size_t>& merged, const Result& result) {
  NetworkLink link = link_of({scan, merged[0]}, result);
  link.origin = LinkOrigin::merged;
  link.merged = merged;
  link.reason = fmt::format("against {} scans at once: {}", merged.size(), link.reason);
  return link;
}

// Of several scans to one merged cloud, each on one thread.
std::vector<NetworkLink> merged_links(const std::vector<std::size_t>& scans, const std::vector<std::size_t>& merged,
                                      const Network& network, FeatureShelf& features, const Options& options) {
  const Features cloud = merged_features(merged, network, features, options);
  std::vector<std::shared_ptr<const Features>> sources;
  for (const std::size_t scan : scans) sources.push_back(features.get(scan));
  Options single = options;
  single.threads = 1;
  std::vector<NetworkLink> links(scans.size());
  parallel_blocks(scans.size(), options.threads, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      links[i] = merged_link(scans[i], merged, align(*sources[i], cloud, single));
    }
  });
  return links;
}

}  // namespace

std::vector<NetworkLink> MergedNeighbours::next(const Network& network, const std::function<void(double)>& report) {
  // By merged cloud, so that each is made once.
  std::map<std::vector<std::size_t>, std::vector<std::size_t>> scans_by_cloud;
  for (const std::vector<std::size_t>& alone : network.components) {
    if (alone.size() > 1 || !network.scans[alone[0]].problem.empty()) continue;
    for (const std::vector<std::size_t>& frame : network.components) {
      if (frame.size() == 1) continue;
      const std::vector<std::size_t> merged =
          neighbours_of(likest_to(network, alone[0], frame), frame, network, features_);
      std::vector<std::size_t> attempt = {alone[0]};
      attempt.insert(attempt.end(), merged.begin(), merged.end());
      std::sort(attempt.begin() + 1, attempt.end());
      if (tried_.insert(attempt).second) scans_by_cloud[merged].push_back(alone[0]);
    }
  }
  std::vector<NetworkLink> links;
  double done = 0;
  for (const auto& [merged, scans] : scans_by_cloud) {
    report(done++ / static_cast<double>(scans_by_cloud.size()));
    const std::vector<NetworkLink> of_cloud = merged_links(scans, merged, network, features_, options_.pair);
    links.insert(links.end(), of_cloud.begin(), of_cloud.end());
  }
  return links;
}

}  // namespace igsp
