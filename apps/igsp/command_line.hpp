#pragma once

#include "files/foreign_formats.hpp"

namespace igsp::cli {

/// The igsp command: understands the command line, runs the subcommand, turns errors into a message and an exit code.
/// `formats` are read and written beside its own.
int run(int argc, char** argv, ForeignFormats formats = {});

}  // namespace igsp::cli
