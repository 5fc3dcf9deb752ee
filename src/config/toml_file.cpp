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

// Every part of a dotted key is a table in the one before; the parser follows them down its stack without a limit.
bool is_deep(std::string_view line) {
  constexpr std::ptrdiff_t most_dots = 32;  // options have two parts; numbers and a comment at the end have dots too
  return std::ranges::count(line, '.') > most_dots;
}

// "[.a]", "[=]": the parser takes for granted that a name begins there, and aborts or does anything where none does.
bool is_nameless_section(std::string_view line) {
  if (!line.starts_with('[')) return false;
  line.remove_prefix(line.starts_with("[[") ? 2 : 1);
  const std::size_t name = line.find_first_not_of(" \t");
  if (name == std::string_view::npos) return true;
  const auto letter = static_cast<unsigned char>(line[name]);
  return !(std::isalnum(letter) || std::string_view("_-\"']").find(line[name]) != std::string_view::npos);
}

// Where the letter stands outside of quotes.
std::size_t find_bare(std::string_view line, char wanted) {
  char quote = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (quote != 0) {
      if (line[i] == quote) quote = 0;
      if (line[i] == '\\' && quote == '"') ++i;
    } else if (line[i] == wanted) {
      return i;
    } else if (line[i] == '"' || line[i] == '\'') {
      quote = line[i];
    }
  }
  return std::string_view::npos;
}

// Beyond ASCII: no name and no value has that, and the parser's tables of letters have gaps into which it falls. Within
// quotes neither: what opens them for us may be another fault for the parser.
bool has_foreign_letter(std::string_view statement) {
  return std::ranges::any_of(statement, [](char letter) { return static_cast<unsigned char>(letter) > 127; });
}

// "a = [}", "a = 1970-01-01 7 ": lists, tables within a line and dates with a time are values that no option takes, and
// the parser takes for granted what it has not seen.
bool has_simple_value(std::string_view statement) {
  const std::size_t sign = find_bare(statement, '=');
  if (statement.starts_with('[') || sign == std::string_view::npos) return true;
  std::string_view value = statement.substr(sign + 1);
  const auto is_blank = [](char letter) { return static_cast<unsigned char>(letter) <= ' '; };
  while (!value.empty() && is_blank(value.front())) value.remove_prefix(1);
  while (!value.empty() && is_blank(value.back())) value.remove_suffix(1);
  if (value.starts_with('"') || value.starts_with('\'')) return true;
  return std::ranges::none_of(value, is_blank) && value.find_first_of("[]{}") == std::string_view::npos;
}

// Strings of several lines, which no option takes: what is inside and what outside shows in no single line.
bool opens_long_string(std::string_view line) {
  return line.find("\"\"\"") != std::string_view::npos || line.find("'''") != std::string_view::npos;
}

// What the parser itself does not survive.
void check_lines(std::string_view text, std::string_view name) {
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::size_t length = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, length);
    text.remove_prefix(std::min(length + 1, text.size()));
    const std::size_t first = line.find_first_not_of(" \t");
    if (first == std::string_view::npos || line[first] == '#') continue;
    const auto fail = [&](std::string_view fault) { throw FileError(fmt::format("{}:{}: {}", name, number, fault)); };
    if (is_deep(line)) fail("more than 32 dots: an option is called section.name");
    if (opens_long_string(line)) fail("an option takes no string of several lines");
    const std::string_view statement = line.substr(first, find_bare(line, '#') - first);
    if (has_foreign_letter(statement)) fail("letters outside of ASCII belong into comments");
    if (!has_simple_value(statement)) fail("an option takes a single value: a number, true, false or a name in quotes");
    if (is_nameless_section(statement)) fail("a section in brackets needs a name: [section]");
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
