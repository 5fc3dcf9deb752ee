#pragma once

#include <bit>
#include <cstddef>

namespace igsp::io {

/// A number as it lies in a binary file.
enum class ScalarType { int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64 };

std::size_t size_of(ScalarType type);

/// Reads one number from (unaligned) bytes.
using Decoder = double (*)(const char* bytes);
Decoder decoder_of(ScalarType type, std::endian byte_order);

/// Writes one number as (unaligned) bytes: rounded to the type, an integer also to its range.
using Encoder = void (*)(char* bytes, double value);
Encoder encoder_of(ScalarType type, std::endian byte_order);

}  // namespace igsp::io
