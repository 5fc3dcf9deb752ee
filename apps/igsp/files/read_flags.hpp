#pragma once

#include <CLI/CLI.hpp>

#include "igsp/io.hpp"
#include "shell/help_text.hpp"

namespace igsp::cli {

/// Adds --columns and --keep-noise, which fill `options`; they live as long as the command.
inline void add_read_flags(CLI::App& command, ReadOptions& options) {
  command
      .add_option("--columns", options.columns,
                  wrapped("text files: the columns of x, y and z, by name or by number from 1, such as "
                          "Easting,Northing,Height or 2,3,4; by default found by their names"))
      ->delimiter(',')
      ->expected(3)
      ->type_name("X,Y,Z");
  command.add_flag(
      "--keep-noise", options.keep_noise,
      wrapped("LAS and LAZ: with the points that are classified as noise (7, 18) or withheld, which are left "
              "out by default"));
}

}  // namespace igsp::cli
