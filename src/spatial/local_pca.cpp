#include "spatial/local_pca.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cstring>

#include "core/multiversion.hpp"
#include "core/parallel.hpp"

namespace igsp {
namespace {

// Sums are kept in eight lanes, whatever the width of the machine's vectors, so that every processor adds in the same
// order and rounds alike. Generic vectors, which the compiler lowers to what there is.
constexpr std::size_t lanes = 8;
using Lanes = float __attribute__((vector_size(lanes * sizeof(float))));

// Points around one cell, relative to the cell's centre; filled up to whole lanes with points that no sphere reaches
// and whose squares are finite.
struct Neighbourhood {
  static constexpr float far_away = 1e18f;
  std::vector<float> x, y, z;
  void gather(const PointGrid& grid, const Eigen::Vector3f& centre, float reach) {
    x.clear(), y.clear(), z.clear();
    grid.visit_runs(centre, reach, [&](std::uint32_t begin, std::uint32_t end) {
      for (std::uint32_t i = begin; i < end; ++i) {
        x.push_back(grid.x[i] - centre.x());
        y.push_back(grid.y[i] - centre.y());
        z.push_back(grid.z[i] - centre.z());
      }
    });
    const std::size_t whole = (x.size() + lanes - 1) / lanes * lanes;
    x.resize(whole, far_away), y.resize(whole, far_away), z.resize(whole, far_away);
  }
};

struct Moments {
  float n, x, y, z, xx, xy, xz, yy, yz, zz;
};

inline __attribute__((always_inline)) void load(const float* from, Lanes& to) {
  std::memcpy(&to, from, sizeof to);
}

inline __attribute__((always_inline)) float sum_of(const Lanes& v) {
  return ((v[0] + v[4]) + (v[2] + v[6])) + ((v[1] + v[5]) + (v[3] + v[7]));
}

// Moments of the points within `radius` of the query, about the query (which keeps floats exact enough). `size` is a
// multiple of `lanes`.
IGSP_MULTIVERSION Moments sphere_moments(const float* px, const float* py, const float* pz, std::size_t size, float qx,
                                         float qy, float qz, float squared_radius) {
  Lanes n{}, x{}, y{}, z{}, xx{}, xy{}, xz{}, yy{}, yz{}, zz{};
  for (std::size_t i = 0; i < size; i += lanes) {
    Lanes dx, dy, dz;
    load(px + i, dx), load(py + i, dy), load(pz + i, dz);
    dx -= qx, dy -= qy, dz -= qz;
    const Lanes inside = dx * dx + dy * dy + dz * dz <= squared_radius ? Lanes{} + 1.0f : Lanes{};
    const Lanes wx = inside * dx, wy = inside * dy, wz = inside * dz;
    n += inside;
    x += wx;
    y += wy;
    z += wz;
    xx += wx * dx;
    xy += wx * dy;
    xz += wx * dz;
    yy += wy * dy;
    yz += wy * dz;
    zz += wz * dz;
  }
  return {sum_of(n),  sum_of(x),  sum_of(y),  sum_of(z),  sum_of(xx),
          sum_of(xy), sum_of(xz), sum_of(yy), sum_of(yz), sum_of(zz)};
}

Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> principal_axes(const Moments& m) {
  const double n = m.n;
  const Eigen::Vector3d mean(m.x / n, m.y / n, m.z / n);
  Eigen::Matrix3d covariance;
  covariance << m.xx, m.xy, m.xz, m.xy, m.yy, m.yz, m.xz, m.yz, m.zz;
  covariance = covariance / n - mean * mean.transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(covariance);
  return solver;
}

void analyse(const Moments& m, std::uint32_t point, LocalPca& pca) {
  const auto solver = principal_axes(m);
  const Eigen::Vector3d l = solver.eigenvalues().cwiseMax(0.0);  // ascending
  const double sum = l.sum();
  pca.neighbours[point] = static_cast<std::uint32_t>(m.n);
  pca.curvature[point] = sum > 0 ? static_cast<float>(l[0] / sum) : 0.0f;
  pca.ratio21[point] = l[2] > 0 ? static_cast<float>(l[1] / l[2]) : 0.0f;
  pca.ratio32[point] = l[1] > 0 ? static_cast<float>(l[0] / l[1]) : 0.0f;
  pca.normals[point] = solver.eigenvectors().col(0).cast<float>();
}

// Fewer points, or points along a line, have no normal: so it is within the lines of a scanner that has few of them.
constexpr int most_doublings = 3;
constexpr float fewest_of_a_surface = 5;
constexpr double most_of_a_line = 0.05;  // l2 / l1

Moments moments_around(const PointGrid& grid, const Eigen::Vector3f& place, float radius) {
  Moments m{};
  grid.visit_sphere(place, radius, [&](std::uint32_t i, float) {
    const float dx = grid.x[i] - place.x(), dy = grid.y[i] - place.y(), dz = grid.z[i] - place.z();
    m.n += 1;
    m.x += dx, m.y += dy, m.z += dz;
    m.xx += dx * dx, m.xy += dx * dy, m.xz += dx * dz, m.yy += dy * dy, m.yz += dy * dz, m.zz += dz * dz;
  });
  return m;
}

}  // namespace

LocalPca local_pca(const PointGrid& grid, double radius, int threads, const std::function<void(double)>& tick) {
  const std::size_t size = grid.size();
  LocalPca pca;
  pca.curvature.resize(size);
  pca.ratio21.resize(size);
  pca.ratio32.resize(size);
  pca.neighbours.resize(size);
  pca.normals.resize(size);

  // From a cell's centre, this far reaches the sphere of every point of the cell (half a diagonal away at most).
  const float reach = static_cast<float>(radius) + 0.8661f * grid.cell_size;
  const float squared_radius = static_cast<float>(radius * radius);
  const std::size_t rows = static_cast<std::size_t>(grid.cells[1]) * grid.cells[2];
  const auto analyse_rows = [&](std::size_t row_begin, std::size_t row_end) {
    Neighbourhood around;
    for (std::size_t row = row_begin; row < row_end; ++row) {
      const int cy = static_cast<int>(row % grid.cells[1]), cz = static_cast<int>(row / grid.cells[1]);
      for (int cx = 0; cx < grid.cells[0]; ++cx) {
        const std::size_t cell = grid.cell_number(cx, cy, cz);
        const std::uint32_t begin = grid.start[cell], end = grid.start[cell + 1];
        if (begin == end) continue;
        const Eigen::Vector3f centre =
            grid.origin + grid.cell_size * (Eigen::Vector3f(cx, cy, cz) + Eigen::Vector3f::Constant(0.5f));
        around.gather(grid, centre, reach);
        for (std::uint32_t i = begin; i < end; ++i) {
          analyse(
              sphere_moments(around.x.data(), around.y.data(), around.z.data(), around.x.size(), grid.x[i] - centre.x(),
                             grid.y[i] - centre.y(), grid.z[i] - centre.z(), squared_radius),
              grid.index[i], pca);
        }
      }
    }
  };
  const std::size_t slice = std::max<std::size_t>(64, rows / 50);
  parallel_slices(rows, threads, 16, slice, analyse_rows, [&](double share) {
    if (tick) tick(share);
  });
  return pca;
}

Eigen::Vector3d local_normal(const PointGrid& grid, const Eigen::Vector3f& place, double radius) {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  for (int k = 0; k <= most_doublings; ++k, radius *= 2) {
    const Moments m = moments_around(grid, place, static_cast<float>(radius));
    if (m.n < 3) continue;
    const auto axes = principal_axes(m);
    normal = axes.eigenvectors().col(0);
    if (m.n >= fewest_of_a_surface && axes.eigenvalues()[1] > most_of_a_line * axes.eigenvalues()[2]) break;
  }
  return normal;
}

}  // namespace igsp
