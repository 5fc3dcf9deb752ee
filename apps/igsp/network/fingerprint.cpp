#include "network/fingerprint.hpp"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <vector>

#include "igsp/errors.hpp"

namespace igsp::cli {
namespace {

constexpr std::size_t chunk = std::size_t{1} << 20;  // a multiple of the word

// Two independent sums over words of eight bytes, each a bijection of its state for a given word.
class Fingerprint {
 public:
  // All but the last piece must be whole words.
  void add(const char* bytes, std::size_t size) {
    size_ += size;
    for (std::size_t i = 0; i < size; i += 8) {
      std::uint64_t word = 0;
      std::memcpy(&word, bytes + i, std::min<std::size_t>(8, size - i));
      for (std::size_t k = 0; k < 2; ++k) state_[k] = mix(state_[k] ^ word, multiplier[k]);
    }
  }
  std::string text() const {
    std::array<std::uint64_t, 2> last = state_;
    for (std::size_t k = 0; k < 2; ++k) last[k] = mix(mix(last[k] ^ size_, multiplier[k]), multiplier[1 - k]);
    return fmt::format("{:016x}{:016x}", last[0], last[1]);
  }

 private:
  static constexpr std::array<std::uint64_t, 2> multiplier = {0x9e3779b97f4a7c15, 0xd1342543de82ef95};
  static std::uint64_t mix(std::uint64_t state, std::uint64_t odd) {
    state *= odd;
    return std::rotl(state, 29) ^ (state >> 32);
  }
  std::array<std::uint64_t, 2> state_ = {1, 2};
  std::uint64_t size_ = 0;
};

}  // namespace

std::string fingerprint(std::string_view bytes) {
  Fingerprint sum;
  sum.add(bytes.data(), bytes.size());
  return sum.text();
}

std::string fingerprint_of_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw FileError(fmt::format("{}: cannot be opened", path.string()));
  Fingerprint sum;
  std::vector<char> buffer(chunk);
  do {
    file.read(buffer.data(), static_cast<std::streamsize>(buffer.size()));
    sum.add(buffer.data(), static_cast<std::size_t>(file.gcount()));
  } while (file);
  if (file.bad()) throw FileError(fmt::format("{}: cannot be read", path.string()));
  return sum.text();
}

}  // namespace igsp::cli
