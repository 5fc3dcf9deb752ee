#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "igsp/io.hpp"
#include "io/input_file.hpp"
#include "io/scalar_type.hpp"

namespace igsp::io {

struct PcdField {
  std::string name;
  std::uint64_t size = 4;
  char type = 'F';
  std::uint64_t count = 1;  ///< values of this field in one point
};

struct PcdHeader {
  FileFormat format = FileFormat::pcd_ascii;
  std::vector<PcdField> fields;
  std::uint64_t points = 0;
  std::optional<Eigen::Vector3d> viewpoint;  ///< position of the sensor, unless VIEWPOINT is the default

  std::uint64_t stride() const;  ///< bytes of a point
};

/// Of a VIEWPOINT line: the sensor's position, then its orientation as a quaternion, w first.
using PcdPose = std::array<double, 7>;
inline constexpr PcdPose default_pcd_pose = {0, 0, 0, 1, 0, 0, 0};

/// From the words behind VIEWPOINT; none unless they are seven finite numbers.
std::optional<PcdPose> parse_pcd_pose(std::span<const std::string_view> words);

/// Consumes everything up to and including the DATA line. Fails unless there are x, y and z.
PcdHeader read_pcd_header(InputFile& file);

/// The scalar type of a field. Fails for a SIZE that its TYPE cannot have.
ScalarType scalar_type_of(const InputFile& file, const PcdField& field);

}  // namespace igsp::io
