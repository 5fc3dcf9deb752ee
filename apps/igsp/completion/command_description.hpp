#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace igsp::cli {

/// A flag or a positional argument as the command line knows it.
struct ArgumentDescription {
  std::vector<std::string> names;    ///< "-o", "--output"; of a positional one its name, "SOURCE"
  std::string value;                 ///< "FILE", or the choices as in "default|paper"; empty: takes no value
  std::vector<std::string> choices;  ///< of the value; empty: not a choice
  std::string help;                  ///< one line
  std::string group;                 ///< "Method, scale"
  bool required = false;
  bool repeats = false;
};

/// A subcommand, or the program itself.
struct CommandDescription {
  std::string name, help, footer;
  std::vector<ArgumentDescription> positionals, flags;
  std::vector<CommandDescription> subcommands;
};

/// All that --help knows, as values: what completion and manual page are generated from.
CommandDescription describe(const CLI::App& app);

}  // namespace igsp::cli
