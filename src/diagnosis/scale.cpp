#include "diagnosis/scale.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "registration/precision.hpp"
#include "registration/scale_votes.hpp"
#include "registration/similarity_search.hpp"

namespace igsp {
namespace {

constexpr double least_difference = 0.03;  // of the logarithm: less is no matter of scale
constexpr double enough_prominence = 8.0;
constexpr double like_sizes = 2.0;     // beyond that no descriptor finds its like in voxels of one size
constexpr double named_factor = 0.01;  // of the logarithm, to be called by its name

struct Unit {
  double metres;
  std::string_view name;
};
constexpr std::array<Unit, 6> units{{{1, "metres"},
                                     {0.001, "millimetres"},
                                     {0.01, "centimetres"},
                                     {0.3048, "feet"},
                                     {0.0254, "inches"},
                                     {1000, "kilometres"}}};

// "; 0.3048 turns feet into metres", or nothing where no two units are that far apart.
std::string in_units(double factor) {
  for (const Unit& to : units) {
    for (const Unit& from : units) {
      const double between = from.metres / to.metres;
      if (between != 1 && std::abs(std::log(factor / between)) < named_factor) {
        return fmt::format("; {:.6g} turns {} into {}", between, from.name, to.name);
      }
    }
  }
  return "";
}

bool is_another(double factor) {
  return std::abs(std::log(factor)) > least_difference;
}

std::vector<double> factors_to_try(const Scan& source, const Scan& target, const SearchedPair& pair,
                                   const Result& refused, const ProgressCallback& progress) {
  // At a pose that is otherwise as good as not, the surfaces know; at a wrong one they tell any factor.
  if (refused.evidence.quality > 0 && is_of_another_scale(refused.precision)) return {refused.precision.scale};
  const RatioPeak vote = scale_vote(pair.source, pair.target, 1.0, pair.options);
  if (vote.prominence >= enough_prominence && is_another(vote.factor)) return {vote.factor};
  const double ratio = size_of(pair.target.points) / size_of(pair.source.points);
  if (ratio > 1 / like_sizes && ratio < like_sizes) return {};
  Options options = pair.options;
  options.scale.target_points = std::max(1, refused.options.scale.target_points / 2);
  return voted_factors(source, target, options, progress);
}

}  // namespace

std::optional<Diagnosis> another_scale(const Scan& source, const Scan& target, const SearchedPair& pair,
                                       const Result& refused, const ProgressCallback& progress) {
  Options options = refused.options;
  options.scale.voxel_size = 0;  // that of the refused answer comes from both clouds as they are
  for (const double factor : factors_to_try(source, target, pair, refused, progress)) {
    const SimilarityResult found = similarity_near(source, target, factor, options, progress);
    if (!found.result.registered || !is_another(found.factor)) continue;
    return Diagnosis{
        Cause::scale,
        fmt::format("the source would register multiplied by {:.5g} (confidence {:.3f}){}: the clouds have "
                    "different units of length or one is measured too long; scale it, or let --scale auto "
                    "find the factor",
                    found.factor, found.result.confidence, in_units(found.factor)),
        found.matrix()};
  }
  return std::nullopt;
}

}  // namespace igsp
