#pragma once

#include <filesystem>
#include <string>

#include "igsp/io.hpp"

namespace igsp::io {

enum class FormatFamily { ply, pcd, las, text, unknown };

FormatFamily family_of(FileFormat format);

/// The family that the extension stands for, in any letter case.
FormatFamily family_of(const std::filesystem::path& path);

/// What to say of a file whose extension is none of igsp's own, and what its owner can do.
std::string unknown_format_of(const std::filesystem::path& path);

/// The extension in lower case, with its dot.
std::string extension_of(const std::filesystem::path& path);

}  // namespace igsp::io
