#pragma once

#include <bit>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "igsp/io.hpp"
#include "io/input_file.hpp"
#include "io/scalar_type.hpp"

namespace igsp::io {

struct PlyProperty {
  std::string name;
  ScalarType type = ScalarType::float32;
  std::optional<ScalarType> list_length;  ///< set for a list property
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  FileFormat format = FileFormat::ply_ascii;
  std::vector<PlyElement> elements;
  std::optional<Eigen::Vector3d> viewpoint;  ///< of a comment, see ply_viewpoint
};

/// Where the scanner stood, of the words of a header line `comment viewpoint x y z`; none of any other.
std::optional<Eigen::Vector3d> ply_viewpoint(const std::vector<std::string_view>& words);
std::string ply_viewpoint_comment(const Eigen::Vector3d& viewpoint);

/// Of the values of a binary file.
std::endian byte_order_of(FileFormat format);

/// Consumes everything up to and including end_header.
PlyHeader read_ply_header(InputFile& file);

/// Which element holds the points. Fails, naming what there is, unless there is one that has x, y and z.
std::size_t find_vertex(const InputFile& file, const PlyHeader& header);

}  // namespace igsp::io
