#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "igsp/features.hpp"
#include "igsp/options.hpp"
#include "igsp/point_cloud.hpp"
#include "igsp/progress.hpp"
#include "igsp/result.hpp"

namespace igsp {

/// Source and target, indices of scans.
using ScanPair = std::pair<std::size_t, std::size_t>;

/// Which pairs are tried.
enum class PairRule {
  all,        ///< every pair
  automatic,  ///< the likeliest first, until every scan has enough links that loops confirm or nothing is likely
  listed,     ///< those of NetworkOptions::listed_pairs
};

/// Where a scan is known to lie in the world, as a soft prior.
struct ControlPose {
  std::size_t scan = 0;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< in the world: of the scanner, where it is unknown of the
                                                       ///< origin of the scan's frame
  double position_sigma = 0;                           ///< per axis, > 0 [units of the cloud]
  std::optional<Eigen::Quaterniond> rotation;          ///< world_from_scan; none: only the position is known
  double rotation_sigma_rad = 0;                       ///< per axis, > 0 where there is a rotation
};

struct NetworkOptions {
  /// Of the features and of every pair; its voxel size, if set, is that of all scans. With four degrees of freedom the
  /// scans are levelled and stay so: z is up in all of them and in the world.
  Options pair;

  /// A link in no loop joins scans only with at least this confidence, [0.5, 1] (where both viewpoints are known and no
  /// scan stands in what the other scanner saw through, being registered is enough), ...
  double min_unconfirmed_confidence = 0.95;

  /// ... and at least so many agreeing matches: a bare room fits every other one like it, on few matches.
  std::size_t min_unconfirmed_matches = 35;

  std::optional<std::size_t> fixed_scan;  ///< its frame is the world of its component; none: that of the first scan

  /// A component's world is that of its control, if this says where that is: a pose, or three positions that lie on no
  /// line (of levelled scans two).
  std::vector<ControlPose> control;

  /// Of how many scans features are kept in memory, besides those that are just worked on. 0: of all. Otherwise a
  /// source of features is asked for a scan again when it is needed again. The answer does not depend on it.
  std::size_t features_in_memory = 0;

  PairRule pairs = PairRule::all;
  std::vector<ScanPair> listed_pairs;  ///< in any order, either scan first
};

/// What became of a pair of scans.
enum class LinkState {
  used,            ///< registered, and confirmed by at least one loop of other links
  unconfirmed,     ///< registered and used, but in no loop: nothing else would notice if it were wrong
  rejected,        ///< registered, and contradicted by the network
  not_registered,  ///< tried; the pair itself gave no answer to rely on
};
std::string_view to_string(LinkState state);

/// What says where a link's source lies.
enum class LinkOrigin {
  pair,       ///< both scans, by themselves
  runner_up,  ///< the pair's second best pose, which the network prefers to its best one
  merged,     ///< the source and several scans of the target's component at once, merged into one cloud
};
std::string_view to_string(LinkOrigin origin);

/// A pair that was tried, or a second look at one.
struct NetworkLink {
  std::size_t source = 0;  ///< indices of scans
  std::size_t target = 0;
  LinkState state = LinkState::not_registered;
  LinkOrigin origin = LinkOrigin::pair;
  std::vector<std::size_t> merged;  ///< of LinkOrigin::merged: the scans of the merged cloud, the target first
  std::string reason;               ///< one sentence
  Transformation target_from_source = Transformation::Identity();  ///< as the pair alone has it
  double confidence = 0;                                           ///< of the pair alone, [0, 1]
  double overlap = 0;                                              ///< the smaller of the two directions, [0, 1]
  double rmse = 0;                                                 ///< inlier RMSE of the pair [units of the cloud]
  std::size_t mutual_matches = 0;                                  ///< of the pair alone, as in Evidence ...
  std::size_t agreeing_matches = 0;                                ///< ... and those of them that agree
  double violation = 0;                                            ///< of free space, [0, 1)
  std::size_t in_view = 0;  ///< voxels of one scan in view of the other, the fewer; 0 unless both viewpoints are known
  std::size_t consistent_triangles = 0;  ///< loops of three registered links that close, with this one in it
  double cycle_error = 0;                ///< of these loops, that of the one that closes best [sigmas]
  double residual = 0;  ///< RMS displacement of the source's points, pair against network [units of the cloud]
  /// Of a link that is used, at the final poses: distances of the source's points from the target's surface along its
  /// normals, where they lie on each other; median of their sizes and RMS [units of the cloud].
  double median_distance = 0, rms_distance = 0;
  Precision precision;                ///< of the pair alone
  std::optional<RunnerUp> runner_up;  ///< of the pair alone
};

/// A loop of three registered links.
struct NetworkCycle {
  std::array<std::size_t, 3> scans{};  ///< ascending
  double error = 0;                    ///< how far it is from closing, in sigmas of its links and what is right anyway
  bool closes = false;                 ///< otherwise one of its links is wrong
};

/// Two scans of one component that the network puts where the scanner of one saw through the other.
struct NetworkContradiction {
  std::array<std::size_t, 2> scans{};  ///< ascending
  double violation = 0;                ///< of free space, [0, 1)
};

/// A scan and where it lies.
struct NetworkScan {
  std::string name;           ///< for people; register_network leaves it empty
  std::string problem;        ///< why there is nothing to register, empty if there is
  std::size_t component = 0;  ///< index into Network::components
  Transformation world_from_scan = Transformation::Identity();
  /// Of world_from_scan: a small motion on the left, in the world, rotation about x, y, z through `centre` [rad], then
  /// translation [units of the cloud]. 0 for the scan whose frame is the component's world; against the control where
  /// there is one.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< centroid of its points, in the world
  std::size_t points = 0;                            ///< as given
  /// Distance between its control's position and where the network has it [units of the cloud]; none without control,
  /// or where that does not place its component.
  std::optional<double> control_residual;
};

/// What `register_network` answers. Scans that do not connect stay in components of their own; a component's world is
/// the frame of its first scan unless the options say otherwise.
struct Network {
  std::vector<NetworkScan> scans;                    ///< in the order given
  std::vector<NetworkLink> links;                    ///< all pairs that were tried, then second looks
  std::vector<NetworkCycle> cycles;                  ///< all loops of three registered links
  std::vector<std::vector<std::size_t>> components;  ///< scans, ascending; the largest component first
  /// Of all pairs of scans of one component whose viewpoints are known, at the final poses: those with more than 1 %,
  /// the worst first. People and leaves make a few percent.
  std::vector<NetworkContradiction> contradictions;
  double bundle_error = 0;            ///< RMS of the residuals of the links that are used [units of the cloud]
  double voxel_size = 0;              ///< [units of the cloud]
  std::vector<std::string> warnings;  ///< what of the options could not be followed, a sentence each
};

/// Hands out the features of scan i; called from the thread that called the library. What it throws the first time
/// (except Cancelled) becomes that scan's problem and does not stop the others; later it ends the run.
using FeatureSource = std::function<Features(std::size_t scan)>;

/// Keeps what a run has finished, so that a later one goes on from there. `find` and `keep` may be called from several
/// threads at once; what they throw ends the run. Empty: nothing is kept.
struct PairStore {
  std::function<std::optional<Result>(std::size_t source, std::size_t target)> find;
  std::function<void(std::size_t source, std::size_t target, const Result& result)> keep;

  /// Told which pairs are tried next, before `find` is asked for them: whoever registers them elsewhere does so now,
  /// and has `find` hand them out. `report` takes the share done, [0, 1]. Called from the thread that called the
  /// library.
  std::function<void(std::span<const ScanPair> pairs, const std::function<void(double)>& report)> prepare;
};

/// Many scans into one frame, without initial poses: pairs are registered; links that loops contradict are left
/// out; the rest is balanced in a robust pose graph. All features must share one voxel size. Throws InvalidArgument
/// (option out of range, different voxel sizes), Cancelled; scans that cannot be placed are an answer.
Network register_network(std::span<const Features> scans, const NetworkOptions& options = {},
                         const ProgressCallback& progress = {});

/// The same with features that are made, or read, one after the other.
Network register_network(std::size_t scans, const FeatureSource& features, const NetworkOptions& options = {},
                         const ProgressCallback& progress = {}, const PairStore& store = {});

/// The easy door: from points, with one voxel size chosen for all scans.
Network register_network(std::span<const Scan> scans, const NetworkOptions& options = {},
                         const ProgressCallback& progress = {});

}  // namespace igsp
