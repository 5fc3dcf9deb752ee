#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "benchmark/cases.hpp"
#include "igsp/evaluation.hpp"
#include "igsp/result.hpp"

namespace igsp::cli {

/// scrambled_from_source: a rotation, uniform over all, about the centre of the cloud's bounds, then a translation of
/// three times their diagonal in a uniform direction. Depends on the seed, the case's name and the bounds alone.
Transformation scramble(std::uint64_t seed, std::string_view case_name, const Eigen::Vector3d& centre, double diagonal);

struct Judgement {
  std::optional<bool> success;     ///< nothing where the truth is unknown
  std::optional<PoseError> error;  ///< only where there are a true transformation and an estimate
};

/// `result` is of the scrambled source; `truth` and `source_centroid` are those of the source as it is in its file. A
/// known truth asks for an estimate within the thresholds, whatever the verdict; `none` for the verdict "not
/// registered".
Judgement judge_case(const BenchmarkCase& one, const Transformation& truth, const Eigen::Vector3d& source_centroid,
                     const Transformation& scrambled_from_source, const Result& result);

/// The last iteration's correspondences against the truth with a third of r_k as the radius (Eq. 14). `truth` is that
/// of the source as `result` saw it. Nothing if there was no iteration.
std::optional<MatchQuality> judge_matches(const Result& result, const Transformation& truth);

}  // namespace igsp::cli
