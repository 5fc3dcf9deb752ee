#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace igsp::cli {

/// What the command line asks for: runs after all of it was understood, returns the exit code.
using Command = std::function<int()>;

// Each adds its subcommand to the command line; the subcommand stores what to run in `command`.
void add_align_command(CLI::App& app, Command& command);
void add_network_command(CLI::App& app, Command& command);
void add_report_command(CLI::App& app, Command& command);
void add_evaluate_command(CLI::App& app, Command& command);
void add_benchmark_command(CLI::App& app, Command& command);
void add_simulate_command(CLI::App& app, Command& command);
void add_info_command(CLI::App& app, Command& command);
void add_convert_command(CLI::App& app, Command& command);
void add_transform_command(CLI::App& app, Command& command);
void add_downsample_command(CLI::App& app, Command& command);
void add_options_command(CLI::App& app, Command& command);
void add_completion_command(CLI::App& app, Command& command);
void add_manual_command(CLI::App& app, Command& command);

}  // namespace igsp::cli
