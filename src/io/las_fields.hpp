#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "io/las_header.hpp"
#include "io/scalar_type.hpp"

namespace igsp::io {

/// A value of a LAS point beside x, y and z: a number, or some bits of one.
struct LasField {
  std::string name;
  ScalarType type = ScalarType::uint8;
  std::size_t offset = 0;  ///< in the record
  int first_bit = 0;
  int bits = 0;  ///< 0: the number is whole

  double value(const char* record) const;
};

/// All of them, in the order of the record; extra bytes under the names that the file gives them, as they are stored.
std::vector<LasField> las_fields(const LasHeader& header);

/// Where the direction of the pulse lies in the record of a waveform format, three floats; 0 in other formats.
std::size_t las_pulse_direction(int point_format);

}  // namespace igsp::io
