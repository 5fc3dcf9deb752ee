#include "io/moved_line.hpp"

#include <algorithm>

#include "io/number_text.hpp"

namespace igsp::io {

namespace {

struct Replacement {
  std::string_view old;  // in the line
  std::string text;
};

std::string_view without_quotes(std::string_view token) {
  while (token.starts_with('"') || token.starts_with('\'')) token.remove_prefix(1);
  while (token.ends_with('"') || token.ends_with('\'')) token.remove_suffix(1);
  return token;
}

std::string text_of(double value, ScalarType type, const LineSyntax& syntax) {
  std::string text;
  if (type == ScalarType::float64)
    append_number(text, value);
  else
    append_number(text, static_cast<float>(value));
  if (syntax.decimal_comma) std::ranges::replace(text, '.', ',');
  return text;
}

/// The values of a line, as many as something moves among; a list is its length.
std::vector<std::string_view> values_of(std::string_view line, const LineMotion& motion) {
  std::size_t needed = 0;
  for (const MovedFields& moved : motion.moved) {
    needed = std::max(needed, 1 + *std::ranges::max_element(moved.fields));
  }
  const TextTable& table = motion.table;
  line = without_brackets(line, table.syntax);
  Tokenizer tokens(line, table.syntax.separator ? *table.syntax.separator : separator_of(line));
  std::vector<std::string_view> values;
  for (std::string_view token; values.size() < needed && tokens.next(token); values.push_back(token)) {
    if (values.size() >= table.columns.size() || table.columns[values.size()] != Column::list) continue;
    std::string_view skipped;
    for (std::uint64_t i = parse_number<std::uint64_t>(token).value_or(0); i > 0 && tokens.next(skipped); --i) {
    }
  }
  return values;
}

void replace_moved(const InputFile& file, const std::vector<std::string_view>& values, const MovedFields& fields,
                   const LineMotion& motion, const Transformation& transformation,
                   std::vector<Replacement>& replacements) {
  Eigen::Vector3d before;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t i = fields.fields[axis];
    const auto value = i < values.size() ? parse_value(values[i], motion.table.syntax) : std::nullopt;
    if (!value) return;  // a row without a normal
    before[static_cast<Eigen::Index>(axis)] = *value;
  }
  const Eigen::Vector3d after = moved(before, fields.direction, transformation);
  if (!before.allFinite()) return;
  const auto written_as = [&](std::size_t axis) {
    const std::size_t i = fields.fields[axis];
    return i < motion.written.size() ? motion.written[i] : ScalarType::float64;
  };
  if (!fields.direction) require_held(file, after, {written_as(0), written_as(1), written_as(2)});
  if (!after.allFinite()) return;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto k = static_cast<Eigen::Index>(axis);
    const std::size_t i = fields.fields[axis];
    if (before[k] == after[k]) continue;
    const std::string_view old = motion.table.syntax.quotes ? without_quotes(values[i]) : values[i];
    replacements.push_back({old, text_of(after[k], written_as(axis), motion.table.syntax)});
  }
}

}  // namespace

void append_moved_line(const InputFile& file, std::string_view line, const LineMotion& motion,
                       const Transformation& transformation, std::string& text) {
  parse_point(file, line, motion.table);  // fails where the line holds no point
  const std::vector<std::string_view> values = values_of(line, motion);
  std::vector<Replacement> replacements;
  for (const MovedFields& fields : motion.moved) {
    replace_moved(file, values, fields, motion, transformation, replacements);
  }
  std::ranges::sort(replacements, {}, [](const Replacement& replacement) { return replacement.old.data(); });
  const char* position = line.data();
  for (const Replacement& replacement : replacements) {
    text.append(position, replacement.old.data());
    text += replacement.text;
    position = replacement.old.data() + replacement.old.size();
  }
  text.append(position, line.data() + line.size());
}

}  // namespace igsp::io
