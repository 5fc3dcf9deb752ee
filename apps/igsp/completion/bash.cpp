#include <fmt/format.h>

#include <map>

#include "completion/completion.hpp"

namespace igsp::cli {
namespace {

std::string words_of(const std::vector<ArgumentDescription>& flags) {
  std::vector<std::string> names;
  for (const ArgumentDescription& flag : flags) names.insert(names.end(), flag.names.begin(), flag.names.end());
  return fmt::format("{}", fmt::join(names, " "));
}

// "@FILE" and "@DIR" ask for names of the file system, anything else is a list of words; empty: nothing to offer.
std::string offer(const ArgumentDescription& argument) {
  if (!argument.choices.empty()) return fmt::format("{}", fmt::join(argument.choices, " "));
  return argument.value == "FILE" || argument.value == "DIR" ? "@" + argument.value : "";
}

std::string positional_offer(const CommandDescription& command) {
  if (command.positionals.empty()) return "";
  const auto& choices = command.positionals.front().choices;
  return choices.empty() ? "@FILE" : fmt::format("{}", fmt::join(choices, " "));
}

std::string bash_case(const CommandDescription& command) {
  std::map<std::string, std::vector<std::string>> flags_by_offer;
  for (const ArgumentDescription& flag : command.flags) {
    auto& names = flags_by_offer[offer(flag)];
    if (!flag.value.empty()) names.insert(names.end(), flag.names.begin(), flag.names.end());
  }
  std::string values;
  for (const auto& [words, names] : flags_by_offer) {
    if (!names.empty()) values += fmt::format("        {}) offer=\"{}\" ;;\n", fmt::join(names, " | "), words);
  }
  return fmt::format(R"(    {})
      flags="{}"
      case $previous in
{}        *) offer="{}" is_value= ;;
      esac
      ;;
)",
                     command.name, words_of(command.flags), values, positional_offer(command));
}

}  // namespace

std::string bash_completion(const CommandDescription& program) {
  std::string cases, names;
  for (const CommandDescription& command : program.subcommands) {
    cases += bash_case(command);
    names += command.name + " ";
  }
  // Bash splits "--flag=value" at the equals sign into three words.
  return fmt::format(R"(# bash completion for {0}, printed by `{0} completion bash`
_{0}() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD - 1]}}
  local flags= offer= is_value=yes
  if [[ $current == = ]]; then
    current=
  elif [[ $previous == = ]]; then
    previous=${{COMP_WORDS[COMP_CWORD - 2]}}
  fi
  COMPREPLY=()
  if ((COMP_CWORD == 1)); then
    mapfile -t COMPREPLY < <(compgen -W "{1}{2}" -- "$current")
    return
  fi
  case ${{COMP_WORDS[1]}} in
{3}  esac
  if [[ -z $is_value && $current == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$flags" -- "$current")
  elif [[ $offer == @FILE ]]; then
    compopt -o filenames 2>/dev/null
    mapfile -t COMPREPLY < <(compgen -f -- "$current")
  elif [[ $offer == @DIR ]]; then
    compopt -o filenames 2>/dev/null
    mapfile -t COMPREPLY < <(compgen -d -- "$current")
  elif [[ -n $offer ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$offer" -- "$current")
  fi
}}
complete -F _{0} {0}
)",
                     program.name, names, words_of(program.flags), cases);
}

}  // namespace igsp::cli
