#pragma once

#include <cstddef>

namespace igsp {

/// Stands for a field of any type; only ever used unevaluated.
struct AnyField {
  template <typename Field>
  operator Field() const;
};

/// Number of fields of an aggregate: the longest list of initialisers it takes.
template <typename Aggregate, typename... Fields>
consteval std::size_t field_count() {
  if constexpr (requires { Aggregate{Fields{}..., AnyField{}}; }) {
    return field_count<Aggregate, Fields..., AnyField>();
  } else {
    return sizeof...(Fields);
  }
}

}  // namespace igsp
