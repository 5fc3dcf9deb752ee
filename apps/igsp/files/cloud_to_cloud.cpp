#include "files/cloud_to_cloud.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iostream>

#include "files/output_file.hpp"
#include "files/read_flags.hpp"
#include "igsp/errors.hpp"
#include "spatial/scale.hpp"

namespace igsp::cli {

void add_cloud_to_cloud_flags(CLI::App& command, CloudToCloud& settings, const std::string& written) {
  command.add_option("CLOUD", settings.source, "the cloud that is read")->required()->type_name("");
  command.add_option("-o,--output", settings.output, wrapped(written))->required()->type_name("FILE");
  add_read_flags(command, settings.read);
  command.add_flag("--quiet", settings.quiet, "no progress and no warnings");
}

void check_cloud_to_cloud(const CloudToCloud& settings) {
  if (same_file(settings.output, settings.source)) {
    throw InvalidArgument(fmt::format("-o and CLOUD are the same file, {}", settings.output.string()));
  }
  check_writable(settings.output);
}

void print_left_out(const CloudToCloud& settings, const CloudInput& cloud) {
  if (settings.quiet) return;
  for (const std::string& line : left_out_of(cloud)) std::cerr << "igsp: warning: " << line << "\n";
}

double tolerance_of(PointView sample) {
  const auto differs = [&](const Eigen::Vector3d& point) { return point != sample.front(); };
  if (std::ranges::none_of(sample, differs)) return 0.0;
  return 1e-4 * choose_voxel_size(sample, sample, {});
}

}  // namespace igsp::cli
