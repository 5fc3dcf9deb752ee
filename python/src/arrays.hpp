#pragma once

#include <nanobind/ndarray.h>

#include <cstdint>
#include <initializer_list>
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

// What goes out: read-only views of an object that is a property's `self`, which nanobind then keeps alive ...
using PointsOut = nb::ndarray<const double, nb::numpy, nb::shape<-1, 3>>;
using VectorOut = nb::ndarray<const double, nb::numpy, nb::shape<3>>;
using Vector6Out = nb::ndarray<const double, nb::numpy, nb::shape<6>>;
using Matrix6Out = nb::ndarray<const double, nb::numpy, nb::shape<6, 6>>;
using MatchesOut = nb::ndarray<const std::uint32_t, nb::numpy, nb::shape<-1, 2>>;
using FramesOut = nb::ndarray<const double, nb::numpy, nb::shape<-1, 3, 3>>;
using DescriptorsOut = nb::ndarray<const std::uint64_t, nb::numpy, nb::shape<-1, bsc_words>>;
using FloatsOut = nb::ndarray<const float, nb::numpy, nb::shape<-1>>;
using IndicesOut = nb::ndarray<const std::uint32_t, nb::numpy, nb::shape<-1>>;

PointsOut array_of(const Points& points);
VectorOut array_of(const Eigen::Vector3d& vector);
Vector6Out array_of(const Eigen::Matrix<double, 6, 1>& vector);
Matrix6Out array_of(const Eigen::Matrix<double, 6, 6>& matrix);
MatchesOut array_of(const std::vector<KeypointMatch>& matches);
FramesOut array_of(const std::vector<Eigen::Matrix3d>& frames);
DescriptorsOut array_of(const std::vector<Descriptor>& descriptors);
FloatsOut array_of(const std::vector<float>& values);
IndicesOut array_of(const std::vector<std::uint32_t>& values);

// ... and arrays of their own, free to be changed.
using MatrixOut = nb::ndarray<double, nb::numpy, nb::shape<4, 4>, nb::c_contig>;
using OwnPointsOut = nb::ndarray<double, nb::numpy, nb::shape<-1, 3>, nb::c_contig>;
MatrixOut array_of(const Transformation& transformation);
OwnPointsOut array_of(Points&& points);

}  // namespace igsp::python
