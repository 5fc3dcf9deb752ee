#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "igsp/options.hpp"

namespace igsp::cli {

/// What the command line says about Options: where they start from, and one text per entry of the option list.
struct OptionFlags {
  std::optional<std::string> preset;
  std::optional<std::string> config;
  std::vector<std::optional<std::string>> texts;
};

/// Adds --preset, --config and a flag for every option, grouped by section.
std::shared_ptr<OptionFlags> add_option_flags(CLI::App& command);

/// The preset or the file, with the given flags on top. Throws InvalidArgument, FileError.
Options resolve(const OptionFlags& flags);

}  // namespace igsp::cli
