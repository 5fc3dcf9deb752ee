#include "network/measured_graph.hpp"

#include <algorithm>
#include <cmath>

#include "registration/precision.hpp"
#include "registration/verdict.hpp"

namespace igsp {
namespace {

// Beyond what residuals tell, a fine registration errs by the sampling of the surfaces and what moved between the
// scans: this much at one sigma.
constexpr double pull_floor = 0.1;  // [voxels]

// What is right within two or three voxels is right; loops are judged by it.
constexpr double judging_floor = 0.7;  // [voxels]

// Right poses have at most 0.05 and half of them 0.002 (docs/network.md). Up to the first, seen well, nothing speaks
// against a pair; beyond doubtful_violation it does not confirm others like it; beyond the second it needs others to
// confirm it; beyond the last it is out.
constexpr double clear_violation = 0.002;
constexpr double lonely_violation = 0.06;
constexpr double forbidden_violation = 0.12;
constexpr std::size_t least_in_view = 100;

// Of about 1000 voxels: what rooms share through a door. Of 37 right links between groups every one had a pair of
// scans that meets so much, and of 60 pairs of a wrong one that nothing contradicted none.
constexpr std::size_t least_meeting = 30;

// What a witness in favour is worth, and what a link needs with them [decades of odds]. In 18 networks of buildings all
// 7 refused links with 3 witnesses and more that left no direction free were right, and of 44 without any 39 were
// wrong.
constexpr double worth_of_witness = 0.5, needed_odds = 0.5;
constexpr double least_confidence = 0.05;

constexpr double least_weight = 0.1, greatest_weight = 5;  // log odds

Matrix6 floor_of(double sigma, double size) {
  Vector6 squares;
  squares << Eigen::Vector3d::Constant(size > 0 ? sigma * sigma / (size * size) : 1),
      Eigen::Vector3d::Constant(sigma * sigma);
  return squares.asDiagonal();
}

// The same covariance with lengths in voxels.
Matrix6 in_voxels(const Matrix6& covariance, double voxel_size) {
  Vector6 scale;
  scale << Eigen::Vector3d::Ones(), Eigen::Vector3d::Constant(1 / voxel_size);
  return scale.asDiagonal() * covariance * scale.asDiagonal();
}

// The scanners saw much of each other's scans, and nothing in the way.
bool is_clear(const NetworkLink& link) {
  return link.in_view >= least_in_view && link.violation <= clear_violation;
}

bool may_stand_alone(const NetworkLink& link, const NetworkOptions& options) {
  if (link.origin == LinkOrigin::runner_up) return false;
  if (link.state == LinkState::not_registered) return may_be_right(link, options);
  return (is_clear(link) || link.confidence >= options.min_unconfirmed_confidence) &&
         link.agreeing_matches >= options.min_unconfirmed_matches && link.violation <= lonely_violation;
}

// None where no witness makes up for what the pair itself says.
std::optional<std::size_t> witnesses_needed(const NetworkLink& link) {
  if (link.violation > clear_violation || link.confidence < least_confidence) return {};
  if (!link.precision.free_directions.empty()) return {};
  const double odds = std::log10(link.confidence / std::max(1e-12, 1 - link.confidence));
  return static_cast<std::size_t>(std::max(1.0, std::ceil((needed_odds - odds) / worth_of_witness)));
}

GraphLink graph_link(const NetworkLink& link, const ScanShape& source, double voxel_size,
                     const NetworkOptions& options) {
  GraphLink result;
  result.source = link.source;
  result.target = link.target;
  result.target_from_source = link.target_from_source;
  result.target_from_source.translation() /= voxel_size;
  result.centre = link.precision.centre / voxel_size;
  const Matrix6 covariance = in_voxels(link.precision.covariance, voxel_size);
  result.information = (covariance + floor_of(pull_floor, source.size / voxel_size)).inverse();
  result.tolerance = covariance + floor_of(judging_floor, source.size / voxel_size);
  result.weight = vote_of(link.confidence);
  result.may_stand_alone = may_stand_alone(link, options);
  result.witnesses_needed = witnesses_needed(link);
  result.confirms_nothing =
      link.origin != LinkOrigin::pair || (link.state == LinkState::not_registered && !may_be_right(link, options));
  result.is_doubtful = is_doubtful(link);
  return result;
}

}  // namespace

ScanShape shape_of(const Features& features) {
  ScanShape shape;
  for (const Eigen::Vector3d& point : features.points) shape.centre += point / features.points.size();
  for (const Eigen::Vector3d& point : features.points) {
    shape.reach = std::max(shape.reach, (point - shape.centre).norm());
  }
  if (features.viewpoint) shape.reach = std::max(shape.reach, (*features.viewpoint - shape.centre).norm());
  for (const ScannedPart& part : features.parts) {
    shape.reach = std::max(shape.reach, (part.viewpoint - shape.centre).norm());
  }
  shape.centre += features.origin;
  shape.size = size_of(features.points);
  return shape;
}

bool may_be_right(const NetworkLink& link, const NetworkOptions& options) {
  return is_clear(link) && link.agreeing_matches >= options.min_unconfirmed_matches &&
         link.precision.free_directions.empty() && link.confidence > confidence_of_what_cannot_be;
}

Witness witness_of(const SeenTogether& seen) {
  const double violation = seen.free_space.violation();
  if (violation > lonely_violation) return Witness::against;
  if (violation > doubtful_violation) return Witness::doubtful;
  return violation <= clear_violation && seen.meeting >= least_meeting ? Witness::in_favour : Witness::none;
}

double vote_of(double confidence) {
  return std::clamp(std::log(confidence / std::max(1e-12, 1 - confidence)), least_weight, greatest_weight);
}

bool is_used(const NetworkLink& link) {
  return link.state == LinkState::used || link.state == LinkState::unconfirmed;
}

bool is_doubtful(const NetworkLink& link) {
  return link.violation > doubtful_violation;
}

bool contradicts_free_space(const NetworkLink& link) {
  return link.violation > forbidden_violation;
}

MeasuredGraph measured_graph(std::span<const NetworkLink> links, std::span<const ScanShape> shapes, double voxel_size,
                             const NetworkOptions& options) {
  MeasuredGraph measured;
  measured.graph.degrees_of_freedom = options.pair.degrees_of_freedom;
  for (const ScanShape& shape : shapes) measured.graph.centres.push_back(shape.centre / voxel_size);
  for (std::size_t i = 0; i < links.size(); ++i) {
    const bool is_there =
        links[i].state != LinkState::not_registered || may_be_right(links[i], options) || witnesses_needed(links[i]);
    if (!is_there || links[i].state == LinkState::rejected || contradicts_free_space(links[i])) continue;
    measured.graph.links.push_back(graph_link(links[i], shapes[links[i].source], voxel_size, options));
    measured.link_of.push_back(i);
  }
  return measured;
}

MeasuredGraph without_unused_refused(const MeasuredGraph& measured, std::span<const NetworkLink> links,
                                     const NetworkOptions& options, Forest& forest) {
  const LinkGraph& all = measured.graph;
  MeasuredGraph kept{{all.centres, {}, all.degrees_of_freedom}, {}};
  std::vector<bool> is_contradicted;
  std::vector<std::size_t> renumbered(all.links.size());
  for (std::size_t l = 0; l < all.links.size(); ++l) {
    const NetworkLink& link = links[measured.link_of[l]];
    const bool is_refused = link.state == LinkState::not_registered && !may_be_right(link, options);
    if (is_refused && std::ranges::find(forest.links, l) == forest.links.end()) continue;
    renumbered[l] = kept.link_of.size();
    kept.graph.links.push_back(all.links[l]);
    kept.link_of.push_back(measured.link_of[l]);
    is_contradicted.push_back(forest.is_contradicted[l]);
  }
  for (std::size_t& l : forest.links) l = renumbered[l];
  forest.is_contradicted = std::move(is_contradicted);
  return kept;
}

}  // namespace igsp
