#include "io/scalar_type.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <stdexcept>

namespace igsp::io {

namespace {

template <typename Scalar, bool swap>
double decode(const char* bytes) {
  std::array<char, sizeof(Scalar)> raw;
  std::memcpy(raw.data(), bytes, sizeof(Scalar));
  if constexpr (swap) std::reverse(raw.begin(), raw.end());
  return static_cast<double>(std::bit_cast<Scalar>(raw));
}

struct Scalar {
  std::size_t size;
  Decoder native, swapped;
};

template <typename Type>
constexpr Scalar scalar = {sizeof(Type), decode<Type, false>, decode<Type, true>};

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

}  // namespace igsp::io
