#include "spatial/scatter_filter.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "spatial/cell_hash.hpp"

namespace igsp {
namespace {

constexpr int slot_bits = 18;
constexpr std::array<double, 3> cells_across{16, 64, 256};  // along the diagonal
constexpr double min_layers = 4;      // across the thinnest side: in a flat box a surface alone looks as dense as noise
constexpr double max_occupied = 0.8;  // more says too little about what is empty
constexpr double sigmas = 3.0;        // of the noise's Poisson distribution
constexpr double min_kept = 0.6;      // what is most of the cloud is no noise
constexpr double max_kept = 0.98;  // less noise does no harm, and the lone far points of a clean scan are worth keeping

struct Occupancy {
  double occupied, cells;
};

Occupancy occupancy(PointView cloud, const Bounds& bounds, double cell_size) {
  std::vector<std::uint8_t> seen(std::size_t{1} << slot_bits, 0);
  const double inverse_cell_size = 1.0 / cell_size;
  for (const Eigen::Vector3d& point : cloud) {
    seen[cell_hash((point - bounds.min) * inverse_cell_size) >> (64 - slot_bits)] = 1;
  }
  const auto occupied = std::count(seen.begin(), seen.end(), 1);
  return {static_cast<double>(occupied), (((bounds.max - bounds.min) / cell_size).array().floor() + 1).prod()};
}

}  // namespace

double scatter_density(PointView cloud, const Bounds& bounds) {
  double density = std::numeric_limits<double>::infinity();
  for (const double across : cells_across) {
    const double cell_size = bounds.diagonal() / across;
    if ((bounds.max - bounds.min).minCoeff() < min_layers * cell_size) continue;
    const Occupancy found = occupancy(cloud, bounds, cell_size);
    if (found.occupied > max_occupied * found.cells) continue;
    // Of cells with a mean of n points the share exp(-n) stays empty.
    const double mean = -std::log(1 - found.occupied / found.cells);
    density = std::min(density, mean / std::pow(cell_size, 3));
  }
  return std::isfinite(density) ? density : 0.0;
}

ScatterFilter::ScatterFilter(PointView cloud, const Bounds& bounds, double density, double cell_size)
    : corner_(bounds.min), inverse_cell_size_(1.0 / cell_size) {
  const double noise = density * std::pow(cell_size, 3);
  least_count_ = 1 + static_cast<std::uint32_t>(std::min(noise + sigmas * std::sqrt(noise), 1e9));
  if (keeps_all()) return;
  counts_.assign(std::size_t{1} << slot_bits, 0);
  for (const Eigen::Vector3d& point : cloud) ++counts_[slot_of(point)];
  std::size_t kept = 0;
  for (const std::uint32_t count : counts_) kept += count >= least_count_ ? count : 0;
  const double share = static_cast<double>(kept) / static_cast<double>(cloud.size());
  if (share < min_kept || share > max_kept) least_count_ = 1;
}

std::size_t ScatterFilter::slot_of(const Eigen::Vector3d& point) const {
  return cell_hash((point - corner_) * inverse_cell_size_) >> (64 - slot_bits);
}

Points without_scatter(PointView cloud, const ScatterFilter& filter) {
  Points kept;
  kept.reserve(cloud.size());
  for (const Eigen::Vector3d& point : cloud) {
    if (filter.keeps(point)) kept.push_back(point);
  }
  return kept;
}

}  // namespace igsp
