#include "io/number_text.hpp"

namespace igsp::io {

std::vector<std::string_view> split(std::string_view line, char separator) {
  std::vector<std::string_view> values;
  Tokenizer tokens(line, separator);
  for (std::string_view value; tokens.next(value);) values.push_back(value);
  return values;
}

std::vector<std::string_view> split_words(std::string_view line) {
  return split(line, ' ');
}

std::string in_quotes(std::string_view token) {
  constexpr std::size_t longest = 40;
  std::string text = "'";
  for (const char c : token.substr(0, longest)) text += c >= ' ' && c <= '~' ? c : '?';
  return text + (token.size() > longest ? "...'" : "'");
}

}  // namespace igsp::io
