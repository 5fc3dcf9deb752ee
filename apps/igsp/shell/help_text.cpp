#include "shell/help_text.hpp"

#include <algorithm>

namespace igsp::cli {

std::string wrapped(std::string_view text, std::size_t width) {
  std::string lines;
  std::size_t column = 0;
  while (!text.empty()) {
    const std::size_t length = std::min(text.find(' '), text.size());
    const bool fits = column == 0 || column + 1 + length <= width;
    if (column > 0) lines += fits ? ' ' : '\n';
    lines += text.substr(0, length);
    column = fits && column > 0 ? column + 1 + length : length;
    text.remove_prefix(std::min(length + 1, text.size()));
  }
  return lines;
}

}  // namespace igsp::cli
