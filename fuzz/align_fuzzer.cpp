// Two clouds, viewpoints, parts and options out of arbitrary bytes: a documented error, or a proper rotation and a
// verdict.
#include <algorithm>
#include <cmath>
#include <vector>

#include "bytes.hpp"
#include "config/option_list.hpp"
#include "fuzzing.hpp"
#include "igsp/align.hpp"

namespace {

using igsp::fuzzing::Bytes;
using igsp::fuzzing::require;

/// A value of an option's range, near its lower end more often; sometimes any double.
igsp::OptionValue value_of(const igsp::Option& option, Bytes& bytes) {
  switch (option.kind) {
    case igsp::OptionKind::boolean:
      return bytes.byte() % 2 == 1;
    case igsp::OptionKind::choice:
      return std::string(option.choices[bytes.byte() % option.choices.size()]);
    case igsp::OptionKind::integer:
      return static_cast<int>(bytes.take<std::uint16_t>()) - 2;
    case igsp::OptionKind::real:
      break;
  }
  const std::uint8_t kind = bytes.byte();
  return kind < 200 ? 0.05 * kind * bytes.byte() : bytes.number();
}

igsp::Options options_of(Bytes& bytes) {
  igsp::Options options;
  options.hypotheses.max_proposed = 20;
  options.hypotheses.max_refined = 5;
  for (std::uint8_t left = bytes.byte() % 6; left > 0; --left) {
    const igsp::Option& option = igsp::option_list()[bytes.byte() % igsp::option_list().size()];
    option.set(options, value_of(option, bytes));  // unchecked: align must do that
  }
  options.threads = 1;
  return options;
}

/// Parts, in number and size as the bytes say, the last one mostly with what is left of the points.
std::vector<igsp::ScanPart> parts_of(std::size_t points, Bytes& bytes) {
  std::vector<igsp::ScanPart> parts(1 + bytes.byte() % 4);
  for (igsp::ScanPart& part : parts) {
    part.points = std::min<std::size_t>(points, bytes.take<std::uint16_t>());
    if (bytes.byte() % 4 != 0) part.viewpoint = bytes.point();
    points -= part.points;
  }
  if (bytes.byte() != 0) parts.back().points += points;  // otherwise they do not add up: align must refuse that
  return parts;
}

/// A scan of these points, seen from nowhere, from one place, or fused of several scans.
igsp::Scan scan_of(const igsp::Points& points, std::uint8_t kind, Bytes& bytes) {
  igsp::Scan scan(points);
  if (kind % 4 == 1) scan.viewpoint = bytes.point();
  if (kind % 4 == 3) scan.parts = parts_of(points.size(), bytes);
  return scan;
}

void check(const igsp::Result& result) {
  require(!result.reason.empty());
  require(std::isfinite(result.confidence) && result.confidence >= 0 && result.confidence <= 1);
  if (result.registered) require(result.has_estimate);
  if (!result.has_estimate) return;
  const Eigen::Matrix3d rotation = result.target_from_source.linear();
  require(result.target_from_source.matrix().allFinite());
  require((rotation * rotation.transpose()).isIdentity(1e-6) && rotation.determinant() > 0.999);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Bytes bytes(data, size);
  const igsp::Options options = options_of(bytes);
  const std::uint8_t source_kind = bytes.byte(), target_kind = bytes.byte(), sources = bytes.byte(),
                     targets = bytes.byte();
  const igsp::Points source_points = igsp::fuzzing::cloud(bytes, sources),
                     target_points = igsp::fuzzing::cloud(bytes, targets);
  const igsp::Scan source = scan_of(source_points, source_kind, bytes),
                   target = scan_of(target_points, target_kind, bytes);
  try {
    check(igsp::align(source, target, options));
    check(igsp::align(source, source, options));
  } catch (const igsp::InvalidArgument&) {
  }
  return 0;
}
