#pragma once

#include <algorithm>
#include <cstdint>
#include <string_view>

#include "igsp/errors.hpp"
#include "igsp/progress.hpp"

namespace igsp {

/// Throws Cancelled when the callback answers false. An empty one is never called.
inline void report_progress(const ProgressCallback& progress, std::string_view stage, double fraction) {
  if (progress && !progress({stage, fraction})) throw Cancelled();
}

/// `done` of `all`, which a header may have declared too few, or not at all (0).
inline void report_progress(const ProgressCallback& progress, std::string_view stage, std::uint64_t done,
                            std::uint64_t all) {
  report_progress(progress, stage, all > 0 ? std::min(1.0, static_cast<double>(done) / static_cast<double>(all)) : 0.0);
}

}  // namespace igsp
