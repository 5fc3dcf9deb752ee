#pragma once

#include <vector>

#include "spatial/trimmed_cloud.hpp"

namespace igsp {

/// A scan without its stray points.
struct TrimmedScan {
  /// Throws InvalidArgument: as TrimmedCloud, and for a viewpoint that is not finite or parts that are not the cloud's.
  TrimmedScan(const Scan& scan, std::string_view name);

  TrimmedScan in_unit(double unit) const;  ///< the same, all lengths divided by `unit`, a power of two

  std::vector<ScanPart> parts;  ///< nothing where no viewpoint is known; one part, all of the cloud, if it is one scan
  TrimmedCloud cloud;
};

}  // namespace igsp
