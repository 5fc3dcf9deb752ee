#include "network/decide.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

#include "network/components.hpp"
#include "network/cycles.hpp"
#include "network/pose_graph.hpp"
#include "network/spanning_forest.hpp"

namespace igsp {
namespace {

std::vector<Edge> edges_of(const LinkGraph& graph, std::span<const std::size_t> links) {
  std::vector<Edge> edges;
  for (const std::size_t l : links) edges.emplace_back(graph.links[l].source, graph.links[l].target);
  return edges;
}

std::vector<std::size_t> anchors_of(const LinkGraph& graph, std::span<const std::size_t> forest,
                                    const NetworkOptions& options) {
  std::vector<std::size_t> anchors;
  for (const auto& scans : connected_components(graph.centres.size(), edges_of(graph, forest))) {
    anchors.push_back(anchor_of(scans, options.fixed_scan));
  }
  return anchors;
}

// In the lengths of the graph.
WitnessQuestion witnesses(SeenSpace& space, double voxel_size) {
  return [&space, voxel_size](std::size_t source, std::size_t target, Transformation target_from_source) {
    target_from_source.translation() *= voxel_size;
    const std::optional<SeenTogether> seen = space.at(source, target, target_from_source);
    return seen ? witness_of(*seen) : Witness::none;
  };
}

// The frame of its anchor is a component's world, and the covariance that of a motion in the world.
void place_scans(Network& network, const BalancedPoses& poses, std::span<const ScanShape> shapes,
                 const NetworkOptions& options) {
  for (std::size_t c = 0; c < network.components.size(); ++c) {
    const std::size_t anchor = anchor_of(network.components[c], options.fixed_scan);
    const Transformation world_from_tree = poses.world_from_scan[anchor].inverse();
    for (const std::size_t i : network.components[c]) {
      NetworkScan& scan = network.scans[i];
      scan.component = c;
      scan.world_from_scan = world_from_tree * poses.world_from_scan[i];
      scan.world_from_scan.translation() *= network.voxel_size;
      if (i == anchor) scan.world_from_scan = Transformation::Identity();
      Vector6 scale;
      scale << Eigen::Vector3d::Ones(), Eigen::Vector3d::Constant(network.voxel_size);
      Matrix6 turn = Matrix6::Zero();
      turn.topLeftCorner<3, 3>() = turn.bottomRightCorner<3, 3>() = scan.world_from_scan.linear();
      turn = turn * scale.asDiagonal();
      scan.covariance = turn * poses.covariances[i] * turn.transpose();
      scan.centre = scan.world_from_scan * shapes[i].centre;
    }
  }
}

// Of a registered pair whose scans were not joined.
std::string why_apart(const NetworkLink& link, bool is_contradicted, const NetworkOptions& options) {
  if (is_contradicted) return "puts other scans where scanners of the network saw through";
  if (is_doubtful(link)) {
    return fmt::format(
        "{:.1f} % of the points lie where the other scanner saw through, and no link without such a doubt "
        "confirms it",
        100 * link.violation);
  }
  if (link.consistent_triangles == 0 && link.agreeing_matches < options.min_unconfirmed_matches) {
    return fmt::format(
        "in no loop that would confirm it, and {} agreeing matches are too few to stand alone (bare rooms "
        "fit each other)",
        link.agreeing_matches);
  }
  if (link.consistent_triangles == 0 && link.confidence < options.min_unconfirmed_confidence) {
    return fmt::format("in no loop that would confirm it, and a confidence of {:.2f} is too low to stand alone",
                       link.confidence);
  }
  return "joins two groups of scans against other links between them";
}

void name_states(Network& network, const MeasuredGraph& measured, const BalancedPoses& poses,
                 const std::vector<CycleSupport>& support, const Forest& forest, const NetworkOptions& options) {
  for (NetworkLink& link : network.links) {
    if (link.state != LinkState::unconfirmed || !contradicts_free_space(link)) continue;
    link.state = LinkState::rejected;
    link.reason = fmt::format("{:.0f} % of the points lie where the other scanner saw through", 100 * link.violation);
  }
  std::vector<std::size_t> used;
  for (std::size_t l = 0; l < measured.link_of.size(); ++l) {
    NetworkLink& link = network.links[measured.link_of[l]];
    link.consistent_triangles = support[l].triangles;
    link.cycle_error = support[l].triangles > 0 ? std::sqrt(support[l].best_error) : 0;
    if (poses.errors[l] < max_loop_error) {
      used.push_back(l);
      continue;
    }
    if (link.state == LinkState::not_registered) continue;
    link.state = LinkState::rejected;
    link.reason = std::isfinite(poses.errors[l])
                      ? fmt::format("the other links of the network put the pair {:.1f} sigma elsewhere",
                                    std::sqrt(poses.errors[l]))
                      : why_apart(link, forest.is_contradicted[l], options);
  }
  network.components = connected_components(network.scans.size(), edges_of(measured.graph, used));
  // What confirms nothing closes no loop for others. It is in one itself where the tree does without it.
  std::vector<std::size_t> confirming;
  std::ranges::copy_if(used, std::back_inserter(confirming),
                       [&](std::size_t l) { return !measured.graph.links[l].confirms_nothing; });
  const std::vector<bool> in_no_loop = bridges(network.scans.size(), edges_of(measured.graph, confirming));
  std::set<std::size_t> unconfirmed(forest.links.begin(), forest.links.end());
  for (std::size_t k = 0; k < confirming.size(); ++k) {
    if (in_no_loop[k]) {
      unconfirmed.insert(confirming[k]);
    } else {
      unconfirmed.erase(confirming[k]);
    }
  }
  for (const std::size_t l : used) {
    NetworkLink& link = network.links[measured.link_of[l]];
    if (link.state == LinkState::not_registered) {
      link.reason =
          "refused as a pair, used since nothing in the network or in the free space speaks against it: " + link.reason;
    }
    link.state = unconfirmed.contains(l) ? LinkState::unconfirmed : LinkState::used;
  }
}

}  // namespace

double displacement(const Network& network, std::size_t source, std::size_t target,
                    const Transformation& target_from_source, const ScanShape& shape) {
  const Transformation difference = network.scans[target].world_from_scan.inverse() *
                                    network.scans[source].world_from_scan * target_from_source.inverse();
  const Vector6 step = step_about(target_from_source * shape.centre, difference);
  return std::sqrt(step.tail<3>().squaredNorm() + 2.0 / 3.0 * step.head<3>().squaredNorm() * shape.size * shape.size);
}

void decide(Network& network, std::span<const ScanShape> shapes, SeenSpace* space, const NetworkOptions& options) {
  const MeasuredGraph all = measured_graph(network.links, shapes, network.voxel_size, options);
  Forest forest = spanning_forest(all.graph, cycle_support(all.graph, triangles(all.graph)),
                                  space ? witnesses(*space, network.voxel_size) : WitnessQuestion());
  const MeasuredGraph measured = without_unused_refused(all, network.links, options, forest);
  const std::vector<Triangle> loops = triangles(measured.graph);
  for (const Triangle& loop : loops) network.cycles.push_back({loop.scans, std::sqrt(loop.error), loop.closes()});
  const std::vector<CycleSupport> support = cycle_support(measured.graph, loops);
  const BalancedPoses poses =
      balance_poses(measured.graph, forest.links, anchors_of(measured.graph, forest.links, options));
  name_states(network, measured, poses, support, forest, options);
  place_scans(network, poses, shapes, options);
}

void measure_residuals(Network& network, std::span<const ScanShape> shapes) {
  double squares = 0;
  std::size_t count = 0;
  for (NetworkLink& link : network.links) {
    if (link.state == LinkState::not_registered ||
        network.scans[link.source].component != network.scans[link.target].component) {
      continue;
    }
    link.residual = displacement(network, link.source, link.target, link.target_from_source, shapes[link.source]);
    if (link.state == LinkState::rejected) continue;
    squares += link.residual * link.residual;
    ++count;
  }
  network.bundle_error = count > 0 ? std::sqrt(squares / static_cast<double>(count)) : 0.0;
}

}  // namespace igsp
