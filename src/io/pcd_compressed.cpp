#include "io/pcd_compressed.hpp"

#include <fmt/format.h>
#include <lzf.h>

#include <algorithm>
#include <cstring>
#include <limits>

#include "igsp/errors.hpp"

namespace igsp::io {

namespace {

std::uint32_t read_uint32(InputFile& file) {
  return static_cast<std::uint32_t>(decoder_of(ScalarType::uint32, std::endian::little)(file.read(4).data()));
}

void append_uint32(std::string& bytes, std::uint32_t value) {
  for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(value >> shift & 0xFF);
}

}  // namespace

std::vector<char> read_pcd_compressed(InputFile& file, const PcdHeader& header) {
  const std::uint64_t points = header.points, stride = header.stride();
  constexpr std::uint64_t best_ratio = 88;  // of LZF: 3 bytes stand for at most 264
  const std::uint64_t start = file.offset();
  const std::uint64_t compressed_size = read_uint32(file);
  const std::uint64_t size = read_uint32(file);
  file.require_records(1, compressed_size, "compressed bodies");
  if (size / stride != points || size % stride != 0) {
    file.fail_at_offset(start + 4,
                        fmt::format("a body of {} bytes cannot be {} points of {} bytes", size, points, stride));
  }
  if (size > best_ratio * compressed_size) {
    file.fail_at_offset(start, fmt::format("{} compressed bytes cannot hold {} bytes", compressed_size, size));
  }
  std::vector<char> compressed(compressed_size);
  for (std::size_t done = 0; done < compressed.size();) {
    const std::string_view part = file.read(std::min(InputFile::buffer_size, compressed.size() - done));
    std::memcpy(compressed.data() + done, part.data(), part.size());
    done += part.size();
  }
  std::vector<char> bytes(size);
  const unsigned decompressed = lzf_decompress(compressed.data(), static_cast<unsigned>(compressed_size), bytes.data(),
                                               static_cast<unsigned>(size));
  if (decompressed != size) file.fail_at_offset(start + 8, "the compressed body is damaged");
  return bytes;
}

std::string compressed_pcd(std::string_view body) {
  const std::uint64_t room = body.size() + body.size() / 16 + 64;  // LZF grows what it cannot shrink by 1 byte in 32
  if (room > std::numeric_limits<std::uint32_t>::max()) {
    throw InvalidArgument(
        fmt::format("{} bytes do not fit the 4 GiB of PCD binary_compressed; write PCD binary", body.size()));
  }
  std::string compressed(room, '\0');
  const auto size = static_cast<unsigned>(body.size());
  compressed.resize(size == 0 ? 0 : lzf_compress(body.data(), size, compressed.data(), static_cast<unsigned>(room)));
  std::string block;
  append_uint32(block, static_cast<std::uint32_t>(compressed.size()));
  append_uint32(block, size);
  return block + compressed;
}

}  // namespace igsp::io
