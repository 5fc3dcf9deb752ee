#include <fmt/format.h>

#include <string_view>

#include "completion/completion.hpp"

namespace igsp::cli {
namespace {

// Inside single quotes, in a specification of _arguments: brackets and colons have a meaning there.
std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '\'') {
      result += "'\\''";
      continue;
    }
    if (c == '[' || c == ']' || c == ':' || c == '\\') result += '\\';
    result += c;
  }
  return result;
}

std::string action(const ArgumentDescription& argument) {
  if (!argument.choices.empty()) return fmt::format("({})", fmt::join(argument.choices, " "));
  if (argument.value == "DIR") return "_files -/";
  return argument.value == "FILE" || argument.names.front()[0] != '-' ? "_files" : " ";
}

std::string flag_lines(const ArgumentDescription& flag) {
  std::string lines;
  for (const std::string& name : flag.names) {
    const bool takes_value = !flag.value.empty();
    const std::string assigned = !takes_value ? "" : name.starts_with("--") ? "=" : "+";
    const std::string value = takes_value ? fmt::format(":{}:{}", escaped(flag.value), action(flag)) : "";
    lines += fmt::format("      '{}{}{}[{}]{}'\n", flag.repeats ? "*" : "", name, assigned, escaped(flag.help), value);
  }
  return lines;
}

std::string zsh_case(const CommandDescription& command) {
  std::string lines;
  for (const ArgumentDescription& flag : command.flags) lines += flag_lines(flag);
  for (const ArgumentDescription& positional : command.positionals) {
    lines += fmt::format("      '{}:{}:{}'\n", positional.repeats ? "*" : "", escaped(positional.names.front()),
                         action(positional));
  }
  return fmt::format("    {})\n      specifications=(\n{}      )\n      ;;\n", command.name, lines);
}

}  // namespace

std::string zsh_completion(const CommandDescription& program) {
  std::string commands, cases, flags;
  for (const CommandDescription& command : program.subcommands) {
    commands += fmt::format("    '{}:{}'\n", command.name, escaped(command.help));
    cases += zsh_case(command);
  }
  for (const ArgumentDescription& flag : program.flags) flags += flag_lines(flag);
  return fmt::format(R"(#compdef {0}
# zsh completion for {0}, printed by `{0} completion zsh`
_{0}() {{
  local -a commands specifications
  commands=(
{1}  )
  if ((CURRENT == 2)); then
    specifications=(
{2}    )
    _arguments $specifications ':command:{{_describe -t commands command commands}}'
    return
  fi
  shift words
  ((CURRENT--))
  case $words[1] in
{3}  esac
  _arguments -s $specifications
}}
if [[ $funcstack[1] == _{0} ]]; then
  _{0} "$@"
else
  compdef _{0} {0}
fi
)",
                     program.name, commands, flags, cases);
}

}  // namespace igsp::cli
