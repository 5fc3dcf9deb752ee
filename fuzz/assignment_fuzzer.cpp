// Sparse assignment problems out of arbitrary bytes: the optimum of the padded dense one, with its proof, or a refusal
// of what is no problem.
#include "bytes.hpp"
#include "fuzzing.hpp"
#include "matching/assignment_oracles.hpp"

namespace {

/// Mostly edges in order and costs below the threshold; now and then neither.
igsp::AssignmentProblem problem_of(igsp::fuzzing::Bytes& bytes) {
  igsp::AssignmentProblem problem;
  problem.sources = bytes.byte() % 24;
  problem.targets = bytes.byte() % 24;
  const bool wild = bytes.byte() == 255;
  problem.threshold = wild ? bytes.take<std::int64_t>() : bytes.take<std::uint16_t>();
  const int steps = 1 + bytes.byte() % 8;
  std::size_t cell = 0;
  while (!bytes.empty() && problem.targets > 0) {
    cell += bytes.byte() % steps + (wild ? 0 : 1);
    const std::size_t source = (cell - 1) / problem.targets, target = (cell - 1) % problem.targets;
    if (source >= problem.sources) break;
    const std::int64_t cost =
        wild ? bytes.take<std::int64_t>() : bytes.take<std::uint16_t>() % std::max<std::int64_t>(1, problem.threshold);
    if (cost >= problem.threshold && !wild) break;
    problem.edges.push_back({static_cast<std::uint32_t>(source), static_cast<std::uint32_t>(target), cost});
  }
  return problem;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using igsp::fuzzing::require;
  igsp::fuzzing::Bytes bytes(data, size);
  const igsp::AssignmentProblem problem = problem_of(bytes);
  igsp::Assignment found;
  try {
    found = igsp::solve(problem);
  } catch (const igsp::InvalidArgument&) {
    return 0;
  }
  require(igsp::certificate_holds(problem.sources, problem.targets, problem.edges, problem.threshold, found));
  if (problem.threshold > INT64_MAX / 64) return 0;  // the oracle's sums would leave 64 bits
  const std::size_t padded = std::max(problem.sources, problem.targets);
  const std::int64_t padding = problem.threshold * static_cast<std::int64_t>(padded - problem.sources);
  require(igsp::kuhn_munkres(padded, igsp::padded_matrix(problem)) == found.energy + padding);
  return 0;
}
