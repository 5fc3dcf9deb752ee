#pragma once

#include <vector>

#include "igsp/features.hpp"
#include "matching/length_ratios.hpp"

namespace igsp {

/// What the candidates between two clouds say of the factor that the source would have to be multiplied by, on top of
/// `expected`: the source's features are those of voxels that many times smaller than the target's.
RatioPeak scale_vote(const Features& source, const Features& target, double expected, const Options& options);

/// Factors of scale between two clouds that enough candidates vote for, most prominent first. Also far from 1, where
/// both clouds show about the same: then each is looked at in voxels of its own size. `options`: how fine; the more
/// voxels, the surer the vote.
std::vector<double> voted_factors(const Scan& source, const Scan& target, const Options& options,
                                  const ProgressCallback& progress);

/// The scan, all lengths multiplied.
struct ScaledScan {
  ScaledScan(const Scan& scan, double factor);
  Scan scan() const;
  Points points;
  std::optional<Eigen::Vector3d> viewpoint;
  std::vector<ScanPart> parts;
};

}  // namespace igsp
