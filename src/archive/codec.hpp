#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "archive/bytes.hpp"
#include "archive/layouts.hpp"
#include "config/option_list.hpp"

/// How a value of each type becomes bytes and comes back. `describe` names the type in the fingerprint of the layouts;
/// `least_bytes` is what the shortest value takes.
namespace igsp::archive {

template <typename T>
struct Codec;

template <typename T>
void put(Encoder& out, const T& value) {
  Codec<T>::put(out, value);
}
template <typename T>
void get(Decoder& in, T& value) {
  Codec<T>::get(in, value);
}

template <Scalar T>
struct Codec<T> {
  static constexpr std::size_t least_bytes = sizeof(T);
  static void put(Encoder& out, T value) { out.scalar(value); }
  static void get(Decoder& in, T& value) { value = in.scalar<T>(); }
  static std::string describe() {
    return (std::is_floating_point_v<T> ? "f" : std::is_signed_v<T> ? "i" : "u") + std::to_string(sizeof(T));
  }
};

template <>
struct Codec<bool> {
  static constexpr std::size_t least_bytes = 1;
  static void put(Encoder& out, bool value) { out.scalar<std::uint8_t>(value); }
  static void get(Decoder& in, bool& value) {
    const auto byte = in.scalar<std::uint8_t>();
    if (byte > 1) in.fail("a truth value is " + std::to_string(byte) + "; it must be 0 or 1");
    value = byte == 1;
  }
  static std::string describe() { return "bool"; }
};

/// What is written as the number of one of its values.
template <typename T>
struct Listed;
template <>
struct Listed<Termination> {
  static constexpr std::string_view name = "termination reason";
  static constexpr Termination last = Termination::degenerate_matches;
};
template <>
struct Listed<Cause> {
  static constexpr std::string_view name = "cause";
  static constexpr Cause last = Cause::scale;
};
template <>
struct Listed<LinkState> {
  static constexpr std::string_view name = "state of a link";
  static constexpr LinkState last = LinkState::not_registered;
};
template <>
struct Listed<LinkOrigin> {
  static constexpr std::string_view name = "origin of a link";
  static constexpr LinkOrigin last = LinkOrigin::merged;
};

template <typename T>
requires std::is_enum_v<T>
struct Codec<T> {
  static constexpr std::size_t least_bytes = sizeof(std::int32_t);
  static void put(Encoder& out, T value) { out.scalar(static_cast<std::int32_t>(value)); }
  static void get(Decoder& in, T& value) {
    const auto number = in.scalar<std::int32_t>();
    if (number < 0 || number > static_cast<std::int32_t>(Listed<T>::last)) {
      in.fail("there is no " + std::string(Listed<T>::name) + " " + std::to_string(number));
    }
    value = static_cast<T>(number);
  }
  static std::string describe() { return std::string(Listed<T>::name); }
};

template <>
struct Codec<std::string> {
  static constexpr std::size_t least_bytes = 8;
  static void put(Encoder& out, const std::string& value) { out.text(value); }
  static void get(Decoder& in, std::string& value) { value = in.text(); }
  static std::string describe() { return "text"; }
};

template <typename T>
struct Codec<std::optional<T>> {
  static constexpr std::size_t least_bytes = 1;
  static void put(Encoder& out, const std::optional<T>& value) {
    archive::put(out, value.has_value());
    if (value) archive::put(out, *value);
  }
  static void get(Decoder& in, std::optional<T>& value) {
    bool there = false;
    archive::get(in, there);
    value.reset();
    if (there) archive::get(in, value.emplace());
  }
  static std::string describe() { return Codec<T>::describe() + "?"; }
};

template <typename A, typename B>
struct Codec<std::pair<A, B>> {
  static constexpr std::size_t least_bytes = Codec<A>::least_bytes + Codec<B>::least_bytes;
  static void put(Encoder& out, const std::pair<A, B>& value) {
    archive::put(out, value.first);
    archive::put(out, value.second);
  }
  static void get(Decoder& in, std::pair<A, B>& value) {
    archive::get(in, value.first);
    archive::get(in, value.second);
  }
  static std::string describe() { return "(" + Codec<A>::describe() + "," + Codec<B>::describe() + ")"; }
};

template <typename T, std::size_t size>
struct Codec<std::array<T, size>> {
  static constexpr std::size_t least_bytes = size * Codec<T>::least_bytes;
  static void put(Encoder& out, const std::array<T, size>& values) {
    for (const T& value : values) archive::put(out, value);
  }
  static void get(Decoder& in, std::array<T, size>& values) {
    for (T& value : values) archive::get(in, value);
  }
  static std::string describe() { return Codec<T>::describe() + "x" + std::to_string(size); }
};

template <typename T>
struct Codec<std::vector<T>> {
  static constexpr std::size_t least_bytes = 8;
  static void put(Encoder& out, const std::vector<T>& values) {
    out.scalar<std::uint64_t>(values.size());
    for (const T& value : values) archive::put(out, value);
  }
  // Grows as elements are read: an element in memory may be many times larger than the bytes that claim to be one.
  static void get(Decoder& in, std::vector<T>& values) {
    const std::size_t size = in.count(Codec<T>::least_bytes);
    values.clear();
    if constexpr (!HasLayout<T> || std::is_trivially_copyable_v<T>) values.reserve(size);
    for (std::size_t i = 0; i < size; ++i) archive::get(in, values.emplace_back());
  }
  static std::string describe() { return "[" + Codec<T>::describe() + "]"; }
};

/// Column by column.
template <typename T, int rows, int columns>
struct Codec<Eigen::Matrix<T, rows, columns>> {
  static_assert(rows > 0 && columns > 0, "of fixed size");
  using Matrix = Eigen::Matrix<T, rows, columns>;
  static constexpr std::size_t least_bytes = rows * columns * Codec<T>::least_bytes;
  static void put(Encoder& out, const Matrix& matrix) {
    for (Eigen::Index i = 0; i < matrix.size(); ++i) archive::put(out, matrix.data()[i]);
  }
  static void get(Decoder& in, Matrix& matrix) {
    for (Eigen::Index i = 0; i < matrix.size(); ++i) archive::get(in, matrix.data()[i]);
  }
  static std::string describe() {
    return Codec<T>::describe() + "x" + std::to_string(rows) + "x" + std::to_string(columns);
  }
};

template <>
struct Codec<Transformation> {
  using Matrix = Codec<Eigen::Matrix4d>;
  static constexpr std::size_t least_bytes = Matrix::least_bytes;
  static void put(Encoder& out, const Transformation& value) { Matrix::put(out, value.matrix()); }
  static void get(Decoder& in, Transformation& value) { Matrix::get(in, value.matrix()); }
  static std::string describe() { return "transformation"; }
};

/// Every option of the one list, in its order, each in its range.
template <>
struct Codec<Options> {
  static constexpr std::size_t least_bytes = 1;
  static void put(Encoder& out, const Options& options);
  static void get(Decoder& in, Options& options);
  static std::string describe();
};

template <HasLayout T>
struct Codec<T> {
  static constexpr std::size_t least_bytes = 1;
  static void put(Encoder& out, const T& value) {
    for_each_field([&](const auto& field) { archive::put(out, value.*field.member); });
  }
  static void get(Decoder& in, T& value) {
    in.nested([&] { for_each_field([&](const auto& field) { archive::get(in, value.*field.member); }); });
  }
  static std::string describe() { return std::string(Layout<T>::name); }
  /// With its fields; `describe` alone names it, so that a struct may hold others of its kind.
  static std::string describe_fields() {
    std::string text = describe() + "{";
    for_each_field([&]<typename Class, typename Member>(const Field<Class, Member>& field) {
      text.append(field.name).append(":").append(Codec<Member>::describe()).append(";");
    });
    return text + "}";
  }

 private:
  template <typename Function>
  static void for_each_field(const Function& function) {
    std::apply([&](const auto&... fields) { (function(fields), ...); }, Layout<T>::fields);
  }
};

}  // namespace igsp::archive
