#pragma once

#include <string>

#include "completion/command_description.hpp"

namespace igsp::cli {

// Completion scripts for the command and its subcommands, each complete in itself.
std::string bash_completion(const CommandDescription& program);
std::string zsh_completion(const CommandDescription& program);
std::string fish_completion(const CommandDescription& program);

}  // namespace igsp::cli
