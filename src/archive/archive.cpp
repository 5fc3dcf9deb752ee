#include "archive/archive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "igsp/archive.hpp"
#include "igsp/errors.hpp"
#include "igsp/version.hpp"
#include "io/atomic_file.hpp"
#include "io/input_file.hpp"

namespace igsp {
namespace archive {
namespace {

// A byte that is no text, and line ends that a transfer as text would change.
constexpr std::string_view magic = "\x89igsp\r\n\x1a";

std::uint64_t fnv1a(std::string_view bytes) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const char byte : bytes) hash = (hash ^ static_cast<unsigned char>(byte)) * 0x100000001b3;
  return hash;
}

template <typename... Structs>
std::string describe_all(std::type_identity<std::tuple<Structs...>>) {
  return (... + Codec<Structs>::describe_fields());
}

std::uint64_t fingerprint() {
  return fnv1a(describe_all(std::type_identity<AllStructs>()));
}

struct Header {
  unsigned form;
  std::string_view igsp_version;
  std::string_view name;
  std::uint64_t fingerprint;
};

Header read_header(Decoder& in) {
  if (in.remaining() < magic.size() || in.raw(magic.size()) != magic) {
    throw Fault("these are no features or results that igsp wrote");
  }
  Header header{};
  header.form = in.scalar<std::uint32_t>();
  header.igsp_version = in.text();
  header.name = in.text();
  header.fingerprint = in.scalar<std::uint64_t>();
  return header;
}

void require_readable(const Header& header, std::string_view name) {
  if (header.form != form || header.fingerprint != fingerprint()) {
    throw Fault(
        fmt::format("written by igsp {} in form {} with other fields than this igsp {}, which reads form {}; "
                    "read it with the version that wrote it, or compute it again",
                    header.igsp_version, header.form, version, form));
  }
  if (header.name != name) throw Fault(fmt::format("it holds {}, not {}", header.name, name));
}

std::string_view checked_body(Decoder& in, std::string_view bytes) {
  const auto size = in.scalar<std::uint64_t>();
  constexpr std::size_t checksum_size = 8;
  if (in.remaining() < checksum_size || size != in.remaining() - checksum_size) {
    in.fail(fmt::format("{} bytes and a checksum of {} must follow, but {} do: cut off, or more was appended", size,
                        checksum_size, in.remaining()));
  }
  const std::string_view body = in.raw(static_cast<std::size_t>(size));
  if (in.scalar<std::uint64_t>() != fnv1a(bytes.substr(0, bytes.size() - checksum_size))) {
    throw Fault("the checksum does not hold: it was changed since it was written");
  }
  return body;
}

}  // namespace

std::string sealed(std::string_view name, std::string_view body) {
  Encoder out;
  out.raw(magic);
  out.scalar(form);
  out.text(version);
  out.text(name);
  out.scalar(fingerprint());
  out.text(body);
  out.scalar(fnv1a(out.bytes()));
  return std::move(out).take();
}

std::string_view opened(std::string_view name, std::string_view bytes) {
  Decoder in(bytes);
  require_readable(read_header(in), name);
  return checked_body(in, bytes);
}

}  // namespace archive

namespace {

template <typename T>
void write_file(const std::filesystem::path& path, const T& value) {
  io::AtomicFile file(path);
  file.write(archive::pack(value));
  file.commit();
}

template <typename T>
T read_file(const std::filesystem::path& path) {
  io::InputFile file(path);
  std::string bytes;
  while (true) {
    const std::string_view chunk = file.peek(io::InputFile::buffer_size);
    if (chunk.empty()) break;
    bytes.append(file.read(chunk.size()));
  }
  try {
    return archive::unpack<T>(bytes);
  } catch (const archive::Fault& fault) {
    throw FileError(fmt::format("{}: {}", path.string(), fault.what()));
  }
}

template <typename T>
T from_bytes(std::string_view bytes) {
  try {
    return archive::unpack<T>(bytes);
  } catch (const archive::Fault& fault) {
    throw InvalidArgument(fmt::format("bytes of {}: {}", archive::Layout<T>::name, fault.what()));
  }
}

}  // namespace

void write_features(const std::filesystem::path& path, const Features& features) {
  write_file(path, features);
}

void write_result(const std::filesystem::path& path, const Result& result) {
  write_file(path, result);
}

Features read_features(const std::filesystem::path& path) {
  return read_file<Features>(path);
}

Result read_result(const std::filesystem::path& path) {
  return read_file<Result>(path);
}

std::string to_bytes(const Features& features) {
  return archive::pack(features);
}

std::string to_bytes(const Result& result) {
  return archive::pack(result);
}

Features features_from_bytes(std::string_view bytes) {
  return from_bytes<Features>(bytes);
}

Result result_from_bytes(std::string_view bytes) {
  return from_bytes<Result>(bytes);
}

}  // namespace igsp
