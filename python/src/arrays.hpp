#pragma once

#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/vector.h>

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <utility>
#include <vector>

#include "bindings.hpp"
#include "igsp/features.hpp"
#include "igsp/result.hpp"

namespace igsp::python {

// What comes in: the package igsp has made it contiguous float64 before; nothing is copied here.
using PointsIn = nb::ndarray<const double, nb::numpy, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;
using MatrixIn = nb::ndarray<const double, nb::numpy, nb::shape<4, 4>, nb::c_contig, nb::device::cpu>;
using VectorIn = nb::ndarray<const double, nb::numpy, nb::shape<3>, nb::c_contig, nb::device::cpu>;
using MatchesIn = nb::ndarray<const std::uint32_t, nb::numpy, nb::shape<-1, 2>, nb::c_contig, nb::device::cpu>;

PointView view_of(const PointsIn& points);
std::span<const KeypointMatch> view_of(const MatchesIn& matches);
Transformation transformation_of(const MatrixIn& matrix);
Eigen::Vector3d vector_of(const VectorIn& vector);
// Of each scan of a cloud its number of points and its viewpoint; nothing: none is known.
using PartsIn = std::vector<std::pair<std::size_t, std::optional<VectorIn>>>;
std::vector<ScanPart> parts_of(const PartsIn& parts);
Scan scan_of(const PointsIn& points, const PartsIn& parts);

// What goes out. Features come in again, where a changed index would be trusted: read-only views of them, ...
template <typename Scalar, nb::ssize_t... sizes>
using ReadOnly = nb::ndarray<const Scalar, nb::numpy, nb::shape<sizes...>>;
ReadOnly<double, -1, 3> read_only_view(const Points& points);
ReadOnly<double, 3> read_only_view(const Eigen::Vector3d& vector);
ReadOnly<double, -1, 3, 3> read_only_view(const std::vector<Eigen::Matrix3d>& frames);
ReadOnly<std::uint64_t, -1, bsc_words> read_only_view(const std::vector<Descriptor>& descriptors);
ReadOnly<float, -1> read_only_view(const std::vector<float>& values);
ReadOnly<std::uint32_t, -1> read_only_view(const std::vector<std::uint32_t>& values);

// ... views of what is only an answer (both for properties, which keep the object that owns the memory alive), ...
template <typename Scalar, nb::ssize_t... sizes>
using Array = nb::ndarray<Scalar, nb::numpy, nb::shape<sizes...>>;
Array<double, -1, 3> view(Points& points);
Array<double, 3> view(Eigen::Vector3d& vector);
Array<double, 6> view(Eigen::Matrix<double, 6, 1>& vector);
Array<double, 6, 6> view(Eigen::Matrix<double, 6, 6>& matrix);
Array<std::uint32_t, -1, 2> view(std::vector<KeypointMatch>& matches);

// ... and arrays that own their memory.
Array<double, 4, 4> array_of(const Transformation& transformation);
Array<double, 4, 4> array_of(const Eigen::Matrix4d& matrix);
Array<double, -1, 3> array_of(Points&& points);
std::optional<Array<double, 3>> array_of(const std::optional<Eigen::Vector3d>& vector);

}  // namespace igsp::python
