#include "network/settle.hpp"

#include "network/contradictions.hpp"
#include "network/decide.hpp"

namespace igsp {

Network settled_network(const Network& start, std::vector<NetworkLink>& links, std::span<const ScanShape> shapes,
                        SeenSpace& space, const NetworkOptions& options) {
  for (;;) {
    Network network = start;
    network.links = links;
    decide(network, shapes, &space, options);
    const std::vector<std::size_t> contradicted =
        contradicted_links(network, contradictions_at(network, shapes, space));
    if (contradicted.empty()) return network;
    for (const std::size_t l : contradicted) {
      links[l].state = LinkState::rejected;
      links[l].reason = "puts two groups of scans where scanners of the network saw through: " + links[l].reason;
    }
  }
}

}  // namespace igsp
