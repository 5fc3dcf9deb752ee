#include "simulation/surface_net.hpp"

#include <cstdint>

namespace igsp::simulation {
namespace {

using Eigen::Vector3d;

constexpr int cell_edges[12][2] = {{0, 1}, {2, 3}, {4, 5}, {6, 7}, {0, 2}, {1, 3},
                                   {4, 6}, {5, 7}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};  // corner c: bits of x, y, z

/// Mean crossing of the cell's edges; false when the surface does not pass.
bool cell_vertex(const Field& field, double level, int i, int j, int k, Vector3d& vertex) {
  double above[8];
  for (int c = 0; c < 8; ++c) above[c] = field.value(field.index(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2))) - level;
  Vector3d sum = Vector3d::Zero();
  int crossings = 0;
  for (const auto& [a, b] : cell_edges) {
    if ((above[a] > 0.0) == (above[b] > 0.0)) continue;
    const double share = above[a] / (above[a] - above[b]);
    const Vector3d from(a & 1, a >> 1 & 1, a >> 2), to(b & 1, b >> 1 & 1, b >> 2);
    sum += from + share * (to - from);
    ++crossings;
  }
  if (crossings == 0) return false;
  const Vector3d corner = field.position(i, j, k), step = field.position(i + 1, j + 1, k + 1) - corner;
  vertex = corner + step.cwiseProduct(sum / crossings);
  return true;
}

}  // namespace

std::vector<Triangle> surface_net(const Field& field, double level) {
  const int cells = field.nodes() - 1;
  std::vector<Vector3d> vertices;
  std::vector<std::uint32_t> vertex_of(std::size_t(field.nodes()) * field.nodes() * field.nodes());
  std::vector<Triangle> triangles;
  const auto add_quad = [&](std::size_t a, std::size_t b, std::size_t c, std::size_t d) {
    const Vector3d& p = vertices[vertex_of[a]];
    const Vector3d& r = vertices[vertex_of[c]];
    triangles.push_back({p, vertices[vertex_of[b]] - p, r - p});
    triangles.push_back({p, r - p, vertices[vertex_of[d]] - p});
  };
  for (int k = 0; k < cells; ++k) {
    for (int j = 0; j < cells; ++j) {
      for (int i = 0; i < cells; ++i) {
        Vector3d vertex;
        const std::size_t self = field.index(i, j, k);
        if (!cell_vertex(field, level, i, j, k, vertex)) continue;
        vertex_of[self] = static_cast<std::uint32_t>(vertices.size());
        vertices.push_back(vertex);
        // The three edges from this cell's lowest corner; the cells around each were all visited by now.
        const std::size_t x = field.index(1, 0, 0), y = field.index(0, 1, 0), z = field.index(0, 0, 1);
        const bool inside = field.value(self) > level;
        const auto crosses = [&](std::size_t step) { return inside != (field.value(self + step) > level); };
        if (j > 0 && k > 0 && crosses(x)) add_quad(self, self - y, self - y - z, self - z);
        if (i > 0 && k > 0 && crosses(y)) add_quad(self, self - x, self - x - z, self - z);
        if (i > 0 && j > 0 && crosses(z)) add_quad(self, self - x, self - x - y, self - y);
      }
    }
  }
  return triangles;
}

}  // namespace igsp::simulation
