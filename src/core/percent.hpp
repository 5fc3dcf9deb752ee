#pragma once

#include <fmt/format.h>

#include <string>

namespace igsp {

/// A share as people read it: "0.3 %", "42 %".
inline std::string percent(double share) {
  return fmt::format("{:.{}f} %", 100 * share, share < 0.0995 ? 1 : 0);
}

}  // namespace igsp
