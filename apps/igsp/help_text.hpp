#pragma once

#include <string>
#include <string_view>

namespace igsp::cli {

/// Breaks a description into lines for the right column of --help.
std::string wrapped(std::string_view text, std::size_t width = 80);

}  // namespace igsp::cli
