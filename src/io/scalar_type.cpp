#include "io/scalar_type.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <type_traits>

namespace igsp::io {

namespace {

template <typename Scalar, bool swap>
double decode(const char* bytes) {
  std::array<char, sizeof(Scalar)> raw;
  std::memcpy(raw.data(), bytes, sizeof(Scalar));
  if constexpr (swap) std::reverse(raw.begin(), raw.end());
  return static_cast<double>(std::bit_cast<Scalar>(raw));
}

template <typename Scalar>
Scalar rounded(double value) {
  if constexpr (std::is_floating_point_v<Scalar>) {
    return static_cast<Scalar>(value);
  } else {
    using Limits = std::numeric_limits<Scalar>;
    if (!(value > static_cast<double>(Limits::min()))) return Limits::min();  // also for NaN
    if (value >= static_cast<double>(Limits::max())) return Limits::max();
    return static_cast<Scalar>(std::round(value));
  }
}

template <typename Scalar, bool swap>
void encode(char* bytes, double value) {
  auto raw = std::bit_cast<std::array<char, sizeof(Scalar)>>(rounded<Scalar>(value));
  if constexpr (swap) std::reverse(raw.begin(), raw.end());
  std::memcpy(bytes, raw.data(), sizeof(Scalar));
}

struct Scalar {
  std::size_t size;
  Decoder native, swapped;
  Encoder encode_native, encode_swapped;
};

template <typename Type>
constexpr Scalar scalar = {sizeof(Type), decode<Type, false>, decode<Type, true>, encode<Type, false>,
                           encode<Type, true>};

Scalar scalar_of(ScalarType type) {
  switch (type) {
    case ScalarType::int8:
      return scalar<std::int8_t>;
    case ScalarType::uint8:
      return scalar<std::uint8_t>;
    case ScalarType::int16:
      return scalar<std::int16_t>;
    case ScalarType::uint16:
      return scalar<std::uint16_t>;
    case ScalarType::int32:
      return scalar<std::int32_t>;
    case ScalarType::uint32:
      return scalar<std::uint32_t>;
    case ScalarType::int64:
      return scalar<std::int64_t>;
    case ScalarType::uint64:
      return scalar<std::uint64_t>;
    case ScalarType::float32:
      return scalar<float>;
    case ScalarType::float64:
      return scalar<double>;
  }
  throw std::logic_error("no such ScalarType");
}

}  // namespace

std::size_t size_of(ScalarType type) {
  return scalar_of(type).size;
}

Decoder decoder_of(ScalarType type, std::endian byte_order) {
  const Scalar found = scalar_of(type);
  return byte_order == std::endian::native ? found.native : found.swapped;
}

Encoder encoder_of(ScalarType type, std::endian byte_order) {
  const Scalar found = scalar_of(type);
  return byte_order == std::endian::native ? found.encode_native : found.encode_swapped;
}

}  // namespace igsp::io
