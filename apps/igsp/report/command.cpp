#include <fmt/format.h>

#include "files/cloud_input.hpp"
#include "files/output_file.hpp"
#include "igsp/errors.hpp"
#include "report/page.hpp"
#include "report/run.hpp"
#include "shell/commands.hpp"
#include "shell/exit_codes.hpp"
#include "shell/interrupt.hpp"
#include "shell/progress_bar.hpp"

namespace igsp::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kept_points = 20'000'000;

struct ReportSettings {
  fs::path run, page;
  fs::path source, target;  // empty: those that the run names
};

// A run names its clouds as they were given to igsp align: from the folder that it ran in, or, when both were moved
// together, from the report's own.
fs::path find_cloud(const ReportSettings& settings, const Json& run, const std::string& name, const fs::path& given) {
  if (!given.empty()) return given;
  const fs::path path = run[name]["path"].get<std::string>();
  const fs::path beside = settings.run.parent_path() / path;
  for (const fs::path& candidate : {path, beside}) {
    if (fs::exists(candidate)) return candidate;
  }
  throw FileError(fmt::format("{}: the {} of {} is not there{}; say where it is with --{}", path.string(), name,
                              settings.run.string(), beside == path ? "" : ", nor at " + beside.string(), name));
}

void check_output(const ReportSettings& settings, std::string_view name, const fs::path& input) {
  if (!same_file(settings.page, input)) return;
  throw InvalidArgument(fmt::format("-o and {} are the same file, {}", name, settings.page.string()));
}

CloudInput read_cloud_of(const ReportSettings& settings, const Json& run, const std::string& name,
                         const fs::path& given, const ProgressCallback& progress) {
  const fs::path path = find_cloud(settings, run, name, given);
  check_output(settings, name, path);
  CloudInput cloud = read_cloud(path, kept_points, "read " + name, progress);
  const auto expected = run[name]["points"].get<std::size_t>();
  if (cloud.total != expected) {
    throw FileError(fmt::format("{}: holds {} points, the {} of {} had {}", cloud.path.string(), cloud.total, name,
                                settings.run.string(), expected));
  }
  return cloud;
}

std::optional<Eigen::Vector3d> place_of(const Json& json) {
  if (json.is_null()) return std::nullopt;
  return Eigen::Vector3d(json[0].get<double>(), json[1].get<double>(), json[2].get<double>());
}

// As the run had it.
void settle_as_in(const Json& run, const std::string& name, CloudInput& cloud) {
  cloud.viewpoint.viewpoint = place_of(run[name]["viewpoint"]);
  const Json& parts = run[name]["parts"];
  if (parts.size() != cloud.parts.size()) return;  // taken for one scan
  for (std::size_t i = 0; i < parts.size(); ++i) {
    cloud.viewpoint.parts.push_back({cloud.parts[i].points, place_of(parts[i]["viewpoint"])});
  }
}

int run_report(const ReportSettings& settings) {
  check_output(settings, "RUN", settings.run);
  check_writable(settings.page);
  const Json run = read_run(settings.run);
  ProgressBar bar(true);
  CloudInput source = read_cloud_of(settings, run, "source", settings.source, bar.callback());
  scale_cloud(source, run["scale"]);
  CloudInput target = read_cloud_of(settings, run, "target", settings.target, bar.callback());
  bar.finish();
  settle_as_in(run, "source", source);
  settle_as_in(run, "target", target);
  write_text(settings.page, report_page(run, source.scan(), target.scan()));
  return exit_registered;
}

constexpr const char* examples =
    "Example:\n"
    "  igsp align source.ply target.ply --report run.json\n"
    "  igsp report run.json -o report.html\n"
    "The page is one file that needs no network: both clouds before and after in 3-D, every iteration, plots, and the\n"
    "evidence for the verdict. `igsp align --html report.html` writes the same page at once.";

}  // namespace

void add_report_command(CLI::App& app, Command& command) {
  CLI::App* report = app.add_subcommand("report", "a page to look at, from what `igsp align --report` wrote");
  const auto settings = std::make_shared<ReportSettings>();
  report->add_option("RUN", settings->run, "JSON of igsp align --report")->required()->type_name("");
  report->add_option("-o,--output", settings->page, "write this HTML file")->required()->type_name("FILE");
  report->add_option("--source", settings->source, "where the source is, if not where the run had it")
      ->type_name("FILE");
  report->add_option("--target", settings->target, "where the target is, if not where the run had it")
      ->type_name("FILE");
  report->footer(examples);
  report->callback([settings, &command] { command = [settings] { return run_report(*settings); }; });
}

}  // namespace igsp::cli
