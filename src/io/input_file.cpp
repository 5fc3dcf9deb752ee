#include "io/input_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>

#include "igsp/errors.hpp"

namespace igsp::io {

InputFile::InputFile(const std::filesystem::path& path) : path_(path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (status.type() == std::filesystem::file_type::not_found) fail("no such file");
  if (std::filesystem::is_directory(status)) fail("is a directory, not a file");
  if (error) fail("cannot open: " + error.message());
  if (!std::filesystem::is_regular_file(status)) fail("not a regular file");
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

bool InputFile::refill() {
  if (begin_ > 0) std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
  buffer_offset_ += begin_;
  end_ -= begin_;
  begin_ = 0;
  const auto room = static_cast<std::streamsize>(buffer_.size() - end_);
  const std::streamsize got = room > 0 ? stream_.rdbuf()->sgetn(buffer_.data() + end_, room) : 0;
  if (got > 0) end_ += static_cast<std::size_t>(got);
  return got > 0;
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
  while (!(newline = std::memchr(buffer_.data() + begin_ + searched, '\n', end_ - begin_ - searched))) {
    searched = end_ - begin_;
    if (searched == buffer_.size()) {
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
  if (last > first && last[-1] == '\r') --last;
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
    if (const void* newline = std::memchr(buffer_.data() + begin_, '\n', end_ - begin_)) {
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
  fail_at_offset(offset(), fmt::format("the header declares {} {} of at least {} bytes each, but only {} bytes follow",
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
