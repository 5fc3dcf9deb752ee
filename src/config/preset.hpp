#pragma once

#include <span>
#include <string_view>

namespace igsp {

/// The names that preset() knows.
std::span<const std::string_view> preset_names();

}  // namespace igsp
