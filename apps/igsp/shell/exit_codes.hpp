#pragma once

namespace igsp::cli {

inline constexpr int exit_registered = 0;  ///< also: success of the other commands
inline constexpr int exit_not_registered = 1;
inline constexpr int exit_usage = 2;         ///< unknown command, flag or option, value out of range
inline constexpr int exit_input_output = 3;  ///< a file that cannot be read or written
inline constexpr int exit_internal = 4;      ///< a defect of the program
// After a signal: interrupt_exit_code() in interrupt.hpp.

}  // namespace igsp::cli
