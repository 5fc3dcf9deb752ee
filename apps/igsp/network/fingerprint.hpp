#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace igsp::cli {

/// 32 hexadecimal digits that tell contents apart; not made to withstand an attacker.
std::string fingerprint(std::string_view bytes);

/// The same of a file. Throws FileError.
std::string fingerprint_of_file(const std::filesystem::path& path);

}  // namespace igsp::cli
