#include "completion/command_description.hpp"

#include <algorithm>
#include <cctype>

namespace igsp::cli {
namespace {

std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

// Words in lower case or digits, separated by bars, are what may be typed; FILE or GROUP|GLOB say what kind of thing.
std::vector<std::string> choices_in(const std::string& value) {
  const auto is_literal = [](unsigned char c) { return std::islower(c) || std::isdigit(c) || c == '_' || c == '|'; };
  if (value.empty() || !std::all_of(value.begin(), value.end(), is_literal)) return {};
  return CLI::detail::split(value, '|');
}

ArgumentDescription describe(const CLI::Option& option) {
  ArgumentDescription argument;
  if (option.get_positional()) argument.names.push_back(option.get_name(true));
  for (const std::string& name : option.get_snames()) argument.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) argument.names.push_back("--" + name);
  if (option.get_items_expected_max() > 0) argument.value = option.get_type_name();
  argument.choices = choices_in(argument.value);
  argument.help = one_line(option.get_description());
  argument.group = option.get_group();
  argument.required = option.get_required();
  argument.repeats = option.get_items_expected_max() > 1;
  return argument;
}

}  // namespace

CommandDescription describe(const CLI::App& app) {
  CommandDescription command{app.get_name(), one_line(app.get_description()), app.get_footer(), {}, {}, {}};
  for (const CLI::Option* option : app.get_options()) {
    (option->get_positional() ? command.positionals : command.flags).push_back(describe(*option));
  }
  for (const CLI::App* subcommand : app.get_subcommands({})) command.subcommands.push_back(describe(*subcommand));
  return command;
}

}  // namespace igsp::cli
