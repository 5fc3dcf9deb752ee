#include <fmt/format.h>

#include <iostream>

#include "completion/command_description.hpp"
#include "completion/manual_page.hpp"
#include "shell/commands.hpp"
#include "shell/exit_codes.hpp"

namespace igsp::cli {
namespace {

constexpr const char* examples =
    "Example:\n"
    "  igsp manual | man -l -";

}  // namespace

void add_manual_command(CLI::App& app, Command& command) {
  CLI::App* manual = app.add_subcommand("manual", "print the manual page, for man");
  manual->footer(examples);
  manual->callback([&app, &command] {
    command = [&app] {
      std::cout << manual_page(describe(app));
      return exit_registered;
    };
  });
}

}  // namespace igsp::cli
