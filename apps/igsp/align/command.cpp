#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <iostream>
#include <iterator>
#include <new>
#include <optional>

#include "align/answer.hpp"
#include "align/scale_request.hpp"
#include "config/option_list.hpp"
#include "core/concurrently.hpp"
#include "files/cloud_input.hpp"
#include "files/foreign_formats.hpp"
#include "files/moved_output.hpp"
#include "files/output_file.hpp"
#include "files/read_flags.hpp"
#include "igsp/align.hpp"
#include "igsp/diagnosis.hpp"
#include "igsp/errors.hpp"
#include "igsp/io.hpp"
#include "igsp/similarity.hpp"
#include "report/json.hpp"
#include "report/page.hpp"
#include "shell/commands.hpp"
#include "shell/exit_codes.hpp"
#include "shell/help_text.hpp"
#include "shell/interrupt.hpp"
#include "shell/option_flags.hpp"
#include "shell/progress_bar.hpp"

namespace igsp::cli {
namespace {

namespace fs = std::filesystem;

struct AlignSettings {
  fs::path source, target;
  fs::path aligned, transformation, report, html;  // empty: not wanted
  fs::path initial;                                // empty: no guess
  ReadOptions read;
  std::string source_viewpoint = "auto", target_viewpoint = "auto", scale = "1";
  std::int64_t max_points = 20'000'000;
  bool force = false, quiet = false, verbose = false, no_diagnose = false;
  std::shared_ptr<OptionFlags> option_flags;
};

// `otherwise` is what to say when memory runs out.
template <typename Step>
auto with_memory(const std::string& otherwise, const Step& step) {
  try {
    return step();
  } catch (const std::bad_alloc&) {
    throw FileError(otherwise);
  }
}

// Of all threads.
double cpu_now_s() {
  timespec cpu{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &cpu);
  return static_cast<double>(cpu.tv_sec) + 1e-9 * static_cast<double>(cpu.tv_nsec);
}

double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// Everything that can be known to fail does so before the long run.
void check_outputs(const AlignSettings& settings) {
  const std::vector<std::pair<std::string_view, fs::path>> files = {{"SOURCE", settings.source},
                                                                    {"TARGET", settings.target},
                                                                    {"--initial", settings.initial},
                                                                    {"-o", settings.aligned},
                                                                    {"--transform", settings.transformation},
                                                                    {"--report", settings.report},
                                                                    {"--html", settings.html}};
  for (std::size_t i = 3; i < files.size(); ++i) {  // after the inputs
    const auto& [name, path] = files[i];
    if (path.empty()) continue;
    for (std::size_t j = 0; j < i; ++j) {
      if (files[j].second.empty() || !same_file(path, files[j].second)) continue;
      throw InvalidArgument(fmt::format("{} and {} are the same file, {}", name, files[j].first, path.string()));
    }
    check_writable(path);
  }
  if (!settings.aligned.empty()) check_moved_output(settings.source, settings.aligned);
}

void check_scaled_output(const AlignSettings& settings, const ScaleRequest& scale) {
  if (scale.automatic && !settings.initial.empty()) {
    throw InvalidArgument(
        "--scale auto and --initial exclude each other: a guess holds for one scale; give the factor");
  }
  if ((scale.automatic || scale.factor != 1) && moves_foreign(settings.source, settings.aligned)) {
    throw InvalidArgument(fmt::format("-o {}: not written in another scale; name it .ply, which holds the points",
                                      settings.aligned.string()));
  }
}

std::string contradicted(const CloudInput& cloud, std::string_view option, const std::string& text) {
  return fmt::format("{}: {}={} is not used: {}; {}={}! insists", cloud.path.string(), option, text,
                     cloud.viewpoint.warning, option, text);
}

// A cloud as it was asked for, and how far it reaches without its stray points.
struct SettledCloud {
  CloudInput input;
  double extent = 0;
};

SettledCloud settled_cloud(const fs::path& path, std::string_view stage, const ViewpointRequest& viewpoint,
                           const AlignSettings& settings, const ProgressCallback& progress) {
  SettledCloud cloud;
  cloud.input = read_cloud(path, static_cast<std::size_t>(settings.max_points), stage, progress, settings.read);
  settle_viewpoint(cloud.input, viewpoint);
  cloud.extent = TrimmedCloud(cloud.input.points, path.string()).bounds().diagonal();
  return cloud;
}

std::vector<std::string> warnings_about(const CloudInput& source, const CloudInput& target, double source_extent,
                                        double target_extent, const ScaleRequest& scale) {
  std::vector<std::string> warnings;
  for (const CloudInput* cloud : {&source, &target}) {
    for (std::string& line : left_out_of(*cloud)) warnings.push_back(std::move(line));
  }
  constexpr double suspicious = 100.0;
  source_extent *= scale.factor;
  const double power = std::log10(source_extent / target_extent);
  if (std::abs(power) >= std::log10(suspicious) && !scale.automatic) {
    warnings.push_back(
        fmt::format("clouds in different units? Extents differ by a factor of about {:g}: source {:.4g}, target {:.4g}",
                    std::pow(10.0, std::round(std::abs(power))), source_extent, target_extent));
  }
  return warnings;
}

// A cloud that was too large to keep whole is replaced by the centroids of a voxel filter four times finer than the
// method's own, read from the file in chunks. The thinned clouds only tell how fine; the method chooses its voxel size
// from the centroids.
void stream_large_clouds(CloudInput& source, CloudInput& target, const ScaleOptions& options, int threads,
                         const ProgressCallback& progress) {
  if (source.whole() && target.whole()) return;
  const double fine = choose_voxel_size(source.points, target.points, options) / 4.0;
  const auto filtered = [&](CloudInput& cloud, std::string_view stage) {
    return [&cloud, stage, fine](const ProgressCallback& report) {
      if (!cloud.whole()) take_centroids(cloud, fine, stage, report);
    };
  };
  concurrently(threads, progress, filtered(source, "filter source"), filtered(target, "filter target"));
}

// The reports say what happened in any case; the other files exist only for an answer to rely on, unless forced.
void write_outputs(const AlignSettings& settings, const Result& result, const Json& report, const CloudInput& source,
                   const CloudInput& target, ProgressBar& bar) {
  if (!settings.report.empty()) write_text(settings.report, report_text(report));
  if (!settings.html.empty()) {
    with_memory(fmt::format("{}: not enough memory for the page", settings.html.string()),
                [&] { write_text(settings.html, report_page(report, source.scan(), target.scan())); });
  }
  const bool wanted = !settings.aligned.empty() || !settings.transformation.empty();
  if (!wanted) return;
  if (!result.has_estimate || !(result.registered || settings.force)) {
    std::cout << "not written, since the pair is not registered:";
    for (const fs::path& path : {settings.aligned, settings.transformation}) {
      if (!path.empty()) std::cout << ' ' << path.string();
    }
    std::cout << (result.has_estimate ? " (--force writes the estimate)\n" : "\n");
    return;
  }
  stop_if_interrupted();
  if (!settings.transformation.empty()) {
    write_transformation(settings.transformation, result.target_from_source, source.scale);
  }
  stop_if_interrupted();
  if (settings.aligned.empty()) return;
  // Floats are written only where their rounding is far below what the scan resolves.
  const double tolerance = 1e-4 * result.voxel_size;
  const std::vector<std::string> notes = write_moved_output(
      source, settings.aligned, with_scale(result.target_from_source, source.scale), tolerance, bar.callback());
  bar.finish();
  for (const std::string& note : notes) std::cout << note << "\n";
}

// The answer and, where it was asked for, the factor that the source is multiplied by from then on.
Result registered_pair(CloudInput& source, const CloudInput& target, const std::optional<Transformation>& initial,
                       const ScaleRequest& scale, const Options& options, const ProgressCallback& progress) {
  if (initial) return align(source.scan(), target.scan(), *initial, options, progress);
  if (!scale.automatic) return align(source.scan(), target.scan(), options, progress);
  SimilarityResult similarity = align_similarity(source.scan(), target.scan(), options, progress);
  scale_cloud(source, similarity.factor);
  return std::move(similarity.result);
}

std::vector<Diagnosis> causes_of(Result& refused, const CloudInput& source, const CloudInput& target, bool search,
                                 const ProgressCallback& progress) {
  const double start = now_s();
  std::vector<Diagnosis> causes = diagnose(source.scan(), target.scan(), refused, {.search = search}, progress);
  refused.timings_s.emplace_back("diagnosis", now_s() - start);
  return causes;
}

int run_align(const AlignSettings& settings) {
  const double start = now_s();
  const Options options = resolve(*settings.option_flags);
  if (settings.max_points < 1000) {
    throw InvalidArgument(fmt::format("--max-points is {}; it must be at least 1000", settings.max_points));
  }
  check_outputs(settings);
  const ScaleRequest scale = parse_scale(settings.scale);
  check_scaled_output(settings, scale);
  std::optional<Transformation> initial;
  const ViewpointRequest source_viewpoint = parse_viewpoint("--source-viewpoint", settings.source_viewpoint),
                         target_viewpoint = parse_viewpoint("--target-viewpoint", settings.target_viewpoint);
  if (!settings.initial.empty()) initial = read_transformation(settings.initial);
  ProgressBar bar(!settings.quiet);
  const ProgressCallback progress = bar.callback();
  SettledCloud settled_source, settled_target;
  concurrently(
      options.threads, progress,
      [&](const ProgressCallback& report) {
        settled_source = settled_cloud(settings.source, "read source", source_viewpoint, settings, report);
      },
      [&](const ProgressCallback& report) {
        settled_target = settled_cloud(settings.target, "read target", target_viewpoint, settings, report);
      });
  CloudInput &source = settled_source.input, &target = settled_target.input;
  std::vector<std::string> warnings = unusual_values(options);
  std::ranges::move(warnings_about(source, target, settled_source.extent, settled_target.extent, scale),
                    std::back_inserter(warnings));
  if (!source.viewpoint.warning.empty()) {
    warnings.push_back(contradicted(source, "--source-viewpoint", settings.source_viewpoint));
  }
  if (!target.viewpoint.warning.empty()) {
    warnings.push_back(contradicted(target, "--target-viewpoint", settings.target_viewpoint));
  }
  if (scale.factor != 1) scale_cloud(source, scale.factor);
  stream_large_clouds(source, target, options.scale, options.threads, progress);
  const double after_reading = now_s(), cpu_before = cpu_now_s();
  Result result = registered_pair(source, target, initial, scale, options, progress);
  const double cpu_seconds = cpu_now_s() - cpu_before;
  std::vector<Diagnosis> diagnosis;
  if (!result.registered && !settings.no_diagnose) {
    diagnosis = causes_of(result, source, target, !initial && !scale.automatic, progress);
  }
  stop_if_interrupted();
  bar.finish();
  result.source.points = source.total;
  result.target.points = target.total;
  result.timings_s.insert(result.timings_s.begin(), {"read", after_reading - start});
  for (const std::string& warning : warnings) {
    if (!settings.quiet) std::cerr << "igsp: warning: " << warning << "\n";
  }
  std::cout << answer_text(result, source.scale, diagnosis, options.scale.voxel_size > 0.0, now_s() - start);
  if (settings.verbose) std::cout << details_text(result);
  std::cout.flush();  // before the bar of what is written
  write_outputs(settings, result, align_report(result, diagnosis, source, target, cpu_seconds, warnings), source,
                target, bar);
  return result.registered ? exit_registered : exit_not_registered;
}

constexpr const char* examples =
    "Examples:\n"
    "  igsp align source.ply target.ply\n"
    "  igsp align a.pcd b.xyz --preset paper --voxel-size 0.1 -o aligned.ply --transform T.txt --report run.json\n"
    "  igsp align a.ply b.ply --config igsp.toml --threads 4\n"
    "The options start from --preset or --config; flags override them. Exit codes: 0 registered, 1 not registered,\n"
    "2 usage or option, 3 input or output, 128 + signal. PLY, PCD, LAS and text (XYZ, CSV, PTS) are read, written;\n"
    "the command of the Python package also takes LAZ, E57 and PTX, and writes them moved, their attributes kept.";

void add_viewpoint_flag(CLI::App& align, const std::string& cloud, std::string& text) {
  align
      .add_option(
          "--" + cloud + "-viewpoint", text,
          wrapped("where the scanner of the " + cloud +
                  " stood, in the file's frame; a far point stands for one that looked along one direction. "
                  "none: unknown, or a fused cloud; auto: what the file says, else its origin if the cloud shows "
                  "it; x,y,z! is used even where the cloud contradicts it; default auto"))
      ->type_name("X,Y,Z|none|auto");
}

}  // namespace

void add_align_command(CLI::App& app, Command& command) {
  CLI::App* align =
      app.add_subcommand("align", "find target_from_source, the rigid motion that puts SOURCE onto TARGET");
  const auto settings = std::make_shared<AlignSettings>();
  align->add_option("SOURCE", settings->source, "cloud that moves")->required()->type_name("");
  align->add_option("TARGET", settings->target, "cloud that stays")->required()->type_name("");
  align
      ->add_option("-o,--output", settings->aligned,
                   "write SOURCE moved into TARGET's frame, with all its properties if FILE has SOURCE's format")
      ->type_name("FILE");
  align->add_option("--transform", settings->transformation, "write target_from_source, 4x4 text")->type_name("FILE");
  align->add_option("--report", settings->report, "write the whole answer as JSON, whatever the verdict")
      ->type_name("FILE");
  align->add_option("--html", settings->html, "write a page to look at: clouds, iterations, evidence (igsp report)")
      ->type_name("FILE");
  align->add_option("--initial", settings->initial, "start from this target_from_source, 4x4 text, instead of a search")
      ->type_name("FILE");
  add_read_flags(*align, settings->read);
  add_viewpoint_flag(*align, "source", settings->source_viewpoint);
  add_viewpoint_flag(*align, "target", settings->target_viewpoint);
  align
      ->add_option("--scale", settings->scale,
                   wrapped("multiply SOURCE by this factor first, or auto: find it, whatever it is, and register with "
                           "seven degrees of freedom; default 1"))
      ->type_name("FACTOR|auto");
  align->add_flag("--force", settings->force, "write -o and --transform also for an estimate that is not registered");
  align->add_flag(
      "--no-diagnose", settings->no_diagnose,
      wrapped("do not look for the cause of a refusal (mirrored or flat clouds, another scale, degrees, coarse "
              "coordinates), which may take as long again"));
  align
      ->add_option("--max-points", settings->max_points,
                   wrapped("a cloud with more points is streamed through the voxel filter instead of kept whole; "
                           "default 20000000"))
      ->type_name("INTEGER");
  CLI::Option* quiet = align->add_flag("--quiet", settings->quiet, "no progress and no warnings, only the answer");
  align->add_flag("--verbose", settings->verbose, "also a line per iteration and per stage")->excludes(quiet);
  settings->option_flags = add_option_flags(*align);
  align->footer(examples);
  align->callback([settings, &command] {
    command = [settings] {
      return with_memory("not enough memory for these clouds; a smaller --max-points streams them",
                         [&] { return run_align(*settings); });
    };
  });
}

}  // namespace igsp::cli
