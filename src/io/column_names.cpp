#include "io/column_names.hpp"

#include <algorithm>

#include "io/number_text.hpp"
#include "io/text_table.hpp"

namespace igsp::io {

namespace {

using Aliases = std::vector<std::string_view>;

/// In order: what stands further left is believed first.
const std::array<Aliases, 3>& aliases() {
  static const std::array<Aliases, 3> names = {
      Aliases{"x", "easting", "east", "e", "points:0", "points_0", "x_coordinate", "pos_x", "position_x", "coord_x"},
      Aliases{"y", "northing", "north", "n", "points:1", "points_1", "y_coordinate", "pos_y", "position_y", "coord_y"},
      Aliases{"z", "height", "elevation", "altitude", "up", "h", "points:2", "points_2", "z_coordinate", "pos_z",
              "position_z", "coord_z", "elev", "alt"}};
  return names;
}

}  // namespace

std::vector<std::string> names_on_line(std::string_view line) {
  const bool tabs = line.find('\t') != line.npos && separator_of(line) == ' ';
  std::vector<std::string> names;
  for (std::string_view name : split(line, tabs ? '\t' : separator_of(line))) {
    while (name.starts_with('"') || name.starts_with('\'')) name.remove_prefix(1);
    while (name.ends_with('"') || name.ends_with('\'')) name.remove_suffix(1);
    const bool unit_alone = name.starts_with('[') || name.starts_with('(');  // of "X [m] Y [m]" at blanks
    if (!unit_alone) names.emplace_back(name);
  }
  return names;
}

std::string plain_name(std::string_view name) {
  name = name.substr(0, name.find_first_of("[("));
  while (!name.empty() && Tokenizer::is_blank(name.back())) name.remove_suffix(1);
  std::string plain(name);
  for (char& c : plain) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    if (c == ' ' || c == '-') c = '_';
  }
  return plain;
}

std::optional<std::array<std::size_t, 3>> find_coordinates(const std::vector<std::string>& names) {
  std::vector<std::string> plain;
  for (const std::string& name : names) plain.push_back(plain_name(name));
  std::array<std::size_t, 3> found{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto known = std::ranges::find_if(
        aliases()[axis], [&](std::string_view alias) { return std::ranges::find(plain, alias) != plain.end(); });
    if (known == aliases()[axis].end() || std::ranges::count(plain, *known) != 1) return std::nullopt;
    found[axis] = static_cast<std::size_t>(std::ranges::find(plain, *known) - plain.begin());
  }
  return found;
}

bool are_geographic(const std::vector<std::string>& names) {
  const auto has = [&](std::string_view start) {
    return std::ranges::any_of(names, [&](const std::string& name) { return plain_name(name).starts_with(start); });
  };
  return (has("lon") || has("lng")) && has("lat");
}

}  // namespace igsp::io
