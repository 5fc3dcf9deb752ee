#include "options.hpp"

#include <fmt/format.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/string_view.h>
#include <nanobind/stl/variant.h>
#include <nanobind/stl/vector.h>

#include <algorithm>

#include "config/nearest.hpp"
#include "config/option_list.hpp"
#include "config/preset.hpp"
#include "config/toml_file.hpp"
#include "igsp/errors.hpp"

namespace igsp::python {
namespace {

std::string keyword_of(const Option& option) {
  std::string keyword(option.flag.substr(2));
  std::ranges::replace(keyword, '-', '_');
  return keyword;
}

[[noreturn]] void fail_unknown(const std::string& word) {
  std::vector<std::string> known = {"preset", "config"};
  for (const Option& option : option_list()) known.push_back(keyword_of(option));
  const std::vector<std::string_view> views(known.begin(), known.end());
  throw nb::type_error(fmt::format("unknown option {}; did you mean {}?", word, nearest(word, views)).c_str());
}

const Option& find_option(const std::string& keyword) {
  for (const Option& option : option_list()) {
    if (keyword_of(option) == keyword) return option;
  }
  fail_unknown(keyword);
}

OptionValue value_of(const std::string& keyword, nb::handle value) {
  if (nb::isinstance<nb::bool_>(value)) return nb::cast<bool>(value);  // first: to Python it is an integer, too
  if (nb::isinstance<nb::str>(value)) return nb::cast<std::string>(value);
  int integer = 0;
  if (nb::isinstance<nb::int_>(value) && nb::try_cast(value, integer)) return integer;
  double real = 0.0;
  if (nb::try_cast(value, real)) return real;
  throw InvalidArgument(
      fmt::format("option {} is {}; it must be a number, a name or a boolean", keyword, nb::repr(value).c_str()));
}

std::string text_of(const Keywords& keywords, const char* keyword) {
  const nb::object value = keywords[keyword];
  std::string text;
  if (nb::try_cast(value, text)) return text;
  throw InvalidArgument(fmt::format("option {} is {}; it must be a string", keyword, nb::repr(value).c_str()));
}

Options start_of(const Keywords& keywords) {
  const bool has_config = keywords.contains("config"), has_preset = keywords.contains("preset");
  if (has_config && has_preset) {
    throw InvalidArgument("preset and config both say where the options start: give one of them");
  }
  if (has_config) return read_options(text_of(keywords, "config"));
  return preset(has_preset ? text_of(keywords, "preset") : "default");
}

Keywords described(const Option& option) {
  constexpr std::string_view kinds[] = {"boolean", "integer", "real", "choice"};
  Keywords entry;
  entry["keyword"] = keyword_of(option);
  entry["key"] = option.key;
  entry["flag"] = option.flag;
  entry["kind"] = kinds[static_cast<std::size_t>(option.kind)];
  entry["unit"] = option.unit;
  entry["choices"] = std::vector<std::string_view>(option.choices.begin(), option.choices.end());
  entry["admissible"] = values_in_words(option);
  entry["default"] = option.get(Options{});
  entry["help"] = option.help;
  return entry;
}

}  // namespace

Options options_of(const Keywords& keywords) {
  Options options = start_of(keywords);
  for (const auto& [key, value] : keywords) {
    const std::string keyword = nb::cast<std::string>(key);
    if (keyword == "preset" || keyword == "config") continue;
    const Option& option = find_option(keyword);
    assign(options, option, value_of(keyword, value));
  }
  return options;
}

Keywords keywords_of(const Options& options) {
  Keywords keywords;
  for (const Option& option : option_list()) keywords[keyword_of(option).c_str()] = option.get(options);
  return keywords;
}

void bind_options(nb::module_& module) {
  module.def(
      "option_list",
      [] {
        nb::typed<nb::list, Keywords> entries;
        for (const Option& option : option_list()) entries.append(described(option));
        return entries;
      },
      "Every option of the library's one list: keyword, key in TOML, flag, kind, unit, choices, admissible values, "
      "default, help.");
  module.def(
      "preset_names",
      [] {
        const auto names = preset_names();
        return std::vector<std::string_view>(names.begin(), names.end());
      },
      "The names that the option `preset` takes.");
  module.def(
      "resolve_options", [](const Keywords& keywords) { return keywords_of(options_of(keywords)); },
      nb::arg("keywords"), "All options as keywords, after the preset and the given ones.");
}

}  // namespace igsp::python
