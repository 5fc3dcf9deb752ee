#pragma once

#include <algorithm>
#include <charconv>
#include <concepts>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace igsp::io {

/// The whole token as a number, in the C locale; nothing if it is none or does not fit. "nan" and "inf" are numbers.
template <typename Number>
std::optional<Number> parse_number(std::string_view token) {
  if (token.size() > 1 && token[0] == '+' && token[1] != '-') token.remove_prefix(1);  // from_chars takes no plus
  Number value{};
  const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), value);
  if (error != std::errc() || end != token.data() + token.size()) return std::nullopt;
  return value;
}

/// Appends the shortest text that reads back as exactly this number.
inline void append_number(std::string& text, std::floating_point auto value) {
  char digits[32];
  text.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
}

/// Cuts a line into its values: at every `separator` outside double quotes with the blanks around it removed, or at
/// runs of blanks if `separator` is a blank.
class Tokenizer {
 public:
  Tokenizer(std::string_view line, char separator) : rest_(line), separator_(separator) { skip_blanks(); }

  bool next(std::string_view& token) {
    if (rest_.empty()) return false;
    std::size_t length = 0;
    if (separator_ == ' ') {
      while (length < rest_.size() && !is_blank(rest_[length])) ++length;
      token = rest_.substr(0, length);
      rest_.remove_prefix(length);
    } else {
      const std::size_t closing = rest_.front() == '"' ? rest_.find('"', 1) : rest_.npos;
      length = std::min(rest_.find(separator_, closing == rest_.npos ? 0 : closing), rest_.size());
      token = rest_.substr(0, length);
      while (!token.empty() && is_blank(token.back())) token.remove_suffix(1);
      rest_.remove_prefix(std::min(length + 1, rest_.size()));
    }
    skip_blanks();
    return true;
  }

  static bool is_blank(char c) { return c == ' ' || c == '\t'; }

 private:
  void skip_blanks() {
    while (!rest_.empty() && is_padding(rest_.front())) rest_.remove_prefix(1);
  }
  bool is_padding(char c) const { return c == ' ' || (c == '\t' && separator_ != '\t'); }

  std::string_view rest_;
  char separator_;
};

/// All values of a line.
std::vector<std::string_view> split(std::string_view line, char separator);

/// All blank-separated words of a header line.
std::vector<std::string_view> split_words(std::string_view line);

/// A token for an error message: in quotes, shortened, unprintable bytes as '?'.
std::string in_quotes(std::string_view token);

}  // namespace igsp::io
