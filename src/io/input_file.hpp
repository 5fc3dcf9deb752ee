#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

namespace igsp::io {

/// A regular, non-empty file read front to back through one buffer, as lines or as bytes; it always knows where it is,
/// so that every error can say so. Views it hands out are valid until the next call.
class InputFile {
 public:
  /// No line and no single read is longer than this: it bounds the memory that a broken file can ask for.
  static constexpr std::size_t buffer_size = std::size_t{1} << 20;

  explicit InputFile(const std::filesystem::path& path);

  const std::filesystem::path& path() const { return path_; }
  std::uint64_t size() const { return size_; }
  std::uint64_t offset() const { return buffer_offset_ + begin_; }
  std::uint64_t remaining() const { return size_ > offset() ? size_ - offset() : 0; }
  /// The number of the line read last, from 1.
  std::uint64_t line() const { return line_; }

  /// The next `count` bytes without consuming them; fewer at the end of the file. count <= buffer_size.
  std::string_view peek(std::size_t count);
  /// Consumes exactly `count` bytes, count <= buffer_size.
  std::string_view read(std::size_t count);
  /// To be called before anything is read: passes over a byte order mark, hands out UTF-16 as UTF-8, and takes \r for
  /// the line end where the first line ends so.
  void detect_encoding();
  /// The next line without its line end (\n, \r\n or, if detect_encoding saw it, \r); false at the end of the file.
  bool read_line(std::string_view& line);
  /// What ended the line read last: nothing at the end of the file. Valid as long as that line.
  std::string_view line_end() const { return line_end_; }
  /// Takes back the line read last; only directly after read_line.
  void unread_line();
  /// Skips a line of any length; false at the end of the file.
  bool skip_line();
  void skip(std::uint64_t count);

  /// Fails unless the rest of the file can hold `count` records of at least `bytes_each`: called before anything of
  /// that size is allocated or looped over.
  void require_records(std::uint64_t count, std::uint64_t bytes_each, std::string_view what) const;

  [[noreturn]] void fail(std::string_view message) const;
  [[noreturn]] void fail_at_line(std::string_view message) const { fail_at_line(line_, message); }
  [[noreturn]] void fail_at_line(std::uint64_t line, std::string_view message) const;
  [[noreturn]] void fail_at_offset(std::uint64_t offset, std::string_view message) const;

 private:
  enum class Encoding { bytes, utf16_little_endian, utf16_big_endian };

  /// Moves what is left to the front and fills up; false when the file has no more bytes.
  std::size_t read_raw(char* to, std::size_t count);
  bool refill();
  /// Reads UTF-16 and appends it as UTF-8.
  bool refill_from_utf16();
  void append_utf8(char32_t character);
  [[noreturn]] void fail_truncated(std::uint64_t missing) const;

  std::filesystem::path path_;
  std::ifstream stream_;
  std::uint64_t size_ = 0;
  std::vector<char> buffer_;
  std::size_t begin_ = 0, end_ = 0;
  std::uint64_t buffer_offset_ = 0;  // of buffer_[0] in the file
  std::uint64_t line_ = 0;
  std::size_t line_begin_ = 0;  // of the line read last, in the buffer
  std::string_view line_end_;
  char line_break_ = '\n';
  Encoding encoding_ = Encoding::bytes;
};

}  // namespace igsp::io
