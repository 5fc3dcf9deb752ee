#include "network/likely_pairs.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <set>

#include "network/decide.hpp"
#include "network/likeness.hpp"
#include "network/pairs.hpp"
#include "network/shared_space.hpp"

namespace igsp {
namespace {

// With so many confirmed links a scan lies as well as with all of them (docs/network.md).
constexpr std::size_t enough_links = 4;

// Two scans of one component whose points share this much of their space should register.
constexpr double likely_overlap = 0.3;

// Tries outside of its component that led nowhere, after which a scan asks for no more: one that lies in no frame yet,
// one that has not enough links, one that has.
constexpr std::size_t patience_alone = 8, patience_unsettled = 5, patience_settled = 2;

// For a link in no loop: pairs that would close one, of scans that share at least this much, so many at most.
constexpr double confirming_overlap = 0.05;
constexpr std::size_t tries_to_confirm = 3;

constexpr double expected_tries = 6;  // a scan; only for the progress

// As all_pairs has it.
ScanPair pair_of(std::size_t a, std::size_t b) {
  return {std::max(a, b), std::min(a, b)};
}

class PairSearch {
 public:
  PairSearch(const Network& network, FeatureShelf& features, std::span<const ScanShape> shapes,
             const NetworkOptions& options)
      : start_(network), shapes_(shapes), options_(options), n_(network.scans.size()), space_(features) {
    std::vector<std::vector<Descriptor>> voters;
    for (std::size_t i = 0; i < n_; ++i) {
      const auto scan = network.scans[i].problem.empty() ? features.get(i) : std::make_shared<const Features>();
      voters.push_back(voters_of(*scan));
      spaces_.emplace_back(*scan);
    }
    likeness_ = likeness_of_scans(voters, options.pair.degrees_of_freedom, options.pair.threads);
  }

  /// Those to be tried next, given the links so far. Empty: there are none.
  std::vector<ScanPair> next(const std::vector<NetworkLink>& links) {
    take_stock(links);
    std::set<ScanPair> chosen;
    for (std::size_t i = 0; i < n_; ++i) {
      if (!start_.scans[i].problem.empty()) continue;
      for (const std::size_t j : inside(i)) chosen.insert(pair_of(i, j));
      if (const std::optional<std::size_t> j = outside(i)) chosen.insert(pair_of(i, *j));
    }
    for (const NetworkLink& link : now_.links) {
      if (link.state != LinkState::unconfirmed) continue;
      if (const std::optional<ScanPair> pair = confirming(link)) chosen.insert(*pair);
    }
    return {chosen.begin(), chosen.end()};
  }

 private:
  void take_stock(const std::vector<NetworkLink>& links) {
    now_ = start_;
    now_.links = links;
    decide(now_, shapes_, &space_, options_);
    confirmed_.assign(n_, 0);
    in_vain_.assign(n_, 0);
    tried_.clear();
    linked_.assign(n_, {});
    for (const NetworkLink& link : now_.links) {
      if (is_used(link)) {
        linked_[link.source].push_back(link.target);
        linked_[link.target].push_back(link.source);
      }
      tried_.emplace(link.source, link.target);
      const bool apart = now_.scans[link.source].component != now_.scans[link.target].component;
      for (const std::size_t end : {link.source, link.target}) {
        confirmed_[end] += link.state == LinkState::used;
        in_vain_[end] += apart;
      }
    }
  }

  bool may_try(std::size_t i, std::size_t j) const {
    return i != j && start_.scans[j].problem.empty() && !tried_.contains(pair_of(i, j));
  }

  double overlap_now(std::size_t i, std::size_t j) const {
    return shared_space(spaces_[i], now_.scans[i].world_from_scan, spaces_[j], now_.scans[j].world_from_scan);
  }

  // The pair that should overlap most of those that would close a loop of three with a link in none.
  std::optional<ScanPair> confirming(const NetworkLink& link) const {
    std::set<ScanPair> candidates;
    for (const std::size_t i : linked_[link.source]) {
      if (i != link.target) candidates.insert(pair_of(i, link.target));
    }
    for (const std::size_t i : linked_[link.target]) {
      if (i != link.source) candidates.insert(pair_of(i, link.source));
    }
    std::size_t tried = 0;
    std::optional<ScanPair> best;
    double most = confirming_overlap;
    for (const ScanPair& pair : candidates) {
      if (tried_.contains(pair)) {
        ++tried;
      } else if (const double overlap = overlap_now(pair.first, pair.second); overlap > most) {
        best = pair;
        most = overlap;
      }
    }
    return tried < tries_to_confirm ? best : std::nullopt;
  }

  // Of its component: those that should overlap most.
  std::vector<std::size_t> inside(std::size_t i) const {
    if (confirmed_[i] >= enough_links) return {};
    std::vector<std::pair<double, std::size_t>> candidates;
    for (const std::size_t j : now_.components[now_.scans[i].component]) {
      if (!may_try(i, j)) continue;
      const double overlap = overlap_now(i, j);
      if (overlap >= likely_overlap) candidates.emplace_back(-overlap, j);
    }
    std::ranges::sort(candidates);
    std::vector<std::size_t> best;
    for (const auto& [overlap, j] : candidates) {
      if (best.size() + confirmed_[i] < enough_links) best.push_back(j);
    }
    return best;
  }

  // The one that is most like it.
  std::optional<std::size_t> outside(std::size_t i) const {
    const std::size_t component = now_.scans[i].component;
    const std::size_t patience = now_.components[component].size() == 1 ? patience_alone
                                 : confirmed_[i] < enough_links         ? patience_unsettled
                                                                        : patience_settled;
    if (in_vain_[i] >= patience) return {};
    std::optional<std::size_t> best;
    for (std::size_t j = 0; j < n_; ++j) {
      if (now_.scans[j].component == component || !may_try(i, j)) continue;
      if (!best || likeness_[i * n_ + j] > likeness_[i * n_ + *best]) best = j;
    }
    return best;
  }

  const Network& start_;
  std::span<const ScanShape> shapes_;
  const NetworkOptions& options_;
  std::size_t n_;
  SeenSpace space_;
  std::vector<double> likeness_;
  std::vector<Space> spaces_;
  Network now_;
  std::set<ScanPair> tried_;
  std::vector<std::vector<std::size_t>> linked_;  // scans by scan, of the links that are used
  std::vector<std::size_t> confirmed_, in_vain_;  // links of a scan
};

}  // namespace

std::vector<NetworkLink> register_likely_pairs(const Network& network, FeatureShelf& features,
                                               std::span<const ScanShape> shapes, const NetworkOptions& options,
                                               const PairStore& store, const std::function<void(double)>& report) {
  PairSearch search(network, features, shapes, options);
  std::vector<NetworkLink> links;
  const double expected = expected_tries * static_cast<double>(network.scans.size());
  const auto fraction = [&](double tried) { return std::min(0.99, tried / expected); };
  for (std::vector<ScanPair> pairs = search.next(links); !pairs.empty(); pairs = search.next(links)) {
    const auto before = static_cast<double>(links.size()), size = static_cast<double>(pairs.size());
    const std::vector<NetworkLink> round = register_pairs(pairs, features, options.pair, store,
                                                          [&](double done) { report(fraction(before + done * size)); });
    links.insert(links.end(), round.begin(), round.end());
  }
  std::ranges::sort(links, {}, [](const NetworkLink& link) { return ScanPair(link.source, link.target); });
  return links;
}

}  // namespace igsp
