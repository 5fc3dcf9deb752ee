#include <fmt/format.h>

#include "commands.hpp"
#include "config/toml_file.hpp"
#include "exit_codes.hpp"
#include "igsp/version.hpp"
#include "option_flags.hpp"

namespace igsp::cli {
namespace {

int run_options(const OptionFlags& flags) {
  fmt::print("# Options of igsp {}\n{}", version, options_to_toml(resolve(flags)));
  return exit_registered;
}

constexpr const char* examples =
    "Examples:\n"
    "  igsp options > igsp.toml                  then: igsp align a.ply b.ply --config igsp.toml\n"
    "  igsp options --preset paper --dof 4";

}  // namespace

void add_options_command(CLI::App& app, Command& command) {
  CLI::App* options = app.add_subcommand("options", "print all options with their help and range, as a TOML file");
  const auto flags = add_option_flags(*options);
  options->footer(examples);
  options->callback([flags, &command] { command = [flags] { return run_options(*flags); }; });
}

}  // namespace igsp::cli
