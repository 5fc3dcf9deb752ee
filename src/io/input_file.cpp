#include "io/input_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <system_error>

#include "igsp/errors.hpp"

namespace igsp::io {

namespace {

constexpr std::size_t utf8_bytes_per_unit = 3;  // at most, of UTF-16; two units of a pair take 4

}  // namespace

InputFile::InputFile(const std::filesystem::path& path) : path_(path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (status.type() == std::filesystem::file_type::not_found) {
    fail(path == "-" ? "standard input is not read; save what comes out of it as a file first" : "no such file");
  }
  if (std::filesystem::is_directory(status)) fail("is a directory, not a file");
  if (error) fail("cannot open: " + error.message());
  if (!std::filesystem::is_regular_file(status)) {
    fail("not a regular file: pipes and devices are not read; save what comes out of it as a file first");
  }
  size_ = std::filesystem::file_size(path, error);
  if (error) fail("cannot open: " + error.message());
  if (size_ == 0) fail("the file is empty (0 bytes)");
  stream_.rdbuf()->pubsetbuf(nullptr, 0);  // this class buffers
  errno = 0;
  stream_.open(path, std::ios::binary);
  if (!stream_) fail("cannot open: " + std::generic_category().message(errno));
  buffer_.resize(
      static_cast<std::size_t>(std::min<std::uint64_t>(buffer_size, size_ + 1)));  // never full of a small file
}

std::size_t InputFile::read_raw(char* to, std::size_t count) {
  try {
    return static_cast<std::size_t>(stream_.rdbuf()->sgetn(to, static_cast<std::streamsize>(count)));
  } catch (const std::ios_base::failure& failure) {  // a disk or a network that fails half-way
    fail_at_offset(buffer_offset_ + end_, "cannot read: " + failure.code().message());
  }
}

bool InputFile::refill() {
  if (begin_ > 0) std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
  buffer_offset_ += begin_;
  end_ -= begin_;
  begin_ = 0;
  if (encoding_ != Encoding::bytes) return refill_from_utf16();
  const std::size_t room = buffer_.size() - end_;
  const std::size_t got = room > 0 ? read_raw(buffer_.data() + end_, room) : 0;
  end_ += got;
  return got > 0;
}

bool InputFile::refill_from_utf16() {
  constexpr std::size_t most_units = 16384;
  std::array<char, 2 * most_units> raw;
  const std::size_t units = std::min(most_units, (buffer_.size() - end_) / utf8_bytes_per_unit);
  const std::size_t got = read_raw(raw.data(), 2 * units);
  const bool little = encoding_ == Encoding::utf16_little_endian;
  const auto unit = [&](std::size_t i) {
    const auto first = static_cast<unsigned char>(raw[i]), second = static_cast<unsigned char>(raw[i + 1]);
    return static_cast<char32_t>(little ? second << 8 | first : first << 8 | second);
  };
  const std::size_t before = end_;
  for (std::size_t i = 0; i + 1 < got; i += 2) {
    char32_t character = unit(i);
    if (character >= 0xD800 && character < 0xDC00 && i + 3 < got) {  // the first half of a pair
      character = 0x10000 + ((character - 0xD800) << 10) + (unit(i += 2) & 0x3FF);
    } else if (character >= 0xD800 && character < 0xDC00 && i > 0 && got == 2 * units) {
      stream_.rdbuf()->pubseekoff(-2, std::ios::cur);  // its other half comes next
      break;
    }
    append_utf8(character);
  }
  return end_ > before;
}

void InputFile::append_utf8(char32_t character) {
  const unsigned more = character < 0x80 ? 0 : character < 0x800 ? 1 : character < 0x10000 ? 2 : 3;
  constexpr unsigned leads[] = {0x00, 0xC0, 0xE0, 0xF0};
  buffer_[end_++] = static_cast<char>(leads[more] | character >> 6 * more);
  for (unsigned i = more; i-- > 0;) buffer_[end_++] = static_cast<char>(0x80 | (character >> 6 * i & 0x3F));
}

void InputFile::detect_encoding() {
  constexpr std::size_t sample = 4096;
  const std::string_view start = peek(sample);
  const auto is_zero = [&](std::size_t i) { return i < start.size() && start[i] == '\0'; };
  if (start.starts_with("\xFF\xFE") || (start.size() >= 4 && !is_zero(0) && is_zero(1) && !is_zero(2) && is_zero(3))) {
    encoding_ = Encoding::utf16_little_endian;
  } else if (start.starts_with("\xFE\xFF") ||
             (start.size() >= 4 && is_zero(0) && !is_zero(1) && is_zero(2) && !is_zero(3))) {
    encoding_ = Encoding::utf16_big_endian;
  }
  if (encoding_ != Encoding::bytes) {
    begin_ = end_ = 0;
    buffer_.resize(static_cast<std::size_t>(std::min<std::uint64_t>(buffer_size, 2 * size_ + utf8_bytes_per_unit)));
    stream_.rdbuf()->pubseekpos(0);
  }
  if (peek(3) == "\xEF\xBB\xBF") skip(3);
  const std::string_view text = peek(sample);
  const std::size_t first_break = text.find_first_of("\r\n");
  const std::size_t behind = text.find_first_not_of('\r', first_break);
  if (first_break < text.size() && text[first_break] == '\r' && behind < text.size() && text[behind] != '\n') {
    line_break_ = '\r';
  }
}

std::string_view InputFile::peek(std::size_t count) {
  while (end_ - begin_ < count && refill()) {
  }
  return {buffer_.data() + begin_, std::min(count, end_ - begin_)};
}

std::string_view InputFile::read(std::size_t count) {
  const std::string_view bytes = peek(count);
  if (bytes.size() < count) fail_truncated(count - bytes.size());
  begin_ += count;
  return bytes;
}

bool InputFile::read_line(std::string_view& line) {
  std::size_t searched = 0;
  const void* newline = nullptr;
  while (!(newline = std::memchr(buffer_.data() + begin_ + searched, line_break_, end_ - begin_ - searched))) {
    searched = end_ - begin_;
    const bool full =
        encoding_ == Encoding::bytes ? searched == buffer_.size() : buffer_.size() - searched < utf8_bytes_per_unit;
    if (full) {
      fail_at_line(line_ + 1, fmt::format("the line is longer than {} bytes", buffer_size));
    }
    if (!refill()) break;
  }
  if (!newline && begin_ == end_) return false;
  const char* first = buffer_.data() + begin_;
  const char* last = newline ? static_cast<const char*>(newline) : buffer_.data() + end_;
  line_begin_ = begin_;
  begin_ = static_cast<std::size_t>(last - buffer_.data()) + (newline ? 1 : 0);
  ++line_;
  while (last > first && last[-1] == '\r') --last;
  line_end_ = {last, static_cast<std::size_t>(buffer_.data() + begin_ - last)};
  line = {first, static_cast<std::size_t>(last - first)};
  return true;
}

void InputFile::unread_line() {
  begin_ = line_begin_;
  --line_;
}

bool InputFile::skip_line() {
  if (peek(1).empty()) return false;
  ++line_;
  do {
    if (const void* newline = std::memchr(buffer_.data() + begin_, line_break_, end_ - begin_)) {
      begin_ = static_cast<std::size_t>(static_cast<const char*>(newline) - buffer_.data()) + 1;
      return true;
    }
    begin_ = end_;
  } while (refill());
  return true;
}

void InputFile::skip(std::uint64_t count) {
  if (count > remaining()) fail_truncated(count - remaining());
  const std::uint64_t buffered = std::min<std::uint64_t>(count, end_ - begin_);
  begin_ += static_cast<std::size_t>(buffered);
  if (count == buffered) return;
  buffer_offset_ = offset() + (count - buffered);
  begin_ = end_ = 0;
  if (stream_.rdbuf()->pubseekpos(static_cast<std::streamoff>(buffer_offset_)) == std::streampos(-1)) {
    fail_at_offset(buffer_offset_, "cannot read here");
  }
}

void InputFile::require_records(std::uint64_t count, std::uint64_t bytes_each, std::string_view what) const {
  if (bytes_each == 0 || count <= remaining() / bytes_each) return;
  fail_at_offset(offset(), fmt::format("the header declares {} {} of at least {} bytes each, but only {} bytes follow: "
                                       "cut short, or the count is wrong",
                                       count, what, bytes_each, remaining()));
}

void InputFile::fail(std::string_view message) const {
  throw FileError(fmt::format("{}: {}", path_.string(), message));
}

void InputFile::fail_at_line(std::uint64_t line, std::string_view message) const {
  throw FileError(fmt::format("{}: line {}: {}", path_.string(), line, message));
}

void InputFile::fail_at_offset(std::uint64_t offset, std::string_view message) const {
  throw FileError(fmt::format("{}: byte offset {}: {}", path_.string(), offset, message));
}

void InputFile::fail_truncated(std::uint64_t missing) const {
  fail_at_offset(size_, fmt::format("the file ends here, {} bytes too early: truncated", missing));
}

}  // namespace igsp::io
