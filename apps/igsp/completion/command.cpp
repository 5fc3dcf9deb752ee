#include <fmt/format.h>

#include <iostream>

#include "completion/command_description.hpp"
#include "completion/completion.hpp"
#include "igsp/errors.hpp"
#include "shell/commands.hpp"
#include "shell/exit_codes.hpp"

namespace igsp::cli {
namespace {

std::string completion_for(const std::string& shell, const CommandDescription& program) {
  if (shell == "bash") return bash_completion(program);
  if (shell == "zsh") return zsh_completion(program);
  if (shell == "fish") return fish_completion(program);
  throw InvalidArgument(fmt::format("SHELL is \"{}\"; it must be one of bash, zsh, fish", shell));
}

constexpr const char* examples =
    "Examples:\n"
    "  source <(igsp completion bash)            this shell only; an installed igsp needs nothing\n"
    "  igsp completion fish > ~/.config/fish/completions/igsp.fish";

}  // namespace

void add_completion_command(CLI::App& app, Command& command) {
  CLI::App* completion = app.add_subcommand("completion", "print what completes this command line in a shell");
  const auto shell = std::make_shared<std::string>();
  completion->add_option("SHELL", *shell, "bash, zsh or fish")->required()->type_name("bash|zsh|fish");
  completion->footer(examples);
  completion->callback([shell, &app, &command] {
    command = [shell, &app] {
      std::cout << completion_for(*shell, describe(app));
      return exit_registered;
    };
  });
}

}  // namespace igsp::cli
