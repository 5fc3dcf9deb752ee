#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <iostream>
#include <map>
#include <mutex>
#include <thread>
#include <tuple>

#include "benchmark/export.hpp"
#include "benchmark/results_file.hpp"
#include "benchmark/run.hpp"
#include "benchmark/summary.hpp"
#include "config/preset.hpp"
#include "files/output_file.hpp"
#include "igsp/errors.hpp"
#include "igsp/options.hpp"
#include "shell/commands.hpp"
#include "shell/exit_codes.hpp"
#include "shell/help_text.hpp"
#include "shell/interrupt.hpp"
#include "shell/progress_bar.hpp"

namespace igsp::cli {
namespace {

namespace fs = std::filesystem;

struct BenchmarkSettings {
  fs::path cases;
  fs::path out = "results.csv";
  fs::path compare, exported;  // empty: not wanted
  std::vector<std::string> presets = {"default"};
  std::vector<std::string> only;
  std::uint64_t scramble_seed = 7;
  bool no_scramble = false, resume = false, quiet = false;
  int jobs = 1;
};

// What a row answers. The same file with another scramble is another question.
using Key = std::tuple<std::string, std::string, std::string>;
Key key_of(const BenchmarkRow& row) {
  return {row.name, row.preset, row.scramble};
}
Key key_of(const BenchmarkTask& task) {
  return {task.one.name, task.preset, scramble_text(task.scramble_seed)};
}

void check(const BenchmarkSettings& settings) {
  if (settings.jobs < 1 || settings.jobs > 1024) {
    throw InvalidArgument(fmt::format("--jobs is {}; it must be in [1, 1024]", settings.jobs));
  }
  for (std::size_t i = 0; i < settings.presets.size(); ++i) {
    preset(settings.presets[i]);
    if (std::count(settings.presets.begin(), settings.presets.end(), settings.presets[i]) > 1) {
      throw InvalidArgument(fmt::format("--preset {} is given twice", settings.presets[i]));
    }
  }
  for (const auto& [name, path] : {std::pair{"CASES", settings.cases}, {"--compare", settings.compare}}) {
    if (path.empty() || !same_file(path, settings.out)) continue;
    throw InvalidArgument(fmt::format("--out and {} are the same file, {}", name, path.string()));
  }
}

std::optional<std::uint64_t> seed_of(const BenchmarkSettings& settings) {
  if (settings.no_scramble) return std::nullopt;
  return settings.scramble_seed;
}

std::vector<BenchmarkTask> tasks_of(const BenchmarkSettings& settings) {
  const std::optional<std::uint64_t> seed = seed_of(settings);
  std::vector<BenchmarkTask> tasks;
  for (const BenchmarkCase& one : select_cases(read_cases(settings.cases), settings.only)) {
    for (const std::string& name : settings.presets) tasks.push_back({one, name, seed});
  }
  return tasks;
}

// The rows of an earlier run that stand. What is there but is no results file is never replaced.
std::map<Key, BenchmarkRow> earlier_rows(const BenchmarkSettings& settings) {
  std::error_code ignored;
  if (!fs::exists(settings.out, ignored)) return {};
  std::map<Key, BenchmarkRow> kept;
  for (BenchmarkRow& row : read_results(settings.out, LastLine::ended)) {
    if (settings.resume && row.error.empty()) kept.insert_or_assign(key_of(row), std::move(row));
  }
  return kept;
}

std::vector<BenchmarkRow> values_of(const std::map<Key, BenchmarkRow>& rows) {
  std::vector<BenchmarkRow> values;
  for (const auto& [key, row] : rows) values.push_back(row);
  return values;
}

std::string live_line(const BenchmarkRow& row) {
  const std::string judged = !row.error.empty()    ? "no answer"
                             : row.false_accept()  ? "FALSE ACCEPT"
                             : !row.success        ? row.verdict
                             : row.truth == "none" ? "rightly refused"
                             : !row.registered()   ? (*row.success ? "right but refused" : "refused")
                                                   : "right";
  const std::string errors =
      row.e_r_deg ? fmt::format("{:9.3g} deg {:9.3g}", *row.e_r_deg, *row.centroid_displacement) : "";
  return fmt::format("{:<44.44} {:<8} {:<17} {:<23} {:6.2f} s", row.name, row.preset, judged, errors,
                     row.cpu_seconds.value_or(0.0));
}

// Runs what is left on several threads, each case on one; rows go to the file and the terminal as they are finished.
class Workers {
 public:
  Workers(const std::vector<BenchmarkTask>& todo, std::size_t done_before, ResultsFile& file, ProgressBar& bar)
      : todo_(todo), done_(done_before), all_(done_before + todo.size()), file_(file), bar_(bar) {}

  /// Throws what a thread met: Cancelled, or FileError if the results cannot be written.
  std::vector<BenchmarkRow> run(int jobs) {
    show();
    {
      std::vector<std::jthread> team;
      for (int i = 0; i < jobs; ++i) team.emplace_back([this, jobs] { work(jobs); });
    }
    if (failure_) std::rethrow_exception(failure_);
    return std::move(rows_);
  }

 private:
  void work(int jobs) {
    try {
      for (std::size_t i = next_++; i < todo_.size(); i = next_++) {
        if (jobs == 1) reset_peak_memory();
        BenchmarkRow row = run_task(todo_[i]);
        const std::lock_guard lock(mutex_);
        file_.add(row);
        ++done_;
        bar_.print_above(fmt::format("{:>4}/{:<4} {}", done_, all_, live_line(row)));
        show();
        rows_.push_back(std::move(row));
      }
    } catch (...) {
      const std::lock_guard lock(mutex_);
      next_ = todo_.size();
      if (!failure_) failure_ = std::current_exception();
    }
  }
  void show() { bar_.update({"benchmark", static_cast<double>(done_) / static_cast<double>(all_)}); }

  const std::vector<BenchmarkTask>& todo_;
  std::size_t done_, all_;
  ResultsFile& file_;
  ProgressBar& bar_;
  std::atomic<std::size_t> next_ = 0;
  std::mutex mutex_;
  std::vector<BenchmarkRow> rows_;
  std::exception_ptr failure_;
};

void run_left(const BenchmarkSettings& settings, const std::vector<BenchmarkTask>& tasks,
              std::map<Key, BenchmarkRow>& rows) {
  std::vector<BenchmarkTask> todo;
  std::copy_if(tasks.begin(), tasks.end(), std::back_inserter(todo),
               [&](const BenchmarkTask& task) { return !rows.contains(key_of(task)); });
  ResultsFile file(settings.out, values_of(rows));
  ProgressBar bar(!settings.quiet);
  try {
    for (BenchmarkRow& row : Workers(todo, tasks.size() - todo.size(), file, bar).run(settings.jobs)) {
      rows.insert_or_assign(key_of(row), std::move(row));
    }
  } catch (const Cancelled&) {
    bar.clear();
    std::cerr << fmt::format("igsp: finished rows are in {}; the same command with --resume does the rest\n",
                             settings.out.string());
    throw;
  }
  bar.clear();
}

// In the order of the cases, then what the file holds of others.
std::vector<BenchmarkRow> in_order(const std::vector<BenchmarkTask>& tasks, std::map<Key, BenchmarkRow> rows,
                                   std::vector<BenchmarkRow>& others) {
  std::vector<BenchmarkRow> ordered;
  for (const BenchmarkTask& task : tasks) ordered.push_back(std::move(rows.extract(key_of(task)).mapped()));
  others = values_of(rows);
  return ordered;
}

int run_export(const BenchmarkSettings& settings) {
  const std::vector<BenchmarkCase> cases = select_cases(read_cases(settings.cases), settings.only);
  const fs::path list = settings.exported / "cases.csv";
  if (fs::exists(list)) {
    throw InvalidArgument(fmt::format("--export {0}: {0}/cases.csv is there already", settings.exported.string()));
  }
  const std::size_t written = export_cases(cases, seed_of(settings), settings.exported);
  std::cout << fmt::format("{} of {} cases are in {}\n", written, cases.size(), list.string());
  return written == cases.size() ? exit_registered : exit_input_output;
}

int run_benchmark(const BenchmarkSettings& settings) {
  if (!settings.exported.empty()) return run_export(settings);
  check(settings);
  const std::vector<BenchmarkTask> tasks = tasks_of(settings);
  std::vector<BenchmarkRow> old_rows;
  if (!settings.compare.empty()) old_rows = read_results(settings.compare);
  std::map<Key, BenchmarkRow> rows = earlier_rows(settings);
  run_left(settings, tasks, rows);
  std::vector<BenchmarkRow> others;
  const std::vector<BenchmarkRow> answers = in_order(tasks, std::move(rows), others);
  std::vector<BenchmarkRow> all = answers;
  all.insert(all.end(), others.begin(), others.end());
  write_results(settings.out, all);
  std::cout << summary_text(answers);
  if (!settings.compare.empty()) std::cout << "\n" << comparison_text(old_rows, answers);
  const bool failed = std::any_of(answers.begin(), answers.end(), [](const auto& row) { return !row.error.empty(); });
  return failed ? exit_input_output : exit_registered;
}

constexpr const char* notes =
    "CASES is a CSV file with a line per pair, paths relative to it:\n"
    "  name,group,source,target,truth,max_rotation_error_deg,max_translation_error_m\n"
    "  park/1--0,park,scans/station_1.ply,scans/station_0.ply,scans/station_1_to_0.txt,2,0.3\n"
    "  park/odd,park,scans/station_1.ply,kitchen.ply,none,0,0\n"
    "truth is a 4x4 text, target_from_source; `none` if the pair does not overlap, so that \"not registered\" is\n"
    "the only right answer; `-` if nobody knows. A transformation is right if its rotation and the place it gives\n"
    "the source's centroid are nearer to the truth than the two thresholds. Columns that may be left out are group\n"
    "and source_viewpoint, target_viewpoint: x y z in the file's frame, where the scanner stood; empty if unknown.\n"
    "Others are not looked at.\n"
    "Every source is moved by a random rigid motion first, since files often lie as they belong; errors are given\n"
    "as if it had not been. precision and recall are those of the last iteration's correspondences, nearer than a\n"
    "third of the suppression radius at the true transformation (Eq. 14). Each case runs on one thread with all\n"
    "points in memory. peak_memory_bytes is of the whole process, with --jobs 1 since the case began.\n"
    "results.csv has a row per case and preset, written as it is finished; an earlier results.csv is replaced, or\n"
    "with --resume continued: answered rows stay, rows with an error are run again.\n"
    "Examples:\n"
    "  igsp benchmark cases.csv\n"
    "  igsp benchmark cases.csv --preset default --preset paper --jobs 4 --only park --out new.csv --compare old.csv\n"
    "Exit codes: 0 it ran, whatever the answers; 2 usage; 3 a file that cannot be read or written, also of a single\n"
    "case (the others are run); 128 + signal.";

}  // namespace

void add_benchmark_command(CLI::App& app, Command& command) {
  CLI::App* benchmark = app.add_subcommand("benchmark", "align many pairs of known truth and count what is right");
  const auto settings = std::make_shared<BenchmarkSettings>();
  benchmark->add_option("CASES", settings->cases, "list of pairs, CSV")->required()->type_name("");
  CLI::Option* seed = benchmark
                          ->add_option("--scramble", settings->scramble_seed,
                                       wrapped("seed of the random rigid motions of the sources; default 7"))
                          ->type_name("INTEGER");
  benchmark->add_flag("--no-scramble", settings->no_scramble, "leave the sources where they are")->excludes(seed);
  CLI::Option* exported =
      benchmark
          ->add_option("--export", settings->exported,
                       wrapped("align nothing: write the moved sources, targets, truths and their list, cases.csv, for "
                               "another program"))
          ->type_name("DIR");
  benchmark
      ->add_option("--preset", settings->presets,
                   wrapped(fmt::format("options to run with: {}; may be given several times; default default",
                                       fmt::join(preset_names(), " or "))))
      ->type_name(fmt::format("{}", fmt::join(preset_names(), "|")))
      ->allow_extra_args(false);
  benchmark->add_option("--jobs", settings->jobs, "cases run at the same time; default 1")->type_name("INTEGER");
  benchmark
      ->add_option("--only", settings->only,
                   wrapped("a group, or a pattern of names such as 'park/*'; may be given several times"))
      ->type_name("GROUP|GLOB")
      ->allow_extra_args(false);
  benchmark->add_option("--out", settings->out, "rows, CSV; default results.csv")
      ->type_name("FILE")
      ->excludes(exported);
  benchmark->add_option("--compare", settings->compare, "results of an earlier run: say what got better and worse")
      ->type_name("FILE")
      ->excludes(exported);
  benchmark->add_flag("--resume", settings->resume, "keep the answered rows of --out, run the others")
      ->excludes(exported);
  benchmark->add_flag("--quiet", settings->quiet, "no progress, only the summary");
  benchmark->footer(notes);
  benchmark->callback([settings, &command] { command = [settings] { return run_benchmark(*settings); }; });
}

}  // namespace igsp::cli
