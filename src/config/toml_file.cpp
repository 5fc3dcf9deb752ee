#include "config/toml_file.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cctype>
#include <vector>

#include "config/nearest.hpp"
#include "config/option_list.hpp"
#include "igsp/errors.hpp"
#include "io/whole_file.hpp"

namespace igsp {
namespace {

constexpr std::string_view preset_key = "preset";

std::string value_text(const Option& option, const Options& options) {
  const std::string text = to_string(option.get(options));
  return option.kind == OptionKind::choice ? '"' + text + '"' : text;
}

// The text an error starts with: where in the file the value stands.
std::string location(std::string_view name, const toml::source_region& source) {
  return fmt::format("{}:{}:{}: ", name, source.begin.line, source.begin.column);
}

[[noreturn]] void fail_unknown(std::string_view key, const std::string& where) {
  std::vector<std::string_view> known{preset_key};
  for (const Option& option : option_list()) {
    known.push_back(option.key);
    if (!option.section.empty()) known.push_back(option.section);
  }
  throw InvalidArgument(fmt::format("{}unknown option \"{}\"; did you mean \"{}\"?", where, key, nearest(key, known)));
}

OptionValue value_of(const toml::node& node, const Option& option, const std::string& where) {
  if (const auto flag = node.value_exact<bool>()) return *flag;
  if (const auto real = node.value_exact<double>()) return *real;
  if (const auto name = node.value_exact<std::string>()) return *name;
  if (const auto integer = node.value_exact<std::int64_t>()) {
    if (option.kind == OptionKind::real) return static_cast<double>(*integer);
    if (*integer == static_cast<int>(*integer)) return static_cast<int>(*integer);
    throw InvalidArgument(
        fmt::format("{}option {} is {}; it must be {}", where, option.key, *integer, admissible_values(option)));
  }
  throw InvalidArgument(
      fmt::format("{}option {} takes a single value ({})", where, option.key, admissible_values(option)));
}

void assign_node(Options& options, const std::string& key, const toml::node& node, const std::string& where) {
  const auto all = option_list();
  const auto option = std::ranges::find(all, std::string_view(key), &Option::key);
  if (option == all.end()) fail_unknown(key, where);
  const OptionValue value = value_of(node, *option, where);
  try {
    assign(options, *option, value);
  } catch (const InvalidArgument& error) {
    throw InvalidArgument(where + error.what());
  }
}

void assign_table(Options& options, const toml::table& table, const std::string& section, std::string_view name) {
  for (const auto& [short_key, node] : table) {
    const std::string key = section + std::string(short_key.str());
    if (key == preset_key) continue;
    const bool is_section = node.is_table() && std::ranges::any_of(option_list(), [&](const Option& option) {
                              return option.section == key;
                            });
    if (is_section) {
      assign_table(options, *node.as_table(), key + ".", name);
    } else {
      assign_node(options, key, node, location(name, short_key.source()));
    }
  }
}

// The parser takes for granted what it has not seen, and aborts or does anything on a good deal of what is no TOML. So
// it is only shown lines of a form that it survives: a section, an option with a single value, a comment.

std::string_view take_while(std::string_view& line, bool (*belongs)(char)) {
  const std::string_view taken = line.substr(0, std::ranges::find_if_not(line, belongs) - line.begin());
  line.remove_prefix(taken.size());
  return taken;
}

bool take(std::string_view& line, char letter) {
  if (!line.starts_with(letter)) return false;
  line.remove_prefix(1);
  return true;
}

bool is_blank(char letter) {
  return letter == ' ' || letter == '\t';
}
bool is_digit_or_letter(char letter) {
  return std::isalnum(static_cast<unsigned char>(letter)) != 0;
}
bool is_of_name(char letter) {
  return is_digit_or_letter(letter) || letter == '_' || letter == '-' || letter == '.';
}
bool is_of_number(char letter) {
  return is_of_name(letter) || letter == '+';
}

bool is_of_quoted(char letter) {
  const bool is_printable = letter >= ' ' && letter <= '~';
  return is_printable && letter != '"' && letter != '\'' && letter != '\\';
}

// Every part of a dotted name is a table in the one before; the parser follows them down its stack without a limit.
constexpr std::size_t longest_name = 200;

bool is_name(std::string_view text) {
  return !text.empty() && !text.starts_with('.') && !text.ends_with('.') && text.find("..") == std::string_view::npos;
}

// A number, true or false; no date, which has signs elsewhere.
bool take_bare_value(std::string_view& line) {
  const std::string_view value = take_while(line, is_of_number);
  for (std::size_t i = 1; i < value.size(); ++i) {
    const bool is_sign = value[i] == '+' || value[i] == '-';
    if (is_sign && value[i - 1] != 'e' && value[i - 1] != 'E') return false;
  }
  return !value.empty();
}

bool take_value(std::string_view& line) {
  for (const char quote : {'"', '\''}) {
    if (!take(line, quote)) continue;
    take_while(line, is_of_quoted);
    return take(line, quote);
  }
  return take_bare_value(line);
}

// What is wrong with a line, or nothing.
std::string_view fault_of(std::string_view line) {
  take_while(line, is_blank);
  if (!line.empty() && !line.starts_with('#')) {
    const bool is_section = take(line, '[');
    take_while(line, is_blank);
    const std::string_view name = take_while(line, is_of_name);
    if (name.size() > longest_name) return "a name of more than 200 letters; an option is called section.name";
    take_while(line, is_blank);
    if (!is_name(name) || !take(line, is_section ? ']' : '=')) return "neither [section] nor name = value";
    take_while(line, is_blank);
    if (!is_section && !take_value(line)) {
      return "an option takes a single value: a number, true, false or a name in quotes";
    }
  }
  take_while(line, is_blank);
  if (line.empty() || line.starts_with('#')) return {};
  return "more than one section or value in a line";
}

void check_lines(std::string_view text, std::string_view name) {
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
  for (std::size_t number = 1; !text.empty(); ++number) {
    std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    if (line.ends_with('\r')) line.remove_suffix(1);
    const std::string_view fault = fault_of(line);
    if (!fault.empty()) throw FileError(fmt::format("{}:{}: {}", name, number, fault));
  }
}

Options base_options(const toml::table& table, std::string_view name) {
  const toml::node* node = table.get(preset_key);
  if (node == nullptr) return preset("default");
  const auto preset_name = node->value_exact<std::string>();
  const std::string where = location(name, node->source());
  if (!preset_name) throw InvalidArgument(where + "preset takes a name");
  try {
    return preset(*preset_name);
  } catch (const InvalidArgument& error) {
    throw InvalidArgument(where + error.what());
  }
}

}  // namespace

std::string options_to_toml(const Options& options) {
  std::string text;
  std::string_view section;
  for (const Option& option : option_list()) {
    if (option.section != section) {
      section = option.section;
      text += fmt::format("\n[{}]\n", section);
    }
    const std::string range = option.kind == OptionKind::boolean ? "" : "; " + values_in_words(option);
    const std::string unit = option.unit.empty() ? "" : fmt::format(" [{}]", option.unit);
    const std::string assignment = fmt::format("{} = {}", name_in_section(option), value_text(option, options));
    text += fmt::format("{:<32}# {}{}{}\n", assignment, option.help, unit, range);
  }
  return text;
}

Options options_from_toml(std::string_view text, std::string_view name) {
  check_lines(text, name);
  toml::table table;
  try {
    table = toml::parse(text, name);
  } catch (const toml::parse_error& error) {
    throw FileError(location(name, error.source()) + std::string(error.description()));
  }
  Options options = base_options(table, name);
  assign_table(options, table, "", name);
  return options;
}

Options read_options(const std::filesystem::path& path) {
  constexpr std::uint64_t most_bytes = 1 << 20;  // two hundred times what all options take
  return options_from_toml(io::read_whole(path, most_bytes), path.string());
}

}  // namespace igsp
