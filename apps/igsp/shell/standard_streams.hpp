#pragma once

namespace igsp::cli {

/// Gives a closed standard stream the null device, so that no file that is opened later takes its number and is written
/// into. What goes to a closed standard output is still known to be lost.
void open_closed_streams();

/// Throws FileError unless everything printed so far has been taken by standard output.
void check_standard_output();

}  // namespace igsp::cli
