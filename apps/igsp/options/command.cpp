#include <fmt/format.h>

#include <iostream>

#include "config/option_list.hpp"
#include "config/toml_file.hpp"
#include "igsp/version.hpp"
#include "report/json.hpp"
#include "shell/commands.hpp"
#include "shell/exit_codes.hpp"
#include "shell/option_flags.hpp"

namespace igsp::cli {
namespace {

// For whoever makes a form or a page of the options: the list itself, a record per option.
Json list_of(const Options& options) {
  Json list = Json::array();
  for (const Option& option : option_list()) {
    const Json value = std::visit([](const auto& alternative) { return Json(alternative); }, option.get(options));
    list.push_back({{"key", option.key},
                    {"flag", option.flag},
                    {"value", value},
                    {"unit", option.unit},
                    {"admissible", values_in_words(option)},
                    {"help", option.help}});
  }
  return list;
}

int run_options(const OptionFlags& flags, bool json) {
  const Options options = resolve(flags);
  if (json) {
    std::cout << list_of(options).dump(2) << "\n";
  } else {
    std::cout << fmt::format("# Options of igsp {}\n{}", version, options_to_toml(options));
  }
  return exit_registered;
}

constexpr const char* examples =
    "Examples:\n"
    "  igsp options > igsp.toml                  then: igsp align a.ply b.ply --config igsp.toml\n"
    "  igsp options --preset paper --dof 4";

}  // namespace

void add_options_command(CLI::App& app, Command& command) {
  CLI::App* options = app.add_subcommand("options", "print all options with their help and range, as a TOML file");
  const auto json = std::make_shared<bool>(false);
  options->add_flag("--json", *json, "as JSON, with flag, unit and range of every option");
  const auto flags = add_option_flags(*options);
  options->footer(examples);
  options->callback([=, &command] { command = [=] { return run_options(*flags, *json); }; });
}

}  // namespace igsp::cli
