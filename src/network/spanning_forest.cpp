#include "network/spanning_forest.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <numeric>
#include <optional>

namespace igsp {
namespace {

// Two links that contradict each other are alike in weight where neither is this much heavier.
constexpr double outweighs = 1.5;

constexpr std::size_t max_votes = 20;  // between two components, the heaviest links

struct Proposal {
  std::size_t link;
  bool confirmed;  // by a loop
  double votes;
};

class Growth {
 public:
  Growth(const LinkGraph& graph, const std::vector<CycleSupport>& support, const WitnessQuestion& ask)
      : graph_(graph),
        support_(support),
        ask_(ask),
        component_(graph.centres.size()),
        component_from_scan_(graph.centres.size(), Transformation::Identity()),
        forest_links_(graph.centres.size()),
        forest_{{}, std::vector<bool>(graph.links.size())} {
    std::iota(component_.begin(), component_.end(), 0);
  }

  Forest run() {
    while (const std::optional<Proposal> best = best_proposal()) join(best->link);
    return std::move(forest_);
  }

 private:
  double vote(std::size_t link) const { return graph_.links[link].weight + support_[link].support; }

  std::optional<Proposal> best_proposal() {
    std::map<Edge, std::vector<std::size_t>> between;
    for (std::size_t l = 0; l < graph_.links.size(); ++l) {
      const auto [a, b] = std::minmax(component_[graph_.links[l].source], component_[graph_.links[l].target]);
      if (a != b) between[{a, b}].push_back(l);
    }
    std::vector<Proposal> proposals;
    for (auto& [components, links] : between) {
      if (const std::optional<Proposal> proposal = elect(links, components.first)) proposals.push_back(*proposal);
    }
    std::ranges::stable_sort(proposals, std::greater(),
                             [](const Proposal& p) { return std::pair(p.confirmed, p.votes); });
    const auto best = std::ranges::find_if(proposals, [&](const Proposal& p) { return p.confirmed || stands(p.link); });
    return best != proposals.end() ? std::optional(*best) : std::nullopt;
  }

  // In no loop, and too weak to join by itself.
  bool needs_witnesses(std::size_t link) const {
    return !graph_.links[link].may_stand_alone && support_[link].triangles == 0;
  }

  // Without a loop: by what the scans of both components say that no link connects.
  bool stands(std::size_t link) {
    const GraphLink& one = graph_.links[link];
    const std::optional<std::size_t> in_favour = witnesses_for(link);
    return in_favour && (one.may_stand_alone || (one.witnesses_needed && *in_favour >= *one.witnesses_needed));
  }

  // How many are in favour; nothing where one is against it.
  std::optional<std::size_t> witnesses_for(std::size_t link) {
    if (!ask_) return 0;
    const GraphLink& one = graph_.links[link];
    std::size_t in_favour = 0;
    for (std::size_t i = 0; i < component_.size(); ++i) {
      if (component_[i] != component_[one.source]) continue;
      for (std::size_t j = 0; j < component_.size(); ++j) {
        if (component_[j] != component_[one.target] || (i == one.source && j == one.target)) continue;
        const Witness witness = witness_of(link, i, j);
        if (witness == Witness::against || (witness == Witness::doubtful && !one.may_stand_alone)) {
          forest_.is_contradicted[link] = true;
          return {};
        }
        in_favour += witness == Witness::in_favour;
      }
    }
    return in_favour;
  }

  // Components only grow, so that what was said once stays true.
  Witness witness_of(std::size_t link, std::size_t i, std::size_t j) {
    const auto [known, is_new] = witnesses_.try_emplace({link, i, j}, Witness::none);
    if (is_new) {
      const GraphLink& one = graph_.links[link];
      known->second =
          ask_(i, j,
               component_from_scan_[j].inverse() * component_from_scan_[one.target] * one.target_from_source *
                   component_from_scan_[one.source].inverse() * component_from_scan_[i]);
    }
    return known->second;
  }

  // What the links between two components agree on.
  std::optional<Proposal> elect(std::vector<std::size_t>& links, std::size_t first_component) {
    std::erase_if(links, [&](std::size_t l) { return needs_witnesses(l) && forest_.is_contradicted[l]; });
    if (links.empty()) return {};
    std::stable_sort(links.begin(), links.end(), [&](auto a, auto b) { return vote(a) > vote(b); });
    if (links.size() > max_votes) links.resize(max_votes);
    const std::size_t n = links.size();
    std::vector<std::vector<bool>> agree(n, std::vector<bool>(n, true));
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < i; ++j) agree[i][j] = agree[j][i] = agrees(links[i], links[j], first_component);
    }
    std::vector<double> votes(n, 0);
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) votes[i] += agree[i][j] ? vote(links[j]) : 0;
    }
    const std::size_t winner = std::max_element(votes.begin(), votes.end()) - votes.begin();
    double rival = 0;
    std::size_t group = 0;
    bool is_doubtful = true;
    for (std::size_t i = 0; i < n; ++i) {
      if (agree[winner][i] && !graph_.links[links[i]].confirms_nothing) ++group;
      if (agree[winner][i] && !graph_.links[links[i]].is_doubtful) is_doubtful = false;
      if (!agree[winner][i]) rival = std::max(rival, votes[i]);
    }
    const bool confirmed = (group > 1 && !is_doubtful) || support_[links[winner]].triangles > 0;
    if (votes[winner] < outweighs * rival) {
      return hear_witnesses_against(links) ? elect(links, first_component) : std::nullopt;
    }
    const GraphLink& one = graph_.links[links[winner]];
    if (!confirmed && !one.may_stand_alone && !one.witnesses_needed) return {};
    return Proposal{links[winner], confirmed, votes[winner]};
  }

  // Of links that disagree. True where some of them are out of it.
  bool hear_witnesses_against(const std::vector<std::size_t>& links) {
    bool any = false;
    for (const std::size_t l : links) {
      if (needs_witnesses(l) && !witnesses_for(l)) any = true;
    }
    return any;
  }

  bool agrees(std::size_t a, std::size_t b, std::size_t first_component) const {
    const auto end_in = [&](std::size_t link, bool first) {
      const GraphLink& one = graph_.links[link];
      return (component_[one.source] == first_component) == first ? one.source : one.target;
    };
    std::vector<LinkStep> loop = {{a, component_[graph_.links[a].source] == first_component}};
    const auto append = [&](const std::vector<LinkStep>& path) { loop.insert(loop.end(), path.begin(), path.end()); };
    append(forest_path(graph_, forest_links_, end_in(a, false), end_in(b, false)));
    loop.push_back({b, component_[graph_.links[b].target] == first_component});
    append(forest_path(graph_, forest_links_, end_in(b, true), end_in(a, true)));
    return loop_error(graph_, loop) < max_loop_error;
  }

  void join(std::size_t link) {
    const GraphLink& one = graph_.links[link];
    forest_.links.push_back(link);
    forest_links_[one.source].push_back(link);
    forest_links_[one.target].push_back(link);
    const Transformation target_from_source =
        component_from_scan_[one.target] * one.target_from_source * component_from_scan_[one.source].inverse();
    const bool source_stays = component_[one.source] < component_[one.target];
    const std::size_t from = component_[source_stays ? one.target : one.source];
    const std::size_t to = component_[source_stays ? one.source : one.target];
    const Transformation to_from_joined = source_stays ? target_from_source.inverse() : target_from_source;
    for (std::size_t i = 0; i < component_.size(); ++i) {
      if (component_[i] != from) continue;
      component_[i] = to;
      component_from_scan_[i] = to_from_joined * component_from_scan_[i];
    }
  }

  using Edge = std::pair<std::size_t, std::size_t>;
  const LinkGraph& graph_;
  const std::vector<CycleSupport>& support_;
  const WitnessQuestion& ask_;
  std::vector<std::size_t> component_;
  std::vector<Transformation> component_from_scan_;
  std::map<std::array<std::size_t, 3>, Witness> witnesses_;  // by link and scans
  std::vector<std::vector<std::size_t>> forest_links_;
  Forest forest_;
};

}  // namespace

std::vector<std::vector<std::size_t>> links_by_scan(const LinkGraph& graph, std::span<const std::size_t> links) {
  std::vector<std::vector<std::size_t>> by_scan(graph.centres.size());
  for (const std::size_t link : links) {
    by_scan[graph.links[link].source].push_back(link);
    by_scan[graph.links[link].target].push_back(link);
  }
  return by_scan;
}

Forest spanning_forest(const LinkGraph& graph, const std::vector<CycleSupport>& support, const WitnessQuestion& ask) {
  return Growth(graph, support, ask).run();
}

std::vector<LinkStep> forest_path(const LinkGraph& graph, const std::vector<std::vector<std::size_t>>& forest_links,
                                  std::size_t from, std::size_t to) {
  // From the end, so that every scan met knows the step that leads on.
  std::map<std::size_t, LinkStep> onward;
  std::vector<std::size_t> reached = {to};
  for (std::size_t i = 0; i < reached.size() && !onward.contains(from) && from != to; ++i) {
    const std::size_t here = reached[i];
    for (const std::size_t link : forest_links[here]) {
      const bool forward = graph.links[link].target == here;
      const std::size_t before = forward ? graph.links[link].source : graph.links[link].target;
      if (before == to || !onward.try_emplace(before, LinkStep{link, forward}).second) continue;
      reached.push_back(before);
    }
  }
  std::vector<LinkStep> path;
  if (!onward.contains(from)) return path;
  for (std::size_t here = from; here != to;) {
    const LinkStep step = onward.at(here);
    path.push_back(step);
    here = step.forward ? graph.links[step.link].target : graph.links[step.link].source;
  }
  return path;
}

}  // namespace igsp
