#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "igsp/options.hpp"

namespace igsp {

/// All options as TOML, each with its unit, range and help in a comment. Reads back as the same options.
std::string options_to_toml(const Options& options);

/// Options from TOML text. A key that is left out keeps its value in the preset that the key `preset` names, or in the
/// default preset. `name` stands for the text in errors. Throws InvalidArgument (unknown key, value out of range) and
/// FileError (not TOML), both with name, line and column.
Options options_from_toml(std::string_view text, std::string_view name);

/// The same from a file. Throws FileError also if it cannot be read.
Options read_options(const std::filesystem::path& path);

}  // namespace igsp
