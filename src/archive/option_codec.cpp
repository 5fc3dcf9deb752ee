#include <variant>

#include "archive/codec.hpp"
#include "igsp/errors.hpp"

namespace igsp::archive {
namespace {

template <typename T>
OptionValue get_value(Decoder& in) {
  T value{};
  get(in, value);
  return value;
}

OptionValue get_value(OptionKind kind, Decoder& in) {
  switch (kind) {
    case OptionKind::boolean:
      return get_value<bool>(in);
    case OptionKind::integer:
      return get_value<int>(in);
    case OptionKind::real:
      return get_value<double>(in);
    case OptionKind::choice:
      return get_value<std::string>(in);
  }
  in.fail("an option of unknown kind");
}

}  // namespace

void Codec<Options>::put(Encoder& out, const Options& options) {
  for (const Option& option : option_list()) {
    std::visit([&](const auto& value) { archive::put(out, value); }, option.get(options));
  }
}

void Codec<Options>::get(Decoder& in, Options& options) {
  for (const Option& option : option_list()) {
    const OptionValue value = get_value(option.kind, in);
    try {
      assign(options, option, value);
    } catch (const InvalidArgument& fault) {
      in.fail(fault.what());
    }
  }
}

std::string Codec<Options>::describe() {
  std::string text = "options(";
  for (const Option& option : option_list()) text.append(option.key).append(";");
  return text + ")";
}

}  // namespace igsp::archive
