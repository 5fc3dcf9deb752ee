#pragma once

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

namespace igsp::archive {

/// What is wrong with the bytes; the public functions make it the caller's or the file's fault.
class Fault : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

template <typename T>
concept Scalar = (std::integral<T> && !std::same_as<T, bool>) || std::floating_point<T>;

/// An unsigned integer as large as the scalar.
template <Scalar T>
using BitsOf = std::conditional_t<
    sizeof(T) == 8, std::uint64_t,
    std::conditional_t<sizeof(T) == 4, std::uint32_t, std::conditional_t<sizeof(T) == 2, std::uint16_t, std::uint8_t>>>;

template <std::unsigned_integral Bits>
constexpr Bits little_endian(Bits bits) {
  if constexpr (std::endian::native == std::endian::little) {
    return bits;
  } else {
    Bits swapped = 0;
    for (std::size_t i = 0; i < sizeof(Bits); ++i) swapped |= (bits >> 8 * i & 0xff) << 8 * (sizeof(Bits) - 1 - i);
    return swapped;
  }
}

/// Appends numbers, least significant byte first.
class Encoder {
 public:
  template <Scalar T>
  void scalar(T value) {
    const auto bits = little_endian(std::bit_cast<BitsOf<T>>(value));
    bytes_.append(reinterpret_cast<const char*>(&bits), sizeof bits);
  }
  void raw(std::string_view bytes) { bytes_.append(bytes); }
  void text(std::string_view text) {
    scalar<std::uint64_t>(text.size());
    raw(text);
  }
  std::string take() && { return std::move(bytes_); }
  std::string_view bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

/// Reads them again, and never beyond the end. Views are into the bytes it was given.
class Decoder {
 public:
  explicit Decoder(std::string_view bytes) : bytes_(bytes) {}

  std::size_t offset() const { return offset_; }
  std::size_t remaining() const { return bytes_.size() - offset_; }

  template <Scalar T>
  T scalar() {
    BitsOf<T> bits;
    std::memcpy(&bits, raw(sizeof bits).data(), sizeof bits);
    return std::bit_cast<T>(little_endian(bits));
  }
  std::string_view raw(std::size_t count) {
    if (count > remaining()) fail("cut off: " + std::to_string(count - remaining()) + " more bytes were expected");
    offset_ += count;
    return bytes_.substr(offset_ - count, count);
  }
  /// A number of things that take at least `bytes_each`, so that no claim asks for more memory than the bytes can fill.
  std::size_t count(std::size_t bytes_each) {
    const auto claimed = scalar<std::uint64_t>();
    if (claimed > remaining() / bytes_each) {
      fail("it claims " + std::to_string(claimed) + " elements, but only " + std::to_string(remaining()) +
           " bytes follow");
    }
    return static_cast<std::size_t>(claimed);
  }
  std::string_view text() { return raw(count(1)); }
  /// Reads a struct: `read()`, which may come to this again for structs inside, though not deeper than any is written.
  template <typename Read>
  void nested(const Read& read) {
    constexpr int deepest = 16;
    if (depth_ == deepest) fail("structs inside of structs, deeper than any is written");
    ++depth_;
    read();
    --depth_;
  }
  [[noreturn]] void fail(const std::string& what) const {
    throw Fault("byte " + std::to_string(offset_) + ": " + what);
  }

 private:
  std::string_view bytes_;
  std::size_t offset_ = 0;
  int depth_ = 0;
};

}  // namespace igsp::archive
