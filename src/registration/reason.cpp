#include "registration/reason.hpp"

#include <fmt/format.h>

#include "core/percent.hpp"
#include "registration/precision.hpp"

namespace igsp {
namespace {

std::string free_motions(const std::vector<FreeDirection>& directions) {
  std::string text;
  for (const FreeDirection& direction : directions) text += (text.empty() ? "" : ", ") + direction.description;
  return text;
}

std::string why_no_estimate(const Result& result) {
  switch (result.termination) {
    case Termination::too_few_keypoints:
      return fmt::format("too few keypoints: {} in the source, {} in the target; at least 3 are needed",
                         result.source.keypoints, result.target.keypoints);
    case Termination::degenerate_matches:
      return "the correspondences lie on a line and fix no rotation";
    default:
      return "no three correspondences agree on a transformation";
  }
}

// Of each scan, as far as the other one's scanner can tell.
std::string seen_through(const FreeSpace& free_space) {
  std::string parts, unseen;
  const auto add = [&](const std::optional<FreeSpaceViolation>& violation, std::string_view cloud) {
    if (!violation) return;
    if (violation->in_view == 0) {
      unseen += fmt::format("; the other scanner could see nothing of the {}", cloud);
      return;
    }
    parts += fmt::format("{}{} of the {}", parts.empty() ? "; " : " and ", percent(violation->share()), cloud);
  };
  add(free_space.source, "source");
  add(free_space.target, "target");
  if (!parts.empty()) parts += " in space that the other scanner saw through";
  return parts + unseen;
}

std::string in_words(const Result& result) {
  const Evidence& e = result.evidence;
  std::string text = fmt::format(
      "{} of {} mutual matches agree; overlap {:.2f}; surfaces touch at {:.0f} % of the places where they meet",
      e.agreeing_matches, e.mutual_matches, result.overlap(), 100 * e.contact_share);
  text += seen_through(e.free_space);
  if (result.runner_up) text += fmt::format("; runner-up explains {:.0f} %", 100 * result.runner_up->share);
  return text;
}

// On itself the target lies as well as it can, so a motion that it allows shows even where the estimate is poor or
// none.
void name_what_the_target_leaves_free(const PreparedCloud& target, Result& result) {
  result.precision.free_directions = free_directions(target, target, Transformation::Identity());
  if (result.precision.free_directions.empty()) return;
  result.reason += "; the target alone leaves free: " + free_motions(result.precision.free_directions);
}

}  // namespace

void give_reason(const PreparedCloud& target, const Doubts& doubts, Result& result) {
  if (!result.has_estimate) {
    result.reason = why_no_estimate(result);
    name_what_the_target_leaves_free(target, result);
    return;
  }
  const bool is_free = !result.precision.free_directions.empty();
  result.reason = in_words(result);
  if (is_free) result.reason += "; not fixed by the surfaces: " + free_motions(result.precision.free_directions);
  if (doubts.is_of_another_scale) {
    result.reason +=
        fmt::format("; in another scale: the source fits best multiplied by {:.3f}, which no rigid motion does",
                    result.precision.scale);
  }
  if (doubts.is_coarse) {
    result.reason +=
        fmt::format("; the surfaces meet at voxels of {:.3g} but not at {:.3g}, so the pose is coarse at best",
                    result.evidence.voxel_size, result.voxel_size);
  }
  if (doubts.mirror_image_fits) {
    result.reason += "; the mirrored source fits better: a cloud is left-handed, or the scene is like its mirror image";
  }
  const bool is_explained = is_free || doubts.is_of_another_scale || doubts.is_coarse || doubts.mirror_image_fits;
  if (result.registered || is_explained) return;
  if (result.confidence >= 0.5) {
    result.reason +=
        fmt::format("; a confidence of {:.2f} is below the level of {}", result.confidence, result.options.level);
    return;
  }
  result.reason += doubts.is_ambiguous ? "; ambiguous: another pose explains the clouds about as well"
                                       : "; too little to tell it from chance";
  name_what_the_target_leaves_free(target, result);
}

}  // namespace igsp
