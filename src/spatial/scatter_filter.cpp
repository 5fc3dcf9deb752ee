#include "spatial/scatter_filter.hpp"

#include <algorithm>
#include <cmath>

#include "spatial/cell_hash.hpp"
#include "spatial/hull.hpp"

namespace igsp {
namespace {

constexpr int slot_bits = 18;
constexpr double blocks_across = 16;   // along the diagonal
constexpr double min_layers = 4;       // of blocks, across the thinnest side
constexpr double thinnest = 1.0 / 16;  // side, of the diagonal: a flat surface alone looks like dense noise
constexpr double margin = 0.1;         // of the hull's width: what it is made of, walls mostly, does not count
constexpr std::size_t min_blocks = 20;
constexpr double emptiest = 0.25;        // of the blocks: surfaces leave that many empty ...
constexpr double below_the_mean = 0.67;  // ... and this quantile of a Poisson distribution lies so many sigmas below
constexpr double sigmas = 3.0;           // of the noise's Poisson distribution
constexpr double min_kept = 0.6;         // what is most of the cloud is no noise
constexpr double max_kept = 0.98;  // less noise does no harm, and the lone far points of a clean scan are worth keeping

// The number of points in each block inside the hull.
std::vector<std::uint32_t> counts_inside(PointView cloud, const Bounds& bounds, double block_size) {
  const Eigen::Array3i blocks = ((bounds.max - bounds.min) / block_size).array().floor().cast<int>() + 1;
  std::vector<std::uint32_t> counts(static_cast<std::size_t>(blocks.prod()), 0);
  for (const Eigen::Vector3d& point : cloud) {
    const Eigen::Array3i block = ((point - bounds.min) / block_size).array().cast<int>().min(blocks - 1);
    ++counts[(block.z() * blocks.y() + block.y()) * blocks.x() + block.x()];
  }
  const Hull hull(cloud, bounds);
  std::vector<std::uint32_t> inside;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const auto row = static_cast<int>(i) / blocks.x();
    const Eigen::Vector3i block(static_cast<int>(i) % blocks.x(), row % blocks.y(), row / blocks.y());
    const Eigen::Vector3d centre = bounds.min + block_size * (block.cast<double>().array() + 0.5).matrix();
    if (hull.holds(centre, margin)) inside.push_back(counts[i]);
  }
  return inside;
}

}  // namespace

double ScatteredNoise::points_in(double other_side) const {
  // Of a cloud without extent beside its partner the ratio is infinite, and 0 times that is no number.
  return points == 0 ? 0 : points * std::pow(other_side / side, 3);
}

ScatteredNoise scattered_noise(PointView cloud, const Bounds& bounds) {
  const double diagonal = bounds.diagonal(), thin_side = (bounds.max - bounds.min).minCoeff();
  if (!(thin_side > thinnest * diagonal)) return {};
  const double block_size = std::min(diagonal / blocks_across, thin_side / min_layers);
  std::vector<std::uint32_t> counts = counts_inside(cloud, bounds, block_size);
  if (counts.size() < min_blocks) return {};
  const auto quantile = counts.begin() + static_cast<std::ptrdiff_t>(emptiest * static_cast<double>(counts.size()));
  std::ranges::nth_element(counts, quantile);
  return {*quantile + below_the_mean * std::sqrt(*quantile), block_size};
}

ScatterFilter::ScatterFilter(PointView cloud, const Bounds& bounds, const ScatteredNoise& noise, double cell_size)
    : corner_(bounds.min), inverse_cell_size_(1.0 / cell_size) {
  const double expected = noise.points_in(cell_size);
  least_count_ = 1 + static_cast<std::uint32_t>(std::min(expected + sigmas * std::sqrt(expected), 1e9));
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
