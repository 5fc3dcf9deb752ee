#pragma once

#include <cstddef>
#include <span>
#include <string_view>

namespace igsp {

/// Fewest insertions, deletions, substitutions and swaps of neighbours that turn one word into the other.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The candidate with the smallest edit distance to `word`, the first of equals. A candidate with dots is also tried
/// without its section, so that "pca_radius" finds "keypoints.pca_radius". `candidates` must not be empty.
std::string_view nearest(std::string_view word, std::span<const std::string_view> candidates);

}  // namespace igsp
