#pragma once

#include <cstddef>
#include <optional>
#include <type_traits>
#include <utility>

namespace igsp {

// Stand for a field, only ever unevaluated: of any type, of any struct.
struct AnyField {
  template <typename Field>
  operator Field() const;
};
struct AnyStruct {
  template <typename Field>
  requires std::is_aggregate_v<Field>
  operator Field() const;
};

/// Number of fields of an aggregate: the longest list of initialisers it takes. Asked in this order, since nullopt
/// would initialise the first field of a struct, and AnyField could become both an optional and what lies in it.
template <typename Aggregate, typename... Fields>
consteval std::size_t field_count() {
  if constexpr (requires { Aggregate{std::declval<Fields>()..., std::declval<AnyStruct>()}; }) {
    return field_count<Aggregate, Fields..., AnyStruct>();
  } else if constexpr (requires { Aggregate{std::declval<Fields>()..., std::nullopt}; }) {
    return field_count<Aggregate, Fields..., std::nullopt_t>();
  } else if constexpr (requires { Aggregate{std::declval<Fields>()..., std::declval<AnyField>()}; }) {
    return field_count<Aggregate, Fields..., AnyField>();
  } else {
    return sizeof...(Fields);
  }
}

}  // namespace igsp
