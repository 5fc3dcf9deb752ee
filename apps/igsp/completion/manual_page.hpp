#pragma once

#include <string>

#include "completion/command_description.hpp"

namespace igsp::cli {

/// The manual page igsp(1) in roff's man macros: every subcommand with every flag. Groups named "Method..." are alike
/// in all subcommands that have them and come once.
std::string manual_page(const CommandDescription& program);

}  // namespace igsp::cli
