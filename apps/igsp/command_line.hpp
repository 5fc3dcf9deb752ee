#pragma once

#include "files/foreign_formats.hpp"
#include "network/engine.hpp"

namespace igsp::cli {

/// The igsp command: understands the command line, runs the subcommand, turns errors into a message and an exit code.
/// `formats` are read and written beside its own, `dask` is what `igsp network --engine dask` runs on.
int run(int argc, char** argv, ForeignFormats formats = {}, DaskEngine dask = {});

}  // namespace igsp::cli
