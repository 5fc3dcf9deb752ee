#pragma once

#include <cstdint>
#include <optional>
#include <string>
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
};

/// Consumes everything up to and including end_header.
PlyHeader read_ply_header(InputFile& file);

/// Which element holds the points. Fails, naming what there is, unless there is one that has x, y and z.
std::size_t find_vertex(const InputFile& file, const PlyHeader& header);

}  // namespace igsp::io
