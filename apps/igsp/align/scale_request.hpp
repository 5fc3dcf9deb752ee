#pragma once

#include <optional>
#include <string>

namespace igsp::cli {

/// What --scale asks for: a factor, or to find it.
struct ScaleRequest {
  bool automatic = false;
  double factor = 1.0;
};

/// "auto" or a positive number. Throws InvalidArgument.
ScaleRequest parse_scale(const std::string& text);

}  // namespace igsp::cli
