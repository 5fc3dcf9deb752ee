#include "completion/manual_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "igsp/version.hpp"
#include "shell/help_text.hpp"

namespace igsp::cli {
namespace {

// Characters that roff would turn into typographic ones, which cannot be typed into a shell again.
std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '\\':
        result += "\\e";
        break;
      case '-':
        result += "\\-";
        break;
      case '\'':
        result += "\\(aq";
        break;
      case '`':
        result += "\\(ga";
        break;
      case '^':
        result += "\\(ha";
        break;
      case '~':
        result += "\\(ti";
        break;
      default:
        result += c;
    }
  }
  return result.starts_with('.') ? "\\&" + result : result;
}

std::string bold(std::string_view text) {
  return "\\fB" + escaped(text) + "\\fR";
}
std::string italic(std::string_view text) {
  return "\\fI" + escaped(text) + "\\fR";
}

std::string usage(const CommandDescription& program, const CommandDescription& command) {
  std::string line = bold(program.name + " " + command.name) + " [" + italic("OPTIONS") + "]";
  for (const ArgumentDescription& positional : command.positionals) {
    line += " " + italic(positional.names.front()) + (positional.repeats ? "..." : "");
  }
  return line;
}

std::string running_text(std::string_view text) {
  std::string lines = wrapped(text, 60) + "\n", result;  // short lines, as the format's own rules ask for
  for (std::size_t begin = 0, end; (end = lines.find('\n', begin)) != lines.npos; begin = end + 1) {
    result += escaped(std::string_view(lines).substr(begin, end - begin)) + "\n";
  }
  return result;
}

std::string entry(const ArgumentDescription& argument) {
  const bool is_flag = argument.names.front()[0] == '-';
  std::string names;
  for (const std::string& name : argument.names) {
    names += (names.empty() ? "" : ", ") + (is_flag ? bold(name) : italic(name));
  }
  if (!argument.value.empty()) names += " " + italic(argument.value);
  const std::string required = argument.required && is_flag ? " (required)" : "";
  return fmt::format(".TP\n{}\n{}", names, running_text(argument.help + required));
}

// Lines that are set in, as command lines are, stay as they are; the others are running text.
std::string paragraphs(std::string_view text) {
  std::string result;
  bool literal = false;
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    const bool starts = line.starts_with("  ");
    if (starts != literal) result += starts ? ".PP\n.nf\n" : ".fi\n.PP\n";
    literal = starts;
    if (!line.empty()) result += literal ? escaped(line) + "\n" : running_text(line);
  }
  return result + (literal ? ".fi\n" : "");
}

bool is_method(const ArgumentDescription& flag) {
  return flag.group.starts_with("Method");
}

std::string command_section(const CommandDescription& program, const CommandDescription& command) {
  std::string text =
      fmt::format(".SS {}\n{}", escaped(program.name + " " + command.name), running_text(command.help + "."));
  bool has_method = false;
  for (const ArgumentDescription& positional : command.positionals) text += entry(positional);
  for (const ArgumentDescription& flag : command.flags) {
    has_method = has_method || is_method(flag);
    if (!is_method(flag)) text += entry(flag);
  }
  if (has_method) text += ".PP\nAlso all of the METHOD OPTIONS below.\n";
  return text + ".PP\n" + paragraphs(command.footer);
}

std::string method_section(const CommandDescription& program) {
  for (const CommandDescription& command : program.subcommands) {
    std::string text, group;
    for (const ArgumentDescription& flag : command.flags) {
      if (!is_method(flag)) continue;
      if (flag.group != group) text += fmt::format(".SS {}\n", escaped(flag.group));
      group = flag.group;
      text += entry(flag);
    }
    if (!text.empty()) return ".SH METHOD OPTIONS\n" + text;
  }
  return "";
}

}  // namespace

std::string manual_page(const CommandDescription& program) {
  std::string page = fmt::format(".TH IGSP 1 \"{}\" \"igsp {}\" \"User Commands\"\n", IGSP_MANUAL_DATE, version);
  std::string_view purpose = program.help;
  if (purpose.starts_with(program.name)) purpose.remove_prefix(program.name.size() + 1);
  page += fmt::format(".SH NAME\n{} \\- {}\n.SH SYNOPSIS\n", program.name, escaped(purpose));
  for (const CommandDescription& command : program.subcommands) {
    page += usage(program, command) + (&command == &program.subcommands.back() ? "\n" : "\n.br\n");
  }
  page += ".SH DESCRIPTION\n" + paragraphs(program.footer) + ".SH OPTIONS\n";
  for (const ArgumentDescription& flag : program.flags) page += entry(flag);
  page += ".SH COMMANDS\n";
  for (const CommandDescription& command : program.subcommands) page += command_section(program, command);
  return page + method_section(program);
}

}  // namespace igsp::cli
