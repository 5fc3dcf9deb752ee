#include "network/pose_graph.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "estimation/robust_fit.hpp"
#include "network/pose_equations.hpp"
#include "network/spanning_forest.hpp"

namespace igsp {
namespace {

// The weight vanishes at three scales of the loss, which is where a link counts as wrong.
constexpr double squared_scale = max_loop_error / 9;

constexpr double least_forest_weight = 1e-6;  // the equations stay regular whatever the loss says of a tree's links

constexpr int max_balancing_steps = 30;
constexpr double balanced_step = 1e-6;  // [voxels, rad]

constexpr std::size_t in_no_tree = SIZE_MAX;

class Balance {
 public:
  Balance(const LinkGraph& graph, std::span<const std::size_t> forest, std::span<const std::size_t> anchors)
      : graph_(graph),
        in_forest_(graph.links.size(), false),
        loop_length_(graph.links.size(), 0),
        tree_(graph.centres.size(), in_no_tree),
        is_free_(graph.centres.size(), false),
        poses_(graph.centres.size(), Transformation::Identity()) {
    for (const std::size_t link : forest) in_forest_[link] = true;
    const auto forest_links = links_by_scan(graph, forest);
    for (const std::size_t anchor : anchors) place_tree(forest_links, anchor);
    for (std::size_t i = 0; i < is_free_.size(); ++i) is_free_[i] = tree_[i] != in_no_tree && tree_[i] != i;
    for (std::size_t l = 0; l < graph.links.size(); ++l) {
      const GraphLink& link = graph.links[l];
      if (!takes_part(link)) continue;
      loop_length_[l] = 1 + forest_path(graph, forest_links, link.source, link.target).size();
    }
  }

  BalancedPoses run() {
    const std::size_t longest = loop_length_.empty() ? 0 : *std::max_element(loop_length_.begin(), loop_length_.end());
    double leniency = std::max<double>(1.0, static_cast<double>(longest));
    for (;; leniency = std::max(1.0, leniency / 2)) {
      settle(leniency);
      if (leniency == 1) break;
    }
    BalancedPoses result;
    result.covariances = linearise(1).covariances();
    for (const GraphLink& link : graph_.links) result.errors.push_back(takes_part(link) ? error(link) : HUGE_VAL);
    result.world_from_scan = std::move(poses_);
    return result;
  }

 private:
  void place_tree(const std::vector<std::vector<std::size_t>>& forest_links, std::size_t anchor) {
    tree_[anchor] = anchor;
    std::vector<std::size_t> reached = {anchor};
    for (std::size_t i = 0; i < reached.size(); ++i) {
      const std::size_t here = reached[i];
      for (const std::size_t l : forest_links[here]) {
        const GraphLink& link = graph_.links[l];
        const bool is_target = link.target == here;
        const std::size_t next = is_target ? link.source : link.target;
        if (tree_[next] != in_no_tree) continue;
        tree_[next] = anchor;
        poses_[next] = poses_[here] * (is_target ? link.target_from_source : link.target_from_source.inverse());
        reached.push_back(next);
      }
    }
  }

  bool takes_part(const GraphLink& link) const {
    return tree_[link.source] != in_no_tree && tree_[link.source] == tree_[link.target];
  }

  // What the poses say beyond the link: a step in the target's frame.
  Transformation difference(const GraphLink& link) const {
    return poses_[link.target].inverse() * poses_[link.source] * link.target_from_source.inverse();
  }
  double error(const GraphLink& link) const {
    const Vector6 step = step_about(link.centre, difference(link));
    return step.dot(link.tolerance.ldlt().solve(step));
  }

  double weight(std::size_t l, double leniency) const {
    const double lenient = std::clamp<double>(leniency, 1.0, static_cast<double>(loop_length_[l]));
    const double robust = geman_mcclure_weight(error(graph_.links[l]), squared_scale * lenient);
    return in_forest_[l] ? std::max(least_forest_weight, robust) : robust;
  }

  PoseEquations linearise(double leniency) const {
    PoseEquations equations(graph_.centres, is_free_, graph_.degrees_of_freedom);
    for (std::size_t l = 0; l < graph_.links.size(); ++l) {
      const GraphLink& link = graph_.links[l];
      if (!takes_part(link)) continue;
      const double w = weight(l, leniency);
      if (w > 0) equations.add(factor(link, w));
    }
    return equations;
  }

  // A further small motion changes the step of the difference by its own rotation, as the left Jacobian has it, and by
  // its translation of where the centre is now.
  RelativeFactor factor(const GraphLink& link, double w) const {
    const Transformation motion = difference(link);
    const Vector6 residual = step_about(link.centre, motion);
    Matrix6 change = Matrix6::Identity();
    change.topLeftCorner<3, 3>() = left_jacobian_inverse(residual.head<3>());
    const Matrix6 weighted = w * change.transpose() * link.information;
    return {link.source,          link.target,       poses_[link.target].inverse() * poses_[link.source],
            motion * link.centre, weighted * change, weighted * residual};
  }

  void settle(double leniency) {
    for (int k = 0; k < max_balancing_steps; ++k) {
      const auto steps = linearise(leniency).solve();
      if (!steps || apply_steps(*steps, graph_.centres, poses_) < balanced_step) return;
    }
  }

  const LinkGraph& graph_;
  std::vector<bool> in_forest_;
  std::vector<std::size_t> loop_length_;
  std::vector<std::size_t> tree_;  // its anchor
  std::vector<bool> is_free_;
  std::vector<Transformation> poses_;
};

}  // namespace

BalancedPoses balance_poses(const LinkGraph& graph, std::span<const std::size_t> forest,
                            std::span<const std::size_t> anchors) {
  return Balance(graph, forest, anchors).run();
}

}  // namespace igsp
