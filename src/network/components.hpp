#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace igsp {

using Edge = std::pair<std::size_t, std::size_t>;

/// Connected components: nodes ascending, the largest component first, then by its first node.
std::vector<std::vector<std::size_t>> connected_components(std::size_t nodes, std::span<const Edge> edges);

/// Per edge: in no loop. Of parallel edges none is a bridge.
std::vector<bool> bridges(std::size_t nodes, std::span<const Edge> edges);

/// Whose frame is the component's world: that of `fixed` if it is one of them, else of the first.
std::size_t anchor_of(const std::vector<std::size_t>& component, const std::optional<std::size_t>& fixed);

}  // namespace igsp
