#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace igsp::io {

/// The names on a line: without quotes, but with their units.
std::vector<std::string> names_on_line(std::string_view line);

/// A name as it is compared: lower case, without the unit in brackets behind it.
std::string plain_name(std::string_view name);

/// Which of these columns are x, y and z, by their names: X [m], Easting, north, Height, ...; none where one of the
/// three is missing or named twice.
std::optional<std::array<std::size_t, 3>> find_coordinates(const std::vector<std::string>& names);

/// Degrees: nothing that a registration could take for lengths.
bool are_geographic(const std::vector<std::string>& names);

}  // namespace igsp::io
