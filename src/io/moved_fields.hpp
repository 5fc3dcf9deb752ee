#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "igsp/point_cloud.hpp"
#include "io/input_file.hpp"
#include "io/scalar_type.hpp"

namespace igsp::io {

/// Three values of a record that a motion changes together.
struct MovedFields {
  std::array<std::size_t, 3> fields{};  ///< their indices in the record
  bool direction = false;               ///< turned only, as a normal
};

/// Those of a record with these field names, in any letter case: x y z, positions of cameras (vp_x, view_px), normals
/// (nx, normal_x, Normal X), axes of cameras and directions of curvature.
std::vector<MovedFields> find_moved_fields(const std::vector<std::string>& names);

/// By how much a motion makes lengths longer: 1 unless its linear part holds a factor of scale.
double length_factor(const Eigen::Matrix3d& linear);

/// Where the motion puts them; unchanged where one is not finite.
Eigen::Vector3d moved(const Eigen::Vector3d& values, bool direction, const Transformation& transformation);

/// Fails where one of the types cannot hold its coordinate of a moved position: out of the range of a float comes
/// infinity, and readers leave that point out.
void require_held(const InputFile& file, const Eigen::Vector3d& moved, const std::array<ScalarType, 3>& written_as);

}  // namespace igsp::io
