#include "io/moved_fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include "io/column_names.hpp"

namespace igsp::io {

namespace {

struct Triple {
  std::array<std::string_view, 3> names;
  bool direction;
};

constexpr Triple triples[] = {{{"x", "y", "z"}, false},
                              {{"vp_x", "vp_y", "vp_z"}, false},           // where a point was seen from
                              {{"view_px", "view_py", "view_pz"}, false},  // of a camera
                              {{"nx", "ny", "nz"}, true},
                              {{"normal_x", "normal_y", "normal_z"}, true},
                              {{"normalx", "normaly", "normalz"}, true},
                              {{"principal_curvature_x", "principal_curvature_y", "principal_curvature_z"}, true},
                              {{"x_axisx", "x_axisy", "x_axisz"}, true},
                              {{"y_axisx", "y_axisy", "y_axisz"}, true},
                              {{"z_axisx", "z_axisy", "z_axisz"}, true}};

}  // namespace

std::vector<MovedFields> find_moved_fields(const std::vector<std::string>& names) {
  std::vector<std::string> plain;
  for (const std::string& name : names) plain.push_back(plain_name(name));
  std::vector<MovedFields> found;
  for (const Triple& triple : triples) {
    MovedFields moved{{}, triple.direction};
    std::size_t axes = 0;
    for (; axes < 3; ++axes) {
      const auto name = std::ranges::find(plain, triple.names[axes]);
      if (name == plain.end()) break;
      moved.fields[axes] = static_cast<std::size_t>(name - plain.begin());
    }
    if (axes == 3) found.push_back(moved);
  }
  return found;
}

double length_factor(const Eigen::Matrix3d& linear) {
  const double cubed = linear.determinant();
  return std::abs(cubed - 1) < 1e-6 ? 1.0 : std::cbrt(cubed);
}

Eigen::Vector3d moved(const Eigen::Vector3d& values, bool direction, const Transformation& transformation) {
  if (!values.allFinite()) return values;
  if (!direction) return transformation * values;
  return transformation.linear() * values / length_factor(transformation.linear());
}

void require_held(const InputFile& file, const Eigen::Vector3d& moved, const std::array<ScalarType, 3>& written_as) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double value = moved[static_cast<Eigen::Index>(axis)];
    const bool is_held = written_as[axis] == ScalarType::float32 ? std::abs(value) <= std::numeric_limits<float>::max()
                                                                 : std::isfinite(value);
    if (is_held) continue;
    file.fail(fmt::format("moved by this transformation a coordinate becomes {}, which its type, {}, cannot hold",
                          value, written_as[axis] == ScalarType::float32 ? "float" : "double"));
  }
}

}  // namespace igsp::io
