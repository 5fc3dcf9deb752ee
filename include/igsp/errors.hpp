#pragma once

#include <stdexcept>
#include <string>

namespace igsp {

/// The caller's mistake: names the parameter, the value and the admissible range.
class InvalidArgument : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

/// A file that cannot be read or written: names the path and, where it applies, the line or the byte offset.
class FileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The progress callback asked to stop.
class Cancelled : public std::runtime_error {
 public:
  Cancelled() : std::runtime_error("cancelled by the caller") {}
};

}  // namespace igsp
