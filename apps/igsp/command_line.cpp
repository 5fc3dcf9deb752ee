#include "command_line.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <iostream>
#include <new>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "config/nearest.hpp"
#include "igsp/errors.hpp"
#include "igsp/version.hpp"
#include "shell/commands.hpp"
#include "shell/exit_codes.hpp"
#include "shell/help_text.hpp"
#include "shell/interrupt.hpp"
#include "shell/standard_streams.hpp"

namespace igsp::cli {
namespace {

constexpr const char* footer =
    "Exit codes: 0 registered (or done), 1 not registered, 2 usage or option, 3 input or output.\n"
    "Help on a command and its options: igsp align --help";

std::string nearest_of(std::string_view word, const std::vector<std::string>& candidates) {
  const std::vector<std::string_view> views(candidates.begin(), candidates.end());
  return std::string(nearest(word, views));
}

std::vector<std::string> flags_of(const CLI::App& app) {
  std::vector<std::string> flags;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) flags.push_back("--" + name);
    for (const std::string& name : option->get_snames()) flags.push_back("-" + name);
  }
  return flags;
}

bool looks_like_flag(const std::string& argument) {
  return argument.size() > 1 && argument[0] == '-' && !std::isdigit(static_cast<unsigned char>(argument[1])) &&
         argument[1] != '.';
}

// CLI11 would complain about what follows an unknown flag (its value taken for a file) before the flag itself.
void reject_unknown_flags(const CLI::App& command, const std::vector<std::string>& arguments) {
  const std::vector<std::string> known = flags_of(command);
  for (const std::string& argument : arguments) {
    if (argument == "--") return;
    if (!looks_like_flag(argument)) continue;
    const bool is_long = argument.starts_with("--");
    const std::string flag = is_long ? argument.substr(0, argument.find('=')) : argument.substr(0, 2);
    if (std::find(known.begin(), known.end(), flag) != known.end()) continue;
    throw InvalidArgument(fmt::format("unknown flag {}; did you mean {}? ({} --help lists all)",
                                      is_long ? flag : argument, nearest_of(flag, known),
                                      command.get_parent() ? "igsp " + command.get_name() : command.get_name()));
  }
}

void reject_unknown_words(const CLI::App& app, const std::vector<std::string>& arguments) {
  if (arguments.empty()) return;
  const std::string& first = arguments.front();
  if (looks_like_flag(first)) return reject_unknown_flags(app, {first});
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) {
    if (command->get_name() == first) return reject_unknown_flags(*command, {arguments.begin() + 1, arguments.end()});
    names.push_back(command->get_name());
  }
  throw InvalidArgument(fmt::format("unknown command \"{}\"; did you mean {}?", first, nearest_of(first, names)));
}

int report_error(std::string_view message, int exit_code) {
  std::cerr << "igsp: " << message << std::endl;
  return exit_code;
}

// The standard library has an error code for it, oneTBB only a text.
bool is_lack_of_threads(const std::exception& error) {
  const auto* system = dynamic_cast<const std::system_error*>(&error);
  return (system && system->code() == std::errc::resource_unavailable_try_again) ||
         std::string_view(error.what()).starts_with("pthread_create");
}

int run_guarded(const Command& command) {
  try {
    const int exit_code = command();
    check_standard_output();
    stop_if_interrupted();  // however late it came
    return exit_code;
  } catch (const Cancelled&) {
    return report_error("interrupted", interrupt_exit_code());
  } catch (const InvalidArgument& error) {
    return report_error(error.what(), exit_usage);
  } catch (const FileError& error) {
    if (interrupted()) return report_error("interrupted", interrupt_exit_code());
    return report_error(error.what(), exit_input_output);
  } catch (const std::bad_alloc&) {
    return report_error("not enough memory", exit_input_output);
  } catch (const std::filesystem::filesystem_error& error) {
    return report_error(fmt::format("{}: {}", error.path1().string(), error.code().message()), exit_input_output);
  } catch (const std::exception& error) {
    if (is_lack_of_threads(error)) {
      return report_error("no further thread can be started here; --threads 1 (and --jobs 1) needs none",
                          exit_input_output);
    }
    return report_error(fmt::format("internal error: {}", error.what()), exit_internal);
  }
}

int parse(CLI::App& app, int argc, char** argv) {
  try {
    reject_unknown_words(app, {argv + 1, argv + argc});
    app.parse(argc, argv);
  } catch (const InvalidArgument& error) {
    return report_error(error.what(), exit_usage);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return run_guarded([&] { return app.exit(error); });  // --help, --version
    return report_error(error.what(), exit_usage);
  }
  return 0;
}

}  // namespace

int run(int argc, char** argv, ForeignFormats formats, DaskEngine dask) {
  open_closed_streams();
  void (*const on_interrupt)() = formats.on_interrupt;
  use_foreign_formats(std::move(formats));
  use_dask_engine(std::move(dask));
  CLI::App app("igsp puts one point cloud onto another, without an initial guess", "igsp");
  app.set_version_flag("--version", fmt::format("igsp {}", version));
  app.footer(footer);
  app.get_formatter()->column_width(help_column);
  Command command;
  add_align_command(app, command);
  add_network_command(app, command);
  add_report_command(app, command);
  add_evaluate_command(app, command);
  add_benchmark_command(app, command);
  add_simulate_command(app, command);
  add_info_command(app, command);
  add_convert_command(app, command);
  add_transform_command(app, command);
  add_downsample_command(app, command);
  add_options_command(app, command);
  add_completion_command(app, command);
  add_manual_command(app, command);
  if (argc < 2) {
    std::cerr << app.help();
    return exit_usage;
  }
  const int parsed = parse(app, argc, argv);
  if (parsed != 0 || !command) return parsed;
  catch_interrupts(on_interrupt);
  return run_guarded(command);
}

}  // namespace igsp::cli
