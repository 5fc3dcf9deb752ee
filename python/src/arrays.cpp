#include "arrays.hpp"

#include <memory>

namespace igsp::python {

static_assert(sizeof(Eigen::Vector3d) == 3 * sizeof(double) && alignof(Eigen::Vector3d) == alignof(double));
static_assert(sizeof(KeypointMatch) == 2 * sizeof(std::uint32_t) && alignof(KeypointMatch) == alignof(std::uint32_t));

PointView view_of(const PointsIn& points) {
  return {reinterpret_cast<const Eigen::Vector3d*>(points.data()), points.shape(0)};
}

std::span<const KeypointMatch> view_of(const MatchesIn& matches) {
  return {reinterpret_cast<const KeypointMatch*>(matches.data()), matches.shape(0)};
}

Transformation transformation_of(const MatrixIn& matrix) {
  Transformation transformation = Transformation::Identity();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) transformation.matrix()(row, column) = matrix(row, column);
  }
  return transformation;
}

Eigen::Vector3d vector_of(const VectorIn& vector) {
  return {vector(0), vector(1), vector(2)};
}

std::vector<ScanPart> parts_of(const PartsIn& parts) {
  std::vector<ScanPart> all;
  for (const auto& [points, viewpoint] : parts) {
    all.push_back({points, {}});
    if (viewpoint) all.back().viewpoint = vector_of(*viewpoint);
  }
  return all;
}

Scan scan_of(const PointsIn& points, const PartsIn& parts) {
  Scan scan(view_of(points));
  scan.parts = parts_of(parts);
  return scan;
}

ReadOnly<double, -1, 3> read_only_view(const Points& points) {
  return {reinterpret_cast<const double*>(points.data()), {points.size(), 3}};
}

ReadOnly<double, 3> read_only_view(const Eigen::Vector3d& vector) {
  return {vector.data(), {3}};
}

ReadOnly<double, -1, 3, 3> read_only_view(const std::vector<Eigen::Matrix3d>& frames) {
  return {reinterpret_cast<const double*>(frames.data()), {frames.size(), 3, 3}, {}, {9, 1, 3}};  // Eigen: by columns
}

ReadOnly<std::uint64_t, -1, bsc_words> read_only_view(const std::vector<Descriptor>& descriptors) {
  return {reinterpret_cast<const std::uint64_t*>(descriptors.data()), {descriptors.size(), bsc_words}};
}

ReadOnly<float, -1> read_only_view(const std::vector<float>& values) {
  return {values.data(), {values.size()}};
}

ReadOnly<std::uint32_t, -1> read_only_view(const std::vector<std::uint32_t>& values) {
  return {values.data(), {values.size()}};
}

Array<double, -1, 3> view(Points& points) {
  return {reinterpret_cast<double*>(points.data()), {points.size(), 3}};
}

Array<double, 3> view(Eigen::Vector3d& vector) {
  return {vector.data(), {3}};
}

Array<double, 6> view(Eigen::Matrix<double, 6, 1>& vector) {
  return {vector.data(), {6}};
}

Array<double, 6, 6> view(Eigen::Matrix<double, 6, 6>& matrix) {
  return {matrix.data(), {6, 6}, {}, {1, 6}};
}

Array<std::uint32_t, -1, 2> view(std::vector<KeypointMatch>& matches) {
  return {reinterpret_cast<std::uint32_t*>(matches.data()), {matches.size(), 2}};
}

Array<double, 4, 4> array_of(const Transformation& transformation) {
  return array_of(transformation.matrix());
}

Array<double, 4, 4> array_of(const Eigen::Matrix4d& matrix) {
  using RowMajor = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;
  auto kept = std::make_unique<RowMajor>(matrix);
  double* data = kept->data();
  nb::capsule owner(kept.release(), [](void* pointer) noexcept { delete static_cast<RowMajor*>(pointer); });
  return {data, {4, 4}, owner};
}

Array<double, -1, 3> array_of(Points&& points) {
  auto kept = std::make_unique<Points>(std::move(points));
  double* data = reinterpret_cast<double*>(kept->data());
  const std::size_t size = kept->size();
  nb::capsule owner(kept.release(), [](void* pointer) noexcept { delete static_cast<Points*>(pointer); });
  return {data, {size, 3}, owner};
}

std::optional<Array<double, 3>> array_of(const std::optional<Eigen::Vector3d>& vector) {
  if (!vector) return std::nullopt;
  auto kept = std::make_unique<Eigen::Vector3d>(*vector);
  double* data = kept->data();
  nb::capsule owner(kept.release(), [](void* pointer) noexcept { delete static_cast<Eigen::Vector3d*>(pointer); });
  return Array<double, 3>{data, {3}, owner};
}

}  // namespace igsp::python
