// Two clouds, viewpoints and options out of arbitrary bytes: a documented error, or a proper rotation and a verdict.
#include <cmath>
#include <optional>

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

std::optional<Eigen::Vector3d> viewpoint_of(Bytes& bytes) {
  if (bytes.byte() % 2 == 0) return {};
  return bytes.point();
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
  const auto source_viewpoint = viewpoint_of(bytes), target_viewpoint = viewpoint_of(bytes);
  const std::size_t sources = bytes.byte();
  const igsp::Points source = igsp::fuzzing::cloud(bytes, sources), target = igsp::fuzzing::cloud(bytes, 4096);
  try {
    check(igsp::align({source, source_viewpoint}, {target, target_viewpoint}, options));
    check(igsp::align({source, source_viewpoint}, {source, source_viewpoint}, options));
  } catch (const igsp::InvalidArgument&) {
  }
  return 0;
}
