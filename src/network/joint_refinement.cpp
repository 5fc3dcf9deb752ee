#include "network/joint_refinement.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "core/parallel.hpp"
#include "network/components.hpp"
#include "network/control.hpp"
#include "network/measured_graph.hpp"
#include "network/pose_equations.hpp"
#include "registration/point_to_plane.hpp"
#include "registration/pose_covariance.hpp"

namespace igsp {
namespace {

// As in the last steps of the fine registration of a pair, [voxels].
constexpr double normal_radius = 1.5;
constexpr double joint_radius = 1.0;
constexpr double first_radius = 1.5;  // the pose graph may have moved a scan further than a pair's last step would
constexpr std::size_t max_link_points = 8000;
constexpr std::size_t surfaces_at_once = 8;  // while they are made, their features are in memory

constexpr int max_joint_steps = 10;
constexpr double small_joint_step = 1e-4;  // [voxels, rad]
constexpr std::size_t min_link_pairs = 30;

// What the surfaces of a link leave open must not make the system singular: every link also resists motion a little,
// this much at one sigma, without pulling anywhere.
constexpr double damping = 1.0;  // [voxels, or at the rim of the scan]

// A scan in its own centred frame, lengths in voxels.
class SharedSurface {
 public:
  explicit SharedSurface(const Features& features)
      : voxels_(features.points.size()), points_(features.fine_points), centre_(Eigen::Vector3d::Zero()) {
    for (Eigen::Vector3d& point : points_) point /= features.voxel_size;
    for (const Eigen::Vector3d& point : points_) centre_ += point / static_cast<double>(points_.size());
    for (const Eigen::Vector3d& point : points_) squared_size_ += (point - centre_).squaredNorm() / points_.size();
    std::optional<Eigen::Vector3d> viewpoint = features.viewpoint;
    if (viewpoint) *viewpoint /= features.voxel_size;
    surface_.emplace(points_, PointGrid(points_, 1.0), normal_radius, Viewpoints(viewpoint));
  }
  SharedSurface(const SharedSurface&) = delete;
  SharedSurface& operator=(const SharedSurface&) = delete;

  const Surface& surface() const { return *surface_; }
  const Eigen::Vector3d& centre() const { return centre_; }
  double squared_size() const { return squared_size_; }
  std::size_t voxels() const { return voxels_; }  ///< that the pair was registered with, not the finer ones here

 private:
  std::size_t voxels_;
  Points points_;
  Eigen::Vector3d centre_;
  double squared_size_ = 0;
  std::optional<Surface> surface_;
};

// Two scans whose surfaces pull at each other: those of a link, or its source and one of those merged.
struct Meeting {
  NetworkLink* link;
  std::size_t target;
};

class Bundle {
 public:
  Bundle(Network& network, FeatureShelf& features, std::span<const Eigen::Vector3d> stations,
         const NetworkOptions& options, const std::vector<bool>& under_control)
      : network_(network), stations_(stations), options_(options), threads_(options.pair.threads) {
    const std::size_t scans = network.scans.size();
    poses_.resize(scans, Transformation::Identity());
    is_free_.resize(scans, false);
    take_surfaces(features);
    for (NetworkLink& link : network.links) {
      if (!is_used(link)) continue;
      if (link.merged.empty()) meetings_.push_back({&link, link.target});
      for (const std::size_t target : link.merged) meetings_.push_back({&link, target});
    }
    for (std::size_t c = 0; c < network.components.size(); ++c) {
      const std::vector<std::size_t>& component = network.components[c];
      const std::size_t anchor = anchor_of(component, options.fixed_scan);
      for (const std::size_t i : component) {
        is_free_[i] = component.size() > 1 && (i != anchor || under_control[c]);
        if (surfaces_[i]) poses_[i] = local_pose(i);
      }
    }
    for (const ControlPose& one : options.control) {
      if (under_control[network.scans[one.scan].component]) control_.push_back(&one);
    }
    centres_.resize(scans, Eigen::Vector3d::Zero());
    for (std::size_t i = 0; i < scans; ++i) {
      if (surfaces_[i]) centres_[i] = surfaces_[i]->centre();
    }
  }

  void run() {
    if (meetings_.empty()) return;
    loss_scales_.assign(meetings_.size(), 0.0);
    for (int k = 0; k < max_joint_steps; ++k) {
      const auto steps = linearise(k == 0 ? first_radius : joint_radius).solve();
      if (!steps || apply_steps(*steps, centres_, poses_) < small_joint_step) break;
    }
    distances_.resize(meetings_.size());
    write_back(equations_of([this](std::size_t m) { return final_factor(meetings_[m], distances_[m]); }).covariances());
    write_distances();
  }

 private:
  // Of the scans that lie in a frame with others, several at a time.
  void take_surfaces(FeatureShelf& features) {
    surfaces_.resize(network_.scans.size());
    origins_.resize(network_.scans.size(), Eigen::Vector3d::Zero());
    std::vector<std::pair<std::size_t, std::shared_ptr<const Features>>> some;
    const auto make = [&] {
      parallel_blocks(some.size(), threads_, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
          surfaces_[some[k].first] = std::make_unique<SharedSurface>(*some[k].second);
        }
      });
      some.clear();
    };
    for (std::size_t i = 0; i < network_.scans.size(); ++i) {
      if (network_.components[network_.scans[i].component].size() == 1) continue;
      some.emplace_back(i, features.get(i));
      origins_[i] = some.back().second->origin;
      if (some.size() == surfaces_at_once) make();
    }
    make();
  }

  // From the scan's centred frame in voxels to the world in voxels.
  Transformation local_pose(std::size_t i) const {
    Transformation pose = network_.scans[i].world_from_scan;
    pose.translation() = pose * origins_[i] / network_.voxel_size;
    return pose;
  }

  PoseEquations linearise(double radius) {
    return equations_of([&](std::size_t m) { return factor(meetings_[m], radius, loss_scales_[m]); });
  }

  template <typename FactorOfMeeting>
  PoseEquations equations_of(const FactorOfMeeting& factor_of) const {
    std::vector<RelativeFactor> factors(meetings_.size());
    parallel_blocks(meetings_.size(), threads_, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t m = begin; m < end; ++m) factors[m] = factor_of(m);
    });
    PoseEquations equations(centres_, is_free_, options_.pair.degrees_of_freedom);
    for (const RelativeFactor& one : factors) equations.add(one);
    for (const ControlPose* one : control_) equations.add(prior(*one));
    return equations;
  }

  // At the poses as they are, and nothing but the damping. The larger one moves, as it did when the pair was
  // registered.
  RelativeFactor factor_between(const Meeting& meeting) const {
    const std::size_t source = meeting.link->source, target = meeting.target;
    const bool exchanged = surfaces_[target]->voxels() > surfaces_[source]->voxels();
    RelativeFactor factor;
    factor.source = exchanged ? target : source;
    factor.target = exchanged ? source : target;
    factor.target_from_source = poses_[factor.target].inverse() * poses_[factor.source];
    factor.information.diagonal().head<3>().setConstant(surfaces_[factor.source]->squared_size() / (damping * damping));
    factor.information.diagonal().tail<3>().setConstant(1 / (damping * damping));
    return factor;
  }

  // The loss follows the residuals of the step before, as it does where a pair is refined.
  RelativeFactor factor(const Meeting& meeting, double radius, double& loss_scale) const {
    RelativeFactor result = factor_between(meeting);
    const Linearisation at_pose = linearise_at(surfaces_[result.source]->surface(), surfaces_[result.target]->surface(),
                                               result.target_from_source, radius, max_link_points, 1, loss_scale);
    loss_scale = loss_scale_of(at_pose.residual_variance, joint_radius, 1);
    result.centre = at_pose.centre;
    if (at_pose.pairs >= min_link_pairs && at_pose.residual_variance > 0) {
      result.information += at_pose.hessian / at_pose.residual_variance;
      result.gradient = at_pose.gradient / at_pose.residual_variance;
    }
    return result;
  }

  // With how much the gradient scatters, patches of surface counting as one measurement each, as for a pair by itself.
  RelativeFactor final_factor(const Meeting& meeting, std::vector<double>& distances) const {
    RelativeFactor result = factor_between(meeting);
    const std::vector<PlanePair> pairs =
        plane_pairs_at(surfaces_[result.source]->surface(), surfaces_[result.target]->surface(),
                       result.target_from_source, joint_radius, max_link_points);
    for (const PlanePair& pair : pairs) distances.push_back(std::abs(pair.residual));
    result.scatter = result.information;
    if (pairs.size() < min_link_pairs) return result;
    const PoseCovariance at_pose = pose_covariance(pairs, joint_radius, 1);
    result.centre = at_pose.centre;
    result.information += at_pose.curvature;
    *result.scatter += at_pose.gradient_covariance;
    return result;
  }

  PriorFactor prior(const ControlPose& given) const {
    ControlPose control = given;
    control.position /= network_.voxel_size;
    control.position_sigma /= network_.voxel_size;
    const Eigen::Vector3d station = (stations_[control.scan] - origins_[control.scan]) / network_.voxel_size;
    return prior_of(control, poses_[control.scan], station, centres_[control.scan]);
  }

  void write_back(const std::vector<Matrix6>& covariances) {
    const double v = network_.voxel_size;
    for (std::size_t i = 0; i < poses_.size(); ++i) {
      if (!is_free_[i]) continue;
      NetworkScan& scan = network_.scans[i];
      scan.world_from_scan.linear() = poses_[i].linear();
      scan.world_from_scan.translation() = v * poses_[i].translation() - poses_[i].linear() * origins_[i];
      scan.centre = v * (poses_[i] * centres_[i]);
      Matrix6 turn = Matrix6::Zero();
      turn.topLeftCorner<3, 3>() = poses_[i].linear();
      turn.bottomRightCorner<3, 3>() = v * poses_[i].linear();
      scan.covariance = turn * covariances[i] * turn.transpose();
    }
  }

  // Of a link, over all scans that its source was registered with.
  void write_distances() {
    for (std::size_t m = 0; m < meetings_.size();) {
      NetworkLink& link = *meetings_[m].link;
      std::vector<double> all;
      for (; m < meetings_.size() && meetings_[m].link == &link; ++m) {
        all.insert(all.end(), distances_[m].begin(), distances_[m].end());
      }
      if (all.empty()) continue;
      double squares = 0;
      for (const double distance : all) squares += distance * distance;
      link.rms_distance = network_.voxel_size * std::sqrt(squares / static_cast<double>(all.size()));
      const auto middle = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
      std::nth_element(all.begin(), middle, all.end());
      link.median_distance = network_.voxel_size * *middle;
    }
  }

  Network& network_;
  std::span<const Eigen::Vector3d> stations_;
  const NetworkOptions& options_;
  int threads_;
  std::vector<Meeting> meetings_;               // those of one link one after the other
  std::vector<double> loss_scales_;             ///< by meeting, [voxels]; 0: not known yet
  std::vector<std::vector<double>> distances_;  // by meeting, [voxels]
  std::vector<const ControlPose*> control_;
  std::vector<Transformation> poses_;
  std::vector<bool> is_free_;
  std::vector<std::unique_ptr<SharedSurface>> surfaces_;
  std::vector<Eigen::Vector3d> centres_, origins_;
};

}  // namespace

void refine_jointly(Network& network, FeatureShelf& features, std::span<const Eigen::Vector3d> stations,
                    const NetworkOptions& options, const std::vector<bool>& under_control) {
  Bundle(network, features, stations, options, under_control).run();
}

}  // namespace igsp
