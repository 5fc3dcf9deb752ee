#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "network/link_graph.hpp"

namespace igsp::network_testing {

/// A link that says exactly, up to a small error, what the true poses say.
inline GraphLink link_between(const std::vector<Transformation>& truth, std::size_t source, std::size_t target,
                              const Vector6& error = Vector6::Zero()) {
  GraphLink link;
  link.source = source;
  link.target = target;
  link.target_from_source = motion_about(Eigen::Vector3d::Zero(), error) * truth[target].inverse() * truth[source];
  Vector6 sigma;
  sigma << Eigen::Vector3d::Constant(0.005), Eigen::Vector3d::Constant(0.5);
  link.tolerance = sigma.cwiseAbs2().asDiagonal();
  link.information = link.tolerance.inverse();
  link.weight = 3;
  return link;
}

/// Random numbers that are the same with every standard library.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : engine_(seed) {}
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53;
  }
  std::size_t below(std::size_t n) { return engine_() % n; }
  Vector6 step(double rotation, double translation) {
    Vector6 step;
    for (int i = 0; i < 3; ++i) step[i] = uniform(-rotation, rotation);
    for (int i = 3; i < 6; ++i) step[i] = uniform(-translation, translation);
    return step;
  }
  Transformation pose(double extent) { return motion_about(Eigen::Vector3d::Zero(), step(1.7, extent)); }

 private:
  std::mt19937_64 engine_;
};

}  // namespace igsp::network_testing
