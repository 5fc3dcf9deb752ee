#include "io/number_text.hpp"

namespace igsp::io {

std::vector<std::string_view> split_words(std::string_view line) {
  std::vector<std::string_view> words;
  Tokenizer tokens(line, ' ');
  for (std::string_view word; tokens.next(word);) words.push_back(word);
  return words;
}

std::string in_quotes(std::string_view token) {
  constexpr std::size_t longest = 40;
  std::string text = "'";
  for (const char c : token.substr(0, longest)) text += c >= ' ' && c <= '~' ? c : '?';
  return text + (token.size() > longest ? "...'" : "'");
}

}  // namespace igsp::io
