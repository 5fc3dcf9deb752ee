#pragma once

#include <gtest/gtest.h>
#include <stdlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <initializer_list>
#include <iterator>
#include <stdexcept>
#include <string>
#include <string_view>

#include "igsp/errors.hpp"
#include "igsp/io.hpp"

namespace igsp::io::testing {

/// A folder of its own, gone with the test.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "igsp_io_XXXXXX").string();
    if (!mkdtemp(name.data())) throw std::runtime_error("mkdtemp failed");
    path_ = name;
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::filesystem::path operator/(std::string_view name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }
  std::size_t files() const {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(path_), {}));
  }
  std::filesystem::path write(std::string_view name, std::string_view bytes) const {
    std::ofstream(path_ / name, std::ios::binary) << bytes;
    return path_ / name;
  }

 private:
  std::filesystem::path path_;
};

inline std::string read_bytes(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// The bytes of a number in a file.
template <typename Scalar>
std::string bytes_of(Scalar value, std::endian byte_order = std::endian::little) {
  auto raw = std::bit_cast<std::array<char, sizeof(Scalar)>>(value);
  if (byte_order != std::endian::native) std::ranges::reverse(raw);
  return {raw.data(), raw.size()};
}

/// The action throws a FileError whose message has all these parts.
inline void expect_file_error(const std::function<void()>& action, std::initializer_list<std::string> parts) {
  try {
    action();
    ADD_FAILURE() << "no FileError";
  } catch (const FileError& error) {
    for (const std::string& part : parts) {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos)
          << "'" << part << "' is missing in: " << error.what();
    }
  }
}

/// Reading this content fails with a message that names the path and has all these parts.
inline void expect_unreadable(std::string_view name, std::string_view content,
                              std::initializer_list<std::string> parts) {
  const TemporaryFolder folder;
  const auto path = folder.write(name, content);
  expect_file_error([&] { read_points(path); }, {path.string()});
  expect_file_error([&] { read_points(path); }, parts);
}

inline LoadedCloud read_content(std::string_view name, std::string_view content) {
  const TemporaryFolder folder;
  return read_points(folder.write(name, content));
}

}  // namespace igsp::io::testing
