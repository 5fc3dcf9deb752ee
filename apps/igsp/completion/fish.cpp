#include <fmt/format.h>

#include "completion/completion.hpp"

namespace igsp::cli {
namespace {

std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) {
    if (c == '\'' || c == '\\') result += '\\';
    result += c;
  }
  return result + "'";
}

std::string value_of(const ArgumentDescription& argument) {
  if (argument.value.empty() && argument.names.front()[0] == '-') return "";
  if (!argument.choices.empty())
    return fmt::format(" -x -a {}", quoted(fmt::format("{}", fmt::join(argument.choices, " "))));
  if (argument.value == "DIR") return " -x -a '(__fish_complete_directories)'";
  return argument.value == "FILE" ? " -r -F" : " -x";
}

std::string flag_line(const std::string& program, const std::string& condition, const ArgumentDescription& flag) {
  std::string names;
  for (const std::string& name : flag.names) {
    names += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
  }
  return fmt::format("complete -c {}{}{}{} -d {}\n", program, condition, names, value_of(flag), quoted(flag.help));
}

}  // namespace

std::string fish_completion(const CommandDescription& program) {
  std::string lines = fmt::format("# fish completion for {0}, printed by `{0} completion fish`\n", program.name);
  for (const ArgumentDescription& flag : program.flags) {
    lines += flag_line(program.name, " -n __fish_use_subcommand", flag);
  }
  for (const CommandDescription& command : program.subcommands) {
    lines += fmt::format("complete -c {} -f -n __fish_use_subcommand -a {} -d {}\n", program.name, command.name,
                         quoted(command.help));
    const std::string condition = fmt::format(" -n '__fish_seen_subcommand_from {}'", command.name);
    for (const ArgumentDescription& flag : command.flags) lines += flag_line(program.name, condition, flag);
    if (command.positionals.empty()) {
      lines += fmt::format("complete -c {}{} -f\n", program.name, condition);
    } else if (const auto& choices = command.positionals.front().choices; !choices.empty()) {
      lines += fmt::format("complete -c {}{} -f -a {}\n", program.name, condition,
                           quoted(fmt::format("{}", fmt::join(choices, " "))));
    }
  }
  return lines;
}

}  // namespace igsp::cli
