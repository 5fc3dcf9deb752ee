#pragma once

#include <string_view>
#include <tuple>
#include <type_traits>

#include "config/field_count.hpp"
#include "igsp/diagnosis.hpp"
#include "igsp/evaluation.hpp"
#include "igsp/features.hpp"
#include "igsp/network.hpp"
#include "igsp/result.hpp"
#include "igsp/similarity.hpp"
#include "igsp/simulation.hpp"
#include "igsp/viewpoint.hpp"

/// The one list of what is written of every struct: a new field is one line here, and without it nothing compiles.
namespace igsp::archive {

template <typename Class, typename Member>
struct Field {
  std::string_view name;
  Member Class::*member;
};
template <typename Class, typename Member>
Field(std::string_view, Member Class::*) -> Field<Class, Member>;  // Clang before 17 does not find it by itself

template <typename Class>
struct Layout {};

template <>
struct Layout<StrayPoints> {
  static constexpr std::string_view name = "StrayPoints";
  static constexpr std::tuple fields = {
      Field{"count", &StrayPoints::count},
      Field{"extents_away", &StrayPoints::extents_away},
  };
};

template <>
struct Layout<ScanPart> {
  static constexpr std::string_view name = "ScanPart";
  static constexpr std::tuple fields = {
      Field{"points", &ScanPart::points},
      Field{"viewpoint", &ScanPart::viewpoint},
  };
};

template <>
struct Layout<ScannedPart> {
  static constexpr std::string_view name = "ScannedPart";
  static constexpr std::tuple fields = {
      Field{"viewpoint", &ScannedPart::viewpoint},
      Field{"fine_points", &ScannedPart::fine_points},
  };
};

template <>
struct Layout<Features> {
  static constexpr std::string_view name = "Features";
  static constexpr std::tuple fields = {
      Field{"origin", &Features::origin},
      Field{"viewpoint", &Features::viewpoint},
      Field{"parts", &Features::parts},
      Field{"voxel_size", &Features::voxel_size},
      Field{"points", &Features::points},
      Field{"curvature", &Features::curvature},
      Field{"normals", &Features::normals},
      Field{"fine_points", &Features::fine_points},
      Field{"keypoints", &Features::keypoints},
      Field{"frames", &Features::frames},
      Field{"descriptors", &Features::descriptors},
      Field{"cloud_points", &Features::cloud_points},
      Field{"stray", &Features::stray},
      Field{"coarser", &Features::coarser},
      Field{"timings_s", &Features::timings_s},
  };
};

template <>
struct Layout<KeypointMatch> {
  static constexpr std::string_view name = "KeypointMatch";
  static constexpr std::tuple fields = {
      Field{"source", &KeypointMatch::source},
      Field{"target", &KeypointMatch::target},
  };
};

template <>
struct Layout<IterationRecord> {
  static constexpr std::string_view name = "IterationRecord";
  static constexpr std::tuple fields = {
      Field{"k", &IterationRecord::k},
      Field{"w_fd", &IterationRecord::w_fd},
      Field{"w_ed", &IterationRecord::w_ed},
      Field{"t_cd", &IterationRecord::t_cd},
      Field{"candidate_edges", &IterationRecord::candidate_edges},
      Field{"matches", &IterationRecord::matches},
      Field{"energy", &IterationRecord::energy},
      Field{"rotation_step_rad", &IterationRecord::rotation_step_rad},
      Field{"translation_step", &IterationRecord::translation_step},
      Field{"seconds", &IterationRecord::seconds},
      Field{"target_from_source", &IterationRecord::target_from_source},
      Field{"correspondences", &IterationRecord::correspondences},
  };
};

template <>
struct Layout<CloudSummary> {
  static constexpr std::string_view name = "CloudSummary";
  static constexpr std::tuple fields = {
      Field{"points", &CloudSummary::points},       Field{"voxels", &CloudSummary::voxels},
      Field{"keypoints", &CloudSummary::keypoints}, Field{"stray", &CloudSummary::stray},
      Field{"viewpoint", &CloudSummary::viewpoint}, Field{"part_viewpoints", &CloudSummary::part_viewpoints},
  };
};

template <>
struct Layout<FreeDirection> {
  static constexpr std::string_view name = "FreeDirection";
  static constexpr std::tuple fields = {
      Field{"motion", &FreeDirection::motion},
      Field{"description", &FreeDirection::description},
  };
};

template <>
struct Layout<Precision> {
  static constexpr std::string_view name = "Precision";
  static constexpr std::tuple fields = {
      Field{"inlier_rmse", &Precision::inlier_rmse},
      Field{"centre", &Precision::centre},
      Field{"information", &Precision::information},
      Field{"covariance", &Precision::covariance},
      Field{"scale", &Precision::scale},
      Field{"scale_sigma", &Precision::scale_sigma},
      Field{"free_directions", &Precision::free_directions},
  };
};

template <>
struct Layout<FreeSpaceViolation> {
  static constexpr std::string_view name = "FreeSpaceViolation";
  static constexpr std::tuple fields = {
      Field{"in_view", &FreeSpaceViolation::in_view},
      Field{"contradicting", &FreeSpaceViolation::contradicting},
  };
};

template <>
struct Layout<FreeSpace> {
  static constexpr std::string_view name = "FreeSpace";
  static constexpr std::tuple fields = {
      Field{"source", &FreeSpace::source},
      Field{"target", &FreeSpace::target},
  };
};

template <>
struct Layout<Evidence> {
  static constexpr std::string_view name = "Evidence";
  static constexpr std::tuple fields = {
      Field{"mutual_matches", &Evidence::mutual_matches}, Field{"agreeing_matches", &Evidence::agreeing_matches},
      Field{"contact_share", &Evidence::contact_share},   Field{"quality", &Evidence::quality},
      Field{"rival_odds", &Evidence::rival_odds},         Field{"free_space", &Evidence::free_space},
      Field{"voxel_size", &Evidence::voxel_size},
  };
};

template <>
struct Layout<RunnerUp> {
  static constexpr std::string_view name = "RunnerUp";
  static constexpr std::tuple fields = {
      Field{"target_from_source", &RunnerUp::target_from_source},
      Field{"share", &RunnerUp::share},
  };
};

template <>
struct Layout<Result> {
  static constexpr std::string_view name = "Result";
  static constexpr std::tuple fields = {
      Field{"registered", &Result::registered},
      Field{"confidence", &Result::confidence},
      Field{"reason", &Result::reason},
      Field{"termination", &Result::termination},
      Field{"target_from_source", &Result::target_from_source},
      Field{"has_estimate", &Result::has_estimate},
      Field{"overlap_source", &Result::overlap_source},
      Field{"overlap_target", &Result::overlap_target},
      Field{"evidence", &Result::evidence},
      Field{"runner_up", &Result::runner_up},
      Field{"precision", &Result::precision},
      Field{"rmse", &Result::rmse},
      Field{"voxel_size", &Result::voxel_size},
      Field{"loop_voxel_size", &Result::loop_voxel_size},
      Field{"source", &Result::source},
      Field{"target", &Result::target},
      Field{"source_keypoints", &Result::source_keypoints},
      Field{"target_keypoints", &Result::target_keypoints},
      Field{"iterations", &Result::iterations},
      Field{"timings_s", &Result::timings_s},
      Field{"options", &Result::options},
  };
};

template <>
struct Layout<Diagnosis> {
  static constexpr std::string_view name = "Diagnosis";
  static constexpr std::tuple fields = {
      Field{"cause", &Diagnosis::cause},
      Field{"description", &Diagnosis::description},
      Field{"target_from_source", &Diagnosis::target_from_source},
  };
};

template <>
struct Layout<ViewpointFinding> {
  static constexpr std::string_view name = "ViewpointFinding";
  static constexpr std::tuple fields = {
      Field{"viewpoint", &ViewpointFinding::viewpoint},
      Field{"reason", &ViewpointFinding::reason},
      Field{"warning", &ViewpointFinding::warning},
      Field{"parts", &ViewpointFinding::parts},
  };
};

template <>
struct Layout<PoseError> {
  static constexpr std::string_view name = "PoseError";
  static constexpr std::tuple fields = {
      Field{"rotation_rad", &PoseError::rotation_rad},
      Field{"translation", &PoseError::translation},
      Field{"centroid_displacement", &PoseError::centroid_displacement},
  };
};

template <>
struct Layout<MatchQuality> {
  static constexpr std::string_view name = "MatchQuality";
  static constexpr std::tuple fields = {
      Field{"correct", &MatchQuality::correct},
      Field{"matched", &MatchQuality::matched},
      Field{"possible", &MatchQuality::possible},
  };
};

template <>
struct Layout<SimilarityResult> {
  static constexpr std::string_view name = "SimilarityResult";
  static constexpr std::tuple fields = {
      Field{"factor", &SimilarityResult::factor},
      Field{"sigma", &SimilarityResult::sigma},
      Field{"result", &SimilarityResult::result},
  };
};

template <>
struct Layout<SimulatedScan> {
  static constexpr std::string_view name = "SimulatedScan";
  static constexpr std::tuple fields = {
      Field{"points", &SimulatedScan::points},
      Field{"world_from_scanner", &SimulatedScan::world_from_scanner},
      Field{"viewpoint", &SimulatedScan::viewpoint},
  };
};

template <>
struct Layout<NetworkScan> {
  static constexpr std::string_view name = "NetworkScan";
  static constexpr std::tuple fields = {
      Field{"name", &NetworkScan::name},
      Field{"problem", &NetworkScan::problem},
      Field{"component", &NetworkScan::component},
      Field{"world_from_scan", &NetworkScan::world_from_scan},
      Field{"covariance", &NetworkScan::covariance},
      Field{"centre", &NetworkScan::centre},
      Field{"points", &NetworkScan::points},
      Field{"control_residual", &NetworkScan::control_residual},
  };
};

template <>
struct Layout<NetworkLink> {
  static constexpr std::string_view name = "NetworkLink";
  static constexpr std::tuple fields = {
      Field{"source", &NetworkLink::source},
      Field{"target", &NetworkLink::target},
      Field{"state", &NetworkLink::state},
      Field{"origin", &NetworkLink::origin},
      Field{"merged", &NetworkLink::merged},
      Field{"reason", &NetworkLink::reason},
      Field{"target_from_source", &NetworkLink::target_from_source},
      Field{"confidence", &NetworkLink::confidence},
      Field{"overlap", &NetworkLink::overlap},
      Field{"rmse", &NetworkLink::rmse},
      Field{"mutual_matches", &NetworkLink::mutual_matches},
      Field{"agreeing_matches", &NetworkLink::agreeing_matches},
      Field{"violation", &NetworkLink::violation},
      Field{"in_view", &NetworkLink::in_view},
      Field{"consistent_triangles", &NetworkLink::consistent_triangles},
      Field{"cycle_error", &NetworkLink::cycle_error},
      Field{"residual", &NetworkLink::residual},
      Field{"median_distance", &NetworkLink::median_distance},
      Field{"rms_distance", &NetworkLink::rms_distance},
      Field{"precision", &NetworkLink::precision},
      Field{"runner_up", &NetworkLink::runner_up},
  };
};

template <>
struct Layout<NetworkContradiction> {
  static constexpr std::string_view name = "NetworkContradiction";
  static constexpr std::tuple fields = {
      Field{"scans", &NetworkContradiction::scans},
      Field{"violation", &NetworkContradiction::violation},
  };
};

template <>
struct Layout<NetworkCycle> {
  static constexpr std::string_view name = "NetworkCycle";
  static constexpr std::tuple fields = {
      Field{"scans", &NetworkCycle::scans},
      Field{"error", &NetworkCycle::error},
      Field{"closes", &NetworkCycle::closes},
  };
};

template <>
struct Layout<Network> {
  static constexpr std::string_view name = "Network";
  static constexpr std::tuple fields = {
      Field{"scans", &Network::scans},
      Field{"links", &Network::links},
      Field{"cycles", &Network::cycles},
      Field{"components", &Network::components},
      Field{"contradictions", &Network::contradictions},
      Field{"bundle_error", &Network::bundle_error},
      Field{"voxel_size", &Network::voxel_size},
      Field{"warnings", &Network::warnings},
  };
};

using AllStructs = std::tuple<StrayPoints, ScanPart, ScannedPart, Features, KeypointMatch, IterationRecord,
                              CloudSummary, FreeDirection, Precision, FreeSpaceViolation, FreeSpace, Evidence, RunnerUp,
                              Result, Diagnosis, PoseError, MatchQuality, SimilarityResult, SimulatedScan,
                              ViewpointFinding, NetworkScan, NetworkLink, NetworkCycle, NetworkContradiction, Network>;

template <typename T>
concept HasLayout = requires {
  Layout<T>::fields;
};

template <typename A, typename B>
constexpr bool same_member(A a, B b) {
  if constexpr (std::is_same_v<A, B>) {
    return a == b;
  } else {
    return false;
  }
}

/// How many fields of the list are the same as `field`.
template <typename Class, typename Member>
constexpr int times_listed(const Field<Class, Member>& field) {
  return std::apply(
      [&](const auto&... fields) { return (0 + ... + (same_member(fields.member, field.member) ? 1 : 0)); },
      Layout<Class>::fields);
}

template <typename Class>
constexpr bool lists_each_field_once() {
  constexpr auto& fields = Layout<Class>::fields;
  const bool distinct = std::apply([](const auto&... each) { return (... && (times_listed(each) == 1)); }, fields);
  return distinct && std::tuple_size_v<std::remove_cvref_t<decltype(fields)>> == field_count<Class>();
}

template <typename... Classes>
constexpr bool list_each_field_once(std::type_identity<std::tuple<Classes...>>) {
  static_assert((... && lists_each_field_once<Classes>()),
                "a struct has a field that is missing in its Layout above, or listed twice");
  return true;
}
static_assert(list_each_field_once(std::type_identity<AllStructs>()));

}  // namespace igsp::archive
