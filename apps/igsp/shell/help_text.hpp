#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace igsp::cli {

/// Where the right column of --help begins.
inline constexpr std::size_t help_column = 36;

/// Breaks a description into lines for the right column of --help.
std::string wrapped(std::string_view text, std::size_t width = 80);

}  // namespace igsp::cli
