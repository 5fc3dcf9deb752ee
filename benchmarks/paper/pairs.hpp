#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "igsp/point_cloud.hpp"

namespace igsp::paper {

/// Two clouds as every method of the evaluation meets them, and their true relation.
struct Pair {
  std::string name;
  std::string dataset;
  Points source, target;
  Transformation truth = Transformation::Identity();  ///< target_from_source
  double max_rotation_error_deg = 0.0;
  double max_displacement = 0.0;  ///< of the source's centroid [m]
};

/// Writes the pairs of the evaluation into `folder`: clouds, true relations and cases.csv, as `igsp benchmark` reads
/// it. Four pairs of each data set: simulated Park at 65 % and Indoor at 70 % overlap; and from `scans`, if that folder
/// has a cases.csv, the Stanford pairs of about 30 %, others of about 80 %, and facade pairs of about 65 %. Every
/// source is moved at random.
void write_pairs(const std::filesystem::path& scans, const std::filesystem::path& folder);

std::vector<Pair> read_pairs(const std::filesystem::path& folder);

}  // namespace igsp::paper
