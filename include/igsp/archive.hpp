#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "igsp/features.hpp"
#include "igsp/result.hpp"

namespace igsp {

// Features and results for later, for another process or another machine: bytes with a version, a checksum and a fixed
// byte order, read back bit for bit by the igsp that wrote them and by every other that knows the same form and the
// same fields. Nothing else is read: what is cut, changed, of another version or inconsistent in itself is refused.

/// Throw FileError. A file appears complete or not at all.
void write_features(const std::filesystem::path& path, const Features& features);
void write_result(const std::filesystem::path& path, const Result& result);

/// Throw FileError with path and reason.
Features read_features(const std::filesystem::path& path);
Result read_result(const std::filesystem::path& path);

/// The same in memory.
std::string to_bytes(const Features& features);
std::string to_bytes(const Result& result);

/// Throw InvalidArgument with the reason.
Features features_from_bytes(std::string_view bytes);
Result result_from_bytes(std::string_view bytes);

}  // namespace igsp
