#pragma once

namespace igsp::cli {

/// The igsp command: understands the command line, runs the subcommand, turns errors into a message and an exit code.
int run(int argc, char** argv);

}  // namespace igsp::cli
