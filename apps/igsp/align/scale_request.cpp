#include "align/scale_request.hpp"

#include <fmt/format.h>

#include <cmath>

#include "igsp/errors.hpp"
#include "io/number_text.hpp"

namespace igsp::cli {

ScaleRequest parse_scale(const std::string& text) {
  if (text == "auto") return {true, 1.0};
  constexpr double least = 1e-9, most = 1e9;  // beyond, no unit of length is meant
  const auto factor = io::parse_number<double>(text);
  if (!factor || !(*factor >= least && *factor <= most)) {
    throw InvalidArgument(
        fmt::format("--scale is '{}'; it must be auto or a factor from {:g} to {:g}", text, least, most));
  }
  return {false, *factor};
}

}  // namespace igsp::cli
