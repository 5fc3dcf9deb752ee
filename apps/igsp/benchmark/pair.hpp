#pragma once

#include <cstdint>
#include <optional>

#include "benchmark/cases.hpp"
#include "files/cloud_input.hpp"

namespace igsp::cli {

/// A case in memory.
struct BenchmarkPair {
  CloudInput source, target;
  Eigen::Vector3d source_centroid;                     ///< of the source as it is in its file
  Transformation truth = Transformation::Identity();   ///< target_from_source, as in its file; identity unless known
  Transformation motion = Transformation::Identity();  ///< scrambled_from_source

  Transformation target_from_scrambled() const { return truth * motion.inverse(); }
};

/// Throws FileError, and Cancelled after an interrupt.
BenchmarkPair read_pair(const BenchmarkCase& one);

/// Moves the source by the seed's motion for this case.
void scramble_source(BenchmarkPair& pair, const BenchmarkCase& one, std::uint64_t seed);

}  // namespace igsp::cli
