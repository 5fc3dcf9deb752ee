#include "io/whole_file.hpp"

#include <fmt/format.h>

#include <system_error>

#include "io/input_file.hpp"

namespace igsp::io {

std::string read_whole(const std::filesystem::path& path, std::uint64_t limit) {
  std::error_code error;
  if (std::filesystem::is_regular_file(path, error) && std::filesystem::file_size(path, error) == 0) return {};
  InputFile file(path);
  std::string content;
  for (std::string_view some; !(some = file.peek(InputFile::buffer_size)).empty(); file.read(some.size())) {
    if (content.size() + some.size() > limit) file.fail(fmt::format("holds more than {} bytes", limit));
    content += some;
  }
  return content;
}

}  // namespace igsp::io
