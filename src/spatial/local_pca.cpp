#include "spatial/local_pca.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "core/multiversion.hpp"
#include "core/parallel.hpp"

namespace igsp {
namespace {

// Points around one cell, relative to the cell's centre.
struct Neighbourhood {
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
  }
};

struct Moments {
  float n, x, y, z, xx, xy, xz, yy, yz, zz;
};

// Moments of the points within `radius` of the query, about the query (which keeps floats exact enough).
IGSP_MULTIVERSION Moments sphere_moments(const float* __restrict px, const float* __restrict py,
                                         const float* __restrict pz, std::size_t size, float qx, float qy, float qz,
                                         float squared_radius) {
  float n = 0, x = 0, y = 0, z = 0, xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
#pragma omp simd reduction(+ : n, x, y, z, xx, xy, xz, yy, yz, zz)
  for (std::size_t i = 0; i < size; ++i) {
    const float dx = px[i] - qx, dy = py[i] - qy, dz = pz[i] - qz;
    const float inside = dx * dx + dy * dy + dz * dz <= squared_radius ? 1.0f : 0.0f;
    const float wx = inside * dx, wy = inside * dy, wz = inside * dz;
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
  return {n, x, y, z, xx, xy, xz, yy, yz, zz};
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
  Moments m{};
  grid.visit_sphere(place, static_cast<float>(radius), [&](std::uint32_t i, float) {
    const float dx = grid.x[i] - place.x(), dy = grid.y[i] - place.y(), dz = grid.z[i] - place.z();
    m.n += 1;
    m.x += dx, m.y += dy, m.z += dz;
    m.xx += dx * dx, m.xy += dx * dy, m.xz += dx * dz, m.yy += dy * dy, m.yz += dy * dz, m.zz += dz * dz;
  });
  return m.n < 3 ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d(principal_axes(m).eigenvectors().col(0));
}

}  // namespace igsp
