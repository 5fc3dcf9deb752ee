#include "config/option_list.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <type_traits>

#include "config/field_count.hpp"

namespace igsp {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

constexpr Range any() {
  return {-infinity, infinity};
}
constexpr Range between(double low, double high) {
  return {low, high};
}
constexpr Range above_up_to(double low, double high) {
  return {low, high, true};
}
constexpr Range up_to(double high) {
  return {-infinity, high};
}
constexpr Range from(double low) {
  return {low, infinity};
}
constexpr Range either(double low, double high) {
  return {low, high, false, false, Range::Shape::ends_only};
}

// Names of the enumerators, in the order of their values.
template <typename Enumeration>
constexpr std::array<std::string_view, 0> names{};
template <>
constexpr std::array<std::string_view, 2> names<Search>{"direct", "hypotheses"};
template <>
constexpr std::array<std::string_view, 2> names<ThresholdRule>{"paper", "released"};

template <auto field_of>
using FieldType = std::remove_cvref_t<decltype(field_of(std::declval<Options&>()))>;

template <auto field_of>
OptionValue get_field(const Options& options) {
  const auto field = field_of(options);
  if constexpr (std::is_enum_v<FieldType<field_of>>) {
    const auto index = static_cast<std::size_t>(field);
    const auto& all = names<FieldType<field_of>>;
    return index < all.size() ? std::string(all[index]) : std::to_string(index);
  } else {
    return field;
  }
}

template <auto field_of>
void set_field(Options& options, const OptionValue& value) {
  using Field = FieldType<field_of>;
  if constexpr (std::is_enum_v<Field>) {
    const auto& all = names<Field>;
    const auto found = std::find(all.begin(), all.end(), std::get<std::string>(value));
    field_of(options) = static_cast<Field>(found - all.begin());
  } else {
    field_of(options) = std::get<Field>(value);
  }
}

template <auto field_of>
constexpr Option make_option(std::string_view key, std::string_view section, std::string_view flag,
                             std::string_view unit, Range range, std::string_view help) {
  using Field = FieldType<field_of>;
  static_assert(std::is_same_v<Field, bool> || std::is_same_v<Field, int> || std::is_same_v<Field, double> ||
                std::is_enum_v<Field>);
  Option option{
      key, section, flag, unit, range, any(), help, OptionKind::choice, {}, get_field<field_of>, set_field<field_of>};
  if constexpr (std::is_enum_v<Field>) {
    static_assert(!names<Field>.empty(), "list the names of the enumerators above");
    option.choices = names<Field>;
  } else if constexpr (std::is_same_v<Field, bool>) {
    option.kind = OptionKind::boolean;
  } else {
    option.kind = std::is_same_v<Field, int> ? OptionKind::integer : OptionKind::real;
  }
  return option;
}

// An option and, for the proof of completeness below, the number of fields its section has.
struct Listed {
  Option option;
  std::size_t section_fields;
};

// Outside of `usual` pairs are lost. Of nine simulated pairs (park, indoor and object of 30,000 points, seeds 1 to 3)
// that the default registers, at least seven are registered at every value within it, the others at their defaults.
constexpr Listed usually(Range usual, Listed listed) {
  listed.option.usual = usual;
  return listed;
}

#define TOP(field, flag, unit, range, help)    \
  Listed {                                     \
    make_option < [](auto& o) -> auto& {       \
      return o.field;                          \
    }                                          \
    > (#field, "", flag, unit, range, help), 0 \
  }
#define IN(section, field, flag, unit, range, help)                                                       \
  Listed {                                                                                                \
    make_option < [](auto& o) -> auto& {                                                                  \
      return o.section.field;                                                                             \
    }                                                                                                     \
    > (#section "." #field, #section, flag, unit, range, help), field_count<decltype(Options::section)>() \
  }

// clang-format off
constexpr std::array listed{
    TOP(search, "--search", "", any(), "how the starting correspondences are found"),
    TOP(degrees_of_freedom, "--dof", "", either(4, 6), "6, or 4 for levelled scans (yaw and translation)"),
    TOP(level, "--level", "", between(0.5, 1), "registered from this confidence on; nothing else depends on it"),
    TOP(threads, "--threads", "", between(0, 1024), "0: all processors; the result does not depend on it"),
    IN(scale, voxel_size, "--voxel-size", "units of the cloud", between(0, 1e150), "size of the voxel filter and unit of all lengths; 0: chosen from both clouds"),
    usually(from(1000), IN(scale, target_points, "--target-points", "", between(100, 100000000), "voxel centroids aimed at when the size is chosen, geometric mean of both clouds")),
    usually(between(3, 50), IN(keypoints, pca_radius, "--pca-radius", "voxels", above_up_to(0, 100), "r_f: sphere of the principal component analysis")),
    usually(between(0.5, 6), IN(keypoints, suppression_radius, "--suppression-radius", "voxels", above_up_to(0, 1e6), "r_k: non-maximum suppression")),
    IN(keypoints, max_eigenvalue_ratio, "--max-eigenvalue-ratio", "", above_up_to(0, 1), "rho: upper bound of l2/l1 and of l3/l2; 1: no bound"),
    usually(up_to(100), IN(keypoints, min_neighbours, "--min-neighbours", "", between(0, 1000000000), "n_min: a keypoint has more neighbours than this")),
    usually(up_to(0.05), IN(keypoints, min_curvature, "--min-curvature", "", between(0, 0.33), "c_min: smallest surface variation l3 / (l1 + l2 + l3)")),
    usually(between(4, 30), IN(descriptor, radius, "--descriptor-radius", "voxels", above_up_to(0, 100), "R: half the side of the Binary Shape Context's grid")),
    IN(energy, distance_scale, "--distance-scale", "bits", above_up_to(0, 1e6), "bits that one suppression radius of distance weighs: s_ed = this / r_k (Eq. 3)"),
    IN(energy, weight_changing_rate, "--weight-changing-rate", "iterations", above_up_to(0, 1e6), "m: how slowly the weight moves from feature to distance (Eq. 7)"),
    IN(energy, threshold_rule, "--threshold-rule", "", any(), "rule for the mismatch threshold T_cd"),
    IN(energy, p1, "--p1", "", between(0, 1e6), "first iteration: sigmas below the mean (Eq. 11)"),
    IN(energy, p2, "--p2", "", above_up_to(0, 1e6), "later: factor of the mean Euclidean distance (Eq. 11)"),
    IN(energy, p3, "--p3", "", above_up_to(0, 1e6), "later: factor of the mean feature distance (Eq. 11)"),
    IN(energy, released_p_ed, "--released-p-ed", "", above_up_to(0, 1e6), "released rule: factor of the RMS Euclidean distance"),
    IN(energy, released_p_fd, "--released-p-fd", "", between(0, 1e6), "released rule: deviations added to the mean feature distance"),
    IN(energy, min_threshold, "--min-threshold", "bits", above_up_to(0, 435), "floor of T_cd"),
    IN(hypotheses, candidates_per_keypoint, "--candidates-per-keypoint", "", between(1, 20), "candidates of least feature distance, from both sides"),
    IN(hypotheses, max_candidates, "--max-candidates", "", between(3, 20000), "candidates kept: those that stand out most"),
    IN(hypotheses, length_tolerance, "--length-tolerance", "voxels", above_up_to(0, 1e6), "two candidates agree when their lengths differ by less than this"),
    IN(hypotheses, min_length, "--min-length", "voxels", between(0, 1e6), "lengths below this say nothing about agreement"),
    IN(hypotheses, max_frame_angle_rad, "--max-frame-angle-rad", "rad", above_up_to(0, 3.1416), "two candidates agree when the rotations of their frames differ by less than this"),
    IN(hypotheses, max_proposed, "--max-proposed", "", between(1, 1000), "hypotheses screened by matching again in a common frame; twice as many where both viewpoints are known"),
    IN(hypotheses, max_refined, "--max-refined", "", between(1, 1000), "hypotheses refined and ranked; likewise"),
    IN(convergence, max_iterations, "--max-iterations", "", between(1, 10000), "the loop ends here at the latest"),
    IN(convergence, rotation_tolerance_rad, "--rotation-tolerance-rad", "rad", between(0, 3.14), "converged when the rotation step is below this ..."),
    IN(convergence, translation_tolerance, "--translation-tolerance", "voxels", between(0, 1e6), "... and the step of the keypoint centroid is below this"),
    IN(refinement, enabled, "--refinement", "", any(), "point-to-plane refinement on the dense clouds after the loop"),
};
// clang-format on
#undef TOP
#undef IN

// A field that was added to Options and forgotten above does not build: every section has as many entries as its
// aggregate has fields, and sections and top-level entries together are the fields of Options.
constexpr bool complete() {
  std::size_t top_level_fields = 0;
  for (std::size_t i = 0; i < listed.size(); ++i) {
    const std::string_view section = listed[i].option.section;
    const bool starts_section = i == 0 || listed[i - 1].option.section != section;
    if (section.empty() || starts_section) ++top_level_fields;
    std::size_t in_section = 0;
    for (const Listed& other : listed) in_section += other.option.section == section;
    if (!section.empty() && in_section != listed[i].section_fields) return false;
  }
  return top_level_fields == field_count<Options>();
}
static_assert(complete(), "a field of Options is missing in the list, or a section is torn apart");

constexpr auto options_alone = [] {
  std::array<Option, listed.size()> all{};
  for (std::size_t i = 0; i < listed.size(); ++i) all[i] = listed[i].option;
  return all;
}();

}  // namespace

std::span<const Option> option_list() {
  return options_alone;
}

std::string_view name_in_section(const Option& option) {
  return option.section.empty() ? option.key : option.key.substr(option.section.size() + 1);
}

}  // namespace igsp
