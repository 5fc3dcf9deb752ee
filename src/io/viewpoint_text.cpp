#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "igsp/errors.hpp"
#include "igsp/viewpoint.hpp"
#include "io/number_text.hpp"

namespace igsp {

ViewpointRequest parse_viewpoint(std::string_view option, std::string_view text) {
  if (text == "auto") return {};
  if (text == "none") return {.kind = ViewpointRequest::Kind::none};
  ViewpointRequest request{.kind = ViewpointRequest::Kind::given};
  const auto fail = [&] {
    throw InvalidArgument(fmt::format(
        "{} is {}; it must be three finite numbers x,y,z in the file's frame (x,y,z! insists), none or auto", option,
        io::in_quotes(text)));
  };
  std::string_view numbers = text;
  if (numbers.ends_with('!')) {
    request.insist = true;
    numbers.remove_suffix(1);
  }
  const std::vector<std::string_view> parts = io::split(numbers, ',');
  if (parts.size() != 3 || numbers.ends_with(',')) fail();
  for (std::size_t i = 0; i < 3; ++i) {
    const auto number = io::parse_number<double>(parts[i]);
    if (!number || !std::isfinite(*number)) fail();
    request.position[static_cast<Eigen::Index>(i)] = *number;
  }
  return request;
}

}  // namespace igsp
