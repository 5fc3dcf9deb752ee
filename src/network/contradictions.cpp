#include "network/contradictions.hpp"

#include <algorithm>
#include <functional>
#include <numbers>
#include <numeric>

namespace igsp {
namespace {

// What one pair of scans says against its place, beyond what leaves and people do; as of a pair by itself.
constexpr double decades_a_share = 20, most_decades_a_pair = 2;

// A link that loops confirm is as strong as all of them.
double strength(const NetworkLink& link) {
  return vote_of(link.confidence) * static_cast<double>(1 + link.consistent_triangles);
}

bool are_the_same(std::size_t a, std::size_t b, std::size_t c, std::size_t d) {
  return (a == c && b == d) || (a == d && b == c);
}

// Scans are joined by the strongest links first, so that the last one that joins two of them is the weakest between
// them; the groups are what it joins.
class Groups {
 public:
  explicit Groups(const Network& network) : network_(network), group_(network.scans.size()) {
    for (std::size_t l = 0; l < network.links.size(); ++l) {
      if (is_used(network.links[l])) by_strength_.push_back(l);
    }
    std::ranges::stable_sort(by_strength_, std::greater(), [&](std::size_t l) { return strength(network.links[l]); });
  }

  /// Those of two scans, before the link that joins them.
  std::vector<std::size_t> before_joining(std::size_t a, std::size_t b) {
    std::iota(group_.begin(), group_.end(), 0);
    for (const std::size_t l : by_strength_) {
      const std::size_t from = group_[network_.links[l].source], to = group_[network_.links[l].target];
      if (are_the_same(from, to, group_[a], group_[b])) break;
      std::ranges::replace(group_, from, to);
    }
    return group_;
  }

 private:
  const Network& network_;
  std::vector<std::size_t> by_strength_;
  std::vector<std::size_t> group_;  // by scan
};

double against(const NetworkContradiction& pair) {
  return std::min(decades_a_share * (pair.violation - doubtful_violation), most_decades_a_pair) * std::numbers::ln10;
}

}  // namespace

std::vector<NetworkContradiction> contradictions_at(const Network& network, std::span<const ScanShape> shapes,
                                                    SeenSpace& space) {
  std::vector<NetworkContradiction> found;
  for (const std::vector<std::size_t>& component : network.components) {
    for (const std::size_t a : component) {
      for (const std::size_t b : component) {
        if (a >= b) continue;
        const Transformation a_from_b = network.scans[a].world_from_scan.inverse() * network.scans[b].world_from_scan;
        const double apart = (a_from_b * shapes[b].centre - shapes[a].centre).norm();
        if (apart > shapes[a].reach + shapes[b].reach) continue;
        const std::optional<SeenTogether> seen = space.at(b, a, a_from_b);
        const double violation = seen ? seen->free_space.violation() : 0;
        if (violation > doubtful_violation) found.push_back({{a, b}, violation});
      }
    }
  }
  std::ranges::stable_sort(found, std::greater(), &NetworkContradiction::violation);
  return found;
}

std::vector<std::size_t> contradicted_links(const Network& network,
                                            const std::vector<NetworkContradiction>& contradictions) {
  Groups groups(network);
  for (const NetworkContradiction& pair : contradictions) {
    const std::vector<std::size_t> group = groups.before_joining(pair.scans[0], pair.scans[1]);
    const auto is_between = [&](std::size_t a, std::size_t b) {
      return are_the_same(group[a], group[b], group[pair.scans[0]], group[pair.scans[1]]);
    };
    std::vector<std::size_t> links;
    double balance = 0;
    for (std::size_t l = 0; l < network.links.size(); ++l) {
      const NetworkLink& link = network.links[l];
      if (!is_used(link) || !is_between(link.source, link.target)) continue;
      links.push_back(l);
      balance += strength(link);
    }
    for (const NetworkContradiction& other : contradictions) {
      if (is_between(other.scans[0], other.scans[1])) balance -= against(other);
    }
    if (balance < 0) return links;
  }
  return {};
}

}  // namespace igsp
