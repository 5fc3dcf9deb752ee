#include <fmt/format.h>

#include <iostream>

#include "files/cloud_to_cloud.hpp"
#include "files/foreign_formats.hpp"
#include "files/moved_output.hpp"
#include "igsp/io.hpp"
#include "io/moved_copy.hpp"
#include "shell/commands.hpp"
#include "shell/exit_codes.hpp"
#include "shell/progress_bar.hpp"

namespace igsp::cli {
namespace {

struct TransformSettings {
  CloudToCloud clouds;
  std::filesystem::path transformation;
  bool inverse = false;
};

// A first pass tells whether the moved coordinates fit into floats. LAS and survey formats keep the grid of integers
// that they have: nothing to be told.
CloudInput first_pass(const CloudToCloud& clouds, const ProgressCallback& progress) {
  if (!moves_foreign(clouds.source, clouds.output) && !moves_las(clouds.source, clouds.output)) {
    return sample_cloud(clouds.source, sample_size, "read", progress, clouds.read);
  }
  CloudInput cloud;
  cloud.path = clouds.source;
  return cloud;
}

// Floats stay floats where they resolve what the cloud does. A change of format keeps every bit.
double rounding_allowed(const CloudToCloud& clouds, PointView sample) {
  const bool same_types = !reads_foreign(clouds.source) && io::keeps_properties(clouds.source, clouds.output);
  return same_types ? tolerance_of(sample) : 0.0;
}

int run_transform(const TransformSettings& settings) {
  const CloudToCloud& clouds = settings.clouds;
  check_cloud_to_cloud(clouds);
  check_moved_output(clouds.source, clouds.output);
  Transformation motion = read_transformation(settings.transformation);
  if (settings.inverse) motion = motion.inverse();
  ProgressBar bar(!clouds.quiet);
  CloudInput source = first_pass(clouds, bar.callback());
  bar.finish();
  const double tolerance = rounding_allowed(clouds, source.points);
  source.points = {};
  print_left_out(clouds, source);
  const std::vector<std::string> notes = write_moved_output(source, clouds.output, motion, tolerance, bar.callback());
  bar.finish();
  for (const std::string& note : notes) std::cout << note << "\n";
  return exit_registered;
}

constexpr const char* examples =
    "Examples:\n"
    "  igsp transform scan.ply --transform T.txt -o moved.ply\n"
    "  igsp transform moved.ply --transform T.txt --inverse -o back.ply\n"
    "Chunk by chunk, in memory that does not grow with the cloud (PCD binary_compressed is one block, which does). "
    "PLY,\n"
    "PCD, LAS and text (XYZ, TXT, CSV, PTS) keep all that belongs to their points: `igsp align -o` writes the same "
    "file.\n"
    "The command of the Python package moves LAZ, E57 and PTX as well.";

}  // namespace

void add_transform_command(CLI::App& app, Command& command) {
  CLI::App* transform =
      app.add_subcommand("transform", "a cloud moved by a transformation file, with all its properties");
  const auto settings = std::make_shared<TransformSettings>();
  add_cloud_to_cloud_flags(*transform, settings->clouds,
                           "the moved cloud, with all properties of CLOUD if FILE has its format");
  transform
      ->add_option("--transform", settings->transformation,
                   "what moves it: output_from_cloud, 4x4 text, as `igsp align --transform` writes it")
      ->required()
      ->type_name("FILE");
  transform->add_flag("--inverse", settings->inverse, "moves back: the inverse of the transformation");
  transform->footer(examples);
  transform->callback([settings, &command] { command = [settings] { return run_transform(*settings); }; });
}

}  // namespace igsp::cli
