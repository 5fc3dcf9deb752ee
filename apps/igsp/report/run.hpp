#pragma once

#include <filesystem>

#include "report/json.hpp"

namespace igsp::cli {

/// Reads what `igsp align --report` wrote. Throws FileError with the path and the byte, or the entry that is missing or
/// not what it must be: a report page may rely on all that it shows.
Json read_run(const std::filesystem::path& path);

}  // namespace igsp::cli
