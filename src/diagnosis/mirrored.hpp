#pragma once

#include <optional>

#include "igsp/diagnosis.hpp"

namespace igsp {

/// Registers the mirror image of the source with the options of the refused answer, at its voxel size.
std::optional<Diagnosis> mirrored(const Scan& source, const Scan& target, const Result& refused,
                                  const ProgressCallback& progress);

}  // namespace igsp
