#pragma once

#include <string>
#include <string_view>

#include "archive/codec.hpp"
#include "archive/consistency.hpp"

namespace igsp::archive {

/// Raised whenever the bytes of unchanged fields mean something else. Fields and options that come and go are noticed
/// by a fingerprint of layouts.hpp.
inline constexpr std::uint32_t form = 1;

/// Around the bytes of a value: a magic, form, version of igsp, name of the struct, fingerprint of all layouts and the
/// size before them, a checksum of everything behind.
std::string sealed(std::string_view name, std::string_view body);

/// The body again, a view of the bytes. Throws Fault unless all of that is as expected.
std::string_view opened(std::string_view name, std::string_view bytes);

/// For every struct of layouts.hpp.
template <HasLayout T>
std::string pack(const T& value) {
  Encoder body;
  put(body, value);
  return sealed(Layout<T>::name, body.bytes());
}

/// Throws Fault.
template <HasLayout T>
T unpack(std::string_view bytes) {
  Decoder body(opened(Layout<T>::name, bytes));
  T value{};
  get(body, value);
  if (body.remaining() > 0) body.fail(std::to_string(body.remaining()) + " bytes that belong to nothing");
  require_consistent(value);
  return value;
}

}  // namespace igsp::archive
