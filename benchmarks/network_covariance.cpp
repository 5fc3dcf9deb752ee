// Are the covariances of a network's poses what they say? Simulated stations, each drawn many times with another
// sampling pattern and other noise of the scanner, refined jointly from the true poses over all pairs that overlap; the
// squared error of every pose, normalised by its covariance, against chi-square with 6 degrees of freedom.
// docs/covariance.md
//
// usage: igsp_network_covariance [SCENE [SEEDS [DRAWS [STATIONS [POINTS]]]]]
#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "igsp/features.hpp"
#include "igsp/simulation.hpp"
#include "network/components.hpp"
#include "network/joint_refinement.hpp"
#include "network/small_motion.hpp"
#include "simulation/overlap.hpp"
#include "simulation/random.hpp"
#include "spatial/scale.hpp"

namespace {

using namespace igsp;

constexpr double chi_square_50 = 5.348, chi_square_95 = 12.592;
constexpr int dense = 5;             // times as many points as are drawn, so that two draws share few
constexpr double min_overlap = 0.3;  // of the pairs that become links

double noise_of(const std::string& scene) {
  return scene == "park" ? 0.01 : 0.003;  // standard deviation along the ray [m], as in covariance.py
}

// Another sampling pattern of the surface, and noise along the ray from the scanner in the origin.
Points drawn(const Points& points, std::size_t count, double noise, simulation::Random& random) {
  Points result;
  const double share = static_cast<double>(count) / static_cast<double>(points.size());
  for (const Eigen::Vector3d& point : points) {
    if (!random.chance(share)) continue;
    const double along = noise * random.normal();
    result.push_back(point + along * point.normalized());
  }
  return result;
}

// All poses true, as seen from the first; all pairs that overlap enough a link.
Network true_network(const std::vector<SimulatedScan>& site, double voxel_size) {
  Network network;
  network.voxel_size = voxel_size;
  for (std::size_t i = 0; i < site.size(); ++i) {
    NetworkScan& scan = network.scans.emplace_back();
    scan.world_from_scan = site[0].world_from_scanner.inverse() * site[i].world_from_scanner;
    for (std::size_t j = 0; j < i; ++j) {
      const double overlap = std::min(simulation::overlap_of(site[i], site[j], voxel_size),
                                      simulation::overlap_of(site[j], site[i], voxel_size));
      if (overlap < min_overlap) continue;
      NetworkLink& link = network.links.emplace_back();
      link.source = i;
      link.target = j;
      link.state = LinkState::used;
    }
  }
  std::vector<Edge> edges;
  for (const NetworkLink& link : network.links) edges.emplace_back(link.source, link.target);
  network.components = connected_components(site.size(), edges);
  for (std::size_t c = 0; c < network.components.size(); ++c) {
    for (const std::size_t i : network.components[c]) network.scans[i].component = c;
  }
  return network;
}

// Normalised, of every pose that is not the world.
std::vector<double> squares_of(const Network& network, const std::vector<SimulatedScan>& site) {
  std::vector<double> squares;
  for (std::size_t i = 1; i < site.size(); ++i) {
    const NetworkScan& scan = network.scans[i];
    if (scan.component != network.scans[0].component) continue;
    const Transformation truth = site[0].world_from_scanner.inverse() * site[i].world_from_scanner;
    const Vector6 error = step_about(scan.centre, scan.world_from_scan * truth.inverse());
    const Vector6 unit = scan.covariance.diagonal().cwiseSqrt().cwiseInverse();  // radians beside metres
    const Matrix6 correlation = unit.asDiagonal() * scan.covariance * unit.asDiagonal();
    const Vector6 scaled = unit.cwiseProduct(error);
    squares.push_back(scaled.dot(correlation.ldlt().solve(scaled)));
  }
  return squares;
}

std::vector<double> squares_of_site(const std::string& scene, std::uint64_t seed, int draws, int stations, int points) {
  SimulationOptions simulated;
  simulated.stations = stations;
  simulated.points = dense * points;
  simulated.noise = 0.0;
  simulated.seed = seed;
  const std::vector<SimulatedScan> site = simulate(scene, simulated);
  Options options;
  options.threads = 1;
  options.scale.voxel_size = choose_voxel_size(site[0].points, site[1].points, options.scale);
  NetworkOptions network_options;
  network_options.pair = options;
  const Network truth = true_network(site, options.scale.voxel_size);
  const std::vector<Eigen::Vector3d> scanners(site.size(), Eigen::Vector3d::Zero());
  simulation::Random random(seed, 1);
  std::vector<double> squares;
  for (int d = 0; d < draws; ++d) {
    std::vector<Features> features;
    for (const SimulatedScan& scan : site) {
      features.push_back(
          extract_features(drawn(scan.points, static_cast<std::size_t>(points), noise_of(scene), random), options));
    }
    FeatureShelf shelf(
        site.size(), [&](std::size_t i) { return features[i]; }, 0);
    Network network = truth;
    refine_jointly(network, shelf, scanners, network_options, std::vector<bool>(truth.components.size()));
    const std::vector<double> some = squares_of(network, site);
    squares.insert(squares.end(), some.begin(), some.end());
  }
  std::fprintf(stderr, "%s %d: %zu links, %.0f %% inside\n", scene.c_str(), static_cast<int>(seed), truth.links.size(),
               100.0 * static_cast<double>(std::ranges::count_if(squares, [](double s) { return s < chi_square_95; })) /
                   static_cast<double>(std::max<std::size_t>(1, squares.size())));
  return squares;
}

}  // namespace

int main(int count, char** arguments) {
  const auto number = [&](int i, int otherwise) { return count > i ? std::atoi(arguments[i]) : otherwise; };
  const std::string scene = count > 1 ? arguments[1] : "park";
  const int seeds = number(2, 10), draws = number(3, 10), stations = number(4, 5), points = number(5, 40000);
  std::vector<double> squares;
  for (int seed = 1; seed <= seeds; ++seed) {
    const std::vector<double> some = squares_of_site(scene, static_cast<std::uint64_t>(seed), draws, stations, points);
    squares.insert(squares.end(), some.begin(), some.end());
  }
  std::ranges::sort(squares);
  if (squares.size() < 20) return std::fprintf(stderr, "%zu poses: too few to say\n", squares.size()), 1;
  const auto quantile = [&](double q) { return squares[static_cast<std::size_t>(q * (squares.size() - 1))]; };
  const auto inside = std::ranges::lower_bound(squares, chi_square_95) - squares.begin();
  fmt::print("| {} | {} | {:.2f} | {:.0f} % | {:.2f} |\n", scene, squares.size(), quantile(0.5) / chi_square_50,
             100.0 * static_cast<double>(inside) / static_cast<double>(squares.size()), quantile(0.95) / chi_square_95);
}
