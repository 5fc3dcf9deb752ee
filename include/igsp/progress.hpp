#pragma once

#include <functional>
#include <string_view>

namespace igsp {

/// What a running stage reports. `fraction` is the share of the stage done, in [0, 1].
struct Progress {
  std::string_view stage;
  double fraction = 0.0;
};

/// Called from the thread that called the library, several times a stage. Return false to stop: the running function
/// then throws `Cancelled`. An empty callback is never called.
using ProgressCallback = std::function<bool(const Progress&)>;

}  // namespace igsp
