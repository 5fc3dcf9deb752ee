#include "network/pose_graph.hpp"

#include <Eigen/Cholesky>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "estimation/robust_fit.hpp"
#include "network/spanning_forest.hpp"

namespace igsp {
namespace {

// The weight vanishes at three scales of the loss, which is where a link counts as wrong.
constexpr double squared_scale = max_loop_error / 9;

constexpr double least_forest_weight = 1e-6;  // the equations stay regular whatever the loss says of a tree's links

constexpr int max_steps = 30;
constexpr double small_step = 1e-6;  // [voxels, rad]

constexpr std::size_t no_unknown = SIZE_MAX;

using Sparse = Eigen::SparseMatrix<double>;
using Solver = Eigen::SimplicialLDLT<Sparse>;

struct Equations {
  Sparse information;
  Eigen::VectorXd gradient;
};

class Balance {
 public:
  Balance(const LinkGraph& graph, std::span<const std::size_t> forest, std::span<const std::size_t> anchors)
      : graph_(graph),
        in_forest_(graph.links.size(), false),
        loop_length_(graph.links.size(), 0),
        tree_(graph.centres.size(), no_unknown),
        unknown_(graph.centres.size(), no_unknown),
        poses_(graph.centres.size(), Transformation::Identity()) {
    for (const std::size_t link : forest) in_forest_[link] = true;
    const auto forest_links = links_by_scan(graph, forest);
    for (const std::size_t anchor : anchors) place_tree(forest_links, anchor);
    for (std::size_t i = 0; i < unknown_.size(); ++i) {
      if (tree_[i] != no_unknown && tree_[i] != i) unknown_[i] = unknowns_++;
    }
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
    result.covariances = covariances();
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
        if (tree_[next] != no_unknown) continue;
        tree_[next] = anchor;
        poses_[next] = poses_[here] * (is_target ? link.target_from_source : link.target_from_source.inverse());
        reached.push_back(next);
      }
    }
  }

  bool takes_part(const GraphLink& link) const {
    return tree_[link.source] != no_unknown && tree_[link.source] == tree_[link.target];
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

  Equations linearise(double leniency) const {
    std::vector<Eigen::Triplet<double>> entries;
    Equations equations{Sparse(6 * unknowns_, 6 * unknowns_), Eigen::VectorXd::Zero(6 * unknowns_)};
    for (std::size_t l = 0; l < graph_.links.size(); ++l) {
      const GraphLink& link = graph_.links[l];
      if (!takes_part(link)) continue;
      const double w = weight(l, leniency);
      if (w == 0) continue;
      const Transformation motion = difference(link);
      const Vector6 residual = step_about(link.centre, motion);
      const Eigen::Vector3d moved_centre = motion * link.centre;
      const Eigen::Matrix3d turned = left_jacobian_inverse(residual.head<3>());
      const std::size_t scans[2] = {link.source, link.target};
      Matrix6 jacobians[2];
      jacobians[0] =
          transport(poses_[link.target].inverse() * poses_[link.source], graph_.centres[link.source], moved_centre);
      jacobians[1] = -transport(Transformation::Identity(), graph_.centres[link.target], moved_centre);
      for (Matrix6& jacobian : jacobians) jacobian.topRows<3>() = (turned * jacobian.topRows<3>()).eval();
      for (int a = 0; a < 2; ++a) {
        if (unknown_[scans[a]] == no_unknown) continue;
        const Matrix6 weighted = w * jacobians[a].transpose() * link.information;
        equations.gradient.segment<6>(6 * unknown_[scans[a]]) += weighted * residual;
        for (int b = 0; b < 2; ++b) {
          if (unknown_[scans[b]] == no_unknown) continue;
          add_block(entries, 6 * unknown_[scans[a]], 6 * unknown_[scans[b]], weighted * jacobians[b]);
        }
      }
    }
    equations.information.setFromTriplets(entries.begin(), entries.end());
    return equations;
  }

  static void add_block(std::vector<Eigen::Triplet<double>>& entries, std::size_t row, std::size_t column,
                        const Matrix6& block) {
    for (int i = 0; i < 6; ++i) {
      for (int j = 0; j < 6; ++j) entries.emplace_back(row + i, column + j, block(i, j));
    }
  }

  void settle(double leniency) {
    for (int k = 0; k < max_steps && unknowns_ > 0; ++k) {
      const Equations equations = linearise(leniency);
      const Solver solver(equations.information);
      if (solver.info() != Eigen::Success) return;
      const Eigen::VectorXd step = solver.solve(-equations.gradient);
      if (!step.allFinite()) return;
      for (std::size_t i = 0; i < poses_.size(); ++i) {
        if (unknown_[i] == no_unknown) continue;
        poses_[i] = poses_[i] * motion_about(graph_.centres[i], step.segment<6>(6 * unknown_[i]));
        poses_[i].linear() = Eigen::Quaterniond(poses_[i].linear()).normalized().toRotationMatrix();
      }
      if (step.lpNorm<Eigen::Infinity>() < small_step) return;
    }
  }

  std::vector<Matrix6> covariances() const {
    std::vector<Matrix6> blocks(poses_.size(), Matrix6::Zero());
    if (unknowns_ == 0) return blocks;
    const Solver solver(linearise(1).information);
    if (solver.info() != Eigen::Success) return blocks;
    for (std::size_t i = 0; i < poses_.size(); ++i) {
      if (unknown_[i] == no_unknown) continue;
      Eigen::MatrixXd unit = Eigen::MatrixXd::Zero(6 * unknowns_, 6);
      unit.middleRows<6>(6 * unknown_[i]).setIdentity();
      blocks[i] = solver.solve(unit).middleRows<6>(6 * unknown_[i]);
    }
    return blocks;
  }

  const LinkGraph& graph_;
  std::vector<bool> in_forest_;
  std::vector<std::size_t> loop_length_;
  std::vector<std::size_t> tree_;     // its anchor
  std::vector<std::size_t> unknown_;  // place among the unknowns
  std::size_t unknowns_ = 0;
  std::vector<Transformation> poses_;
};

}  // namespace

BalancedPoses balance_poses(const LinkGraph& graph, std::span<const std::size_t> forest,
                            std::span<const std::size_t> anchors) {
  return Balance(graph, forest, anchors).run();
}

}  // namespace igsp
