#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "config/option_list.hpp"
#include "igsp/errors.hpp"

namespace igsp {
namespace {

// "6.0", "1e-05": a real number that TOML, too, reads as one.
std::string real_text(double value) {
  std::string text = fmt::format("{}", value);
  return text.find_first_of(".en") == std::string::npos ? text + ".0" : text;
}

std::string_view expected(OptionKind kind) {
  switch (kind) {
    case OptionKind::boolean:
      return "true or false";
    case OptionKind::integer:
      return "an integer";
    case OptionKind::real:
      return "a number";
    case OptionKind::choice:
      return "a name";
  }
  return "";
}

double number(const OptionValue& value) {
  return std::holds_alternative<int>(value) ? std::get<int>(value) : std::get<double>(value);
}

bool has_kind(OptionKind kind, const OptionValue& value) {
  return value.index() == static_cast<std::size_t>(kind);
}
static_assert(std::is_same_v<double, std::variant_alternative_t<std::size_t(OptionKind::real), OptionValue>>);

bool admissible(const Option& option, const OptionValue& value) {
  switch (option.kind) {
    case OptionKind::boolean:
      return true;
    case OptionKind::choice:
      return std::ranges::find(option.choices, std::get<std::string>(value)) != option.choices.end();
    default:
      return contains(option.range, number(value));
  }
}

template <typename Number>
std::optional<Number> parse(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

[[noreturn]] void fail_kind(const Option& option, std::string_view given) {
  throw InvalidArgument(fmt::format("option {} ({}) takes {}{}, not {}", option.key, option.flag, expected(option.kind),
                                    option.kind == OptionKind::choice ? ", " + admissible_values(option) : "", given));
}

}  // namespace

bool contains(const Range& range, double value) {
  if (!std::isfinite(value)) return false;
  if (range.shape == Range::Shape::ends_only) return value == range.low || value == range.high;
  return (range.low_open ? value > range.low : value >= range.low) &&
         (range.high_open ? value < range.high : value <= range.high);
}

std::string to_string(const Range& range) {
  if (range.shape == Range::Shape::ends_only) return fmt::format("{} or {}", range.low, range.high);
  const bool bounded_below = std::isfinite(range.low), bounded_above = std::isfinite(range.high);
  if (!bounded_below && !bounded_above) return "";
  if (!bounded_above) return fmt::format("{} {}", range.low_open ? "greater than" : "at least", range.low);
  if (!bounded_below) return fmt::format("{} {}", range.high_open ? "less than" : "at most", range.high);
  return fmt::format("in {}{}, {}{}", range.low_open ? '(' : '[', range.low, range.high, range.high_open ? ')' : ']');
}

std::string to_string(const OptionValue& value) {
  struct Text {
    std::string operator()(bool flag) const { return flag ? "true" : "false"; }
    std::string operator()(int integer) const { return std::to_string(integer); }
    std::string operator()(double real) const { return real_text(real); }
    std::string operator()(const std::string& name) const { return name; }
  };
  return std::visit(Text{}, value);
}

std::string admissible_values(const Option& option) {
  if (option.kind == OptionKind::choice) return fmt::format("one of {}", fmt::join(option.choices, ", "));
  if (option.kind == OptionKind::boolean) return std::string(expected(option.kind));
  const std::string range = to_string(option.range);
  return range.empty() ? std::string(expected(option.kind)) : range;
}

std::string values_in_words(const Option& option) {
  const std::string usual = to_string(option.usual);
  return usual.empty() ? admissible_values(option) : fmt::format("{}; usual: {}", admissible_values(option), usual);
}

std::vector<std::string> unusual_values(const Options& options) {
  std::vector<std::string> warnings;
  for (const Option& option : option_list()) {
    const OptionValue value = option.get(options);
    const bool is_number = option.kind == OptionKind::integer || option.kind == OptionKind::real;
    if (!is_number || contains(option.usual, number(value))) continue;
    warnings.push_back(fmt::format("{} is {}{}: pairs are lost that way; usual is {}, the default {}", option.flag,
                                   to_string(value), option.unit.empty() ? "" : fmt::format(" [{}]", option.unit),
                                   to_string(option.usual), to_string(option.get(Options{}))));
  }
  return warnings;
}

void check(const Option& option, const OptionValue& value) {
  if (!has_kind(option.kind, value)) fail_kind(option, to_string(value));
  if (admissible(option, value)) return;
  throw InvalidArgument(fmt::format("option {} ({}) is {}; it must be {}{}", option.key, option.flag, to_string(value),
                                    admissible_values(option),
                                    option.unit.empty() ? "" : fmt::format(" [{}]", option.unit)));
}

void assign(Options& options, const Option& option, const OptionValue& value) {
  const bool widen = option.kind == OptionKind::real && std::holds_alternative<int>(value);
  const OptionValue stored = widen ? OptionValue(number(value)) : value;
  check(option, stored);
  option.set(options, stored);
}

void assign_text(Options& options, const Option& option, std::string_view text) {
  std::optional<OptionValue> value;
  switch (option.kind) {
    case OptionKind::boolean:
      if (text == "true" || text == "false") value = text == "true";
      break;
    case OptionKind::integer:
      value = parse<int>(text);
      break;
    case OptionKind::real:
      value = parse<double>(text);
      break;
    case OptionKind::choice:
      value = std::string(text);
      break;
  }
  if (!value) fail_kind(option, fmt::format("\"{}\"", text));
  assign(options, option, *value);
}

void validate(const Options& options) {
  for (const Option& option : option_list()) check(option, option.get(options));
}

}  // namespace igsp
