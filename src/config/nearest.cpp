#include "config/nearest.hpp"

#include <algorithm>
#include <vector>

namespace igsp {

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before_last(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before_last.swap(last);
    last.swap(row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] != b[j - 1])});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) row[j] = std::min(row[j], before_last[j - 2] + 1);
    }
  }
  return row[b.size()];
}

std::string_view nearest(std::string_view word, std::span<const std::string_view> candidates) {
  const auto distance = [&](std::string_view candidate) {
    const std::size_t whole = edit_distance(word, candidate);
    const std::size_t dot = candidate.rfind('.');
    return dot == std::string_view::npos ? whole : std::min(whole, edit_distance(word, candidate.substr(dot + 1)));
  };
  return *std::ranges::min_element(candidates, {}, distance);
}

}  // namespace igsp
