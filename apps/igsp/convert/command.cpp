#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <iostream>

#include "files/cloud_to_cloud.hpp"
#include "files/foreign_formats.hpp"
#include "files/moved_output.hpp"
#include "igsp/errors.hpp"
#include "io/file_format.hpp"
#include "io/moved_copy.hpp"
#include "io/rows.hpp"
#include "shell/commands.hpp"
#include "shell/exit_codes.hpp"
#include "shell/help_text.hpp"
#include "shell/progress_bar.hpp"

namespace igsp::cli {
namespace {

struct ConvertSettings {
  CloudToCloud clouds;
  std::string encoding;  // empty: the source's own where it has the same format, else binary
};

constexpr std::size_t no_sample = 1000;  // points kept of the first pass, which only counts

FileFormat encoded(FileFormat format, const std::string& encoding) {
  const io::FormatFamily family = io::family_of(format);
  if (encoding.empty()) return format;
  if (family == io::FormatFamily::ply && encoding == "ascii") return FileFormat::ply_ascii;
  if (family == io::FormatFamily::ply && encoding == "binary") return FileFormat::ply_binary_little_endian;
  if (family == io::FormatFamily::pcd && encoding == "ascii") return FileFormat::pcd_ascii;
  if (family == io::FormatFamily::pcd && encoding == "binary") return FileFormat::pcd_binary;
  if (family == io::FormatFamily::pcd && encoding == "compressed") return FileFormat::pcd_binary_compressed;
  throw InvalidArgument(
      fmt::format("--encoding {}: PLY is written as ascii or binary, PCD as ascii, binary or compressed", encoding));
}

// Between igsp's own formats.
std::vector<std::string> convert_rows(const CloudToCloud& clouds, const CloudInput& source, FileFormat format,
                                      const ProgressCallback& progress) {
  io::InputFile file(clouds.source);
  io::RowSource rows = io::open_rows(file, clouds.read);
  io::AtomicFile output(clouds.output);
  io::write_rows(output, rows, {format, io::extension_of(clouds.output), source.total, progress});
  output.commit();
  if (rows.left_out.empty()) return {};
  return {fmt::format("{} has no place for {}", clouds.output.string(), fmt::join(rows.left_out, ", "))};
}

int run_convert(const ConvertSettings& settings) {
  const CloudToCloud& clouds = settings.clouds;
  check_cloud_to_cloud(clouds);
  check_moved_output(clouds.source, clouds.output);
  ProgressBar bar(!clouds.quiet);
  const Transformation stays = Transformation::Identity();
  CloudInput source;
  source.path = clouds.source;
  source.options = clouds.read;
  const bool survey = moves_foreign(clouds.source, clouds.output);
  const FileFormat format = survey ? FileFormat::text : encoded(format_of(clouds.output), settings.encoding);
  if (survey && !settings.encoding.empty()) {
    throw InvalidArgument(
        fmt::format("--encoding {}: the name of {} says how it is written", settings.encoding, clouds.output.string()));
  }
  const bool own = !reads_foreign(clouds.source);
  std::vector<std::string> notes;
  if (survey || (own && settings.encoding.empty() && io::keeps_properties(clouds.source, clouds.output))) {
    notes = write_moved_output(source, clouds.output, stays, HUGE_VAL, bar.callback());
  } else {
    source = sample_cloud(clouds.source, no_sample, "read", bar.callback(), clouds.read);
    notes = own ? convert_rows(clouds, source, format, bar.callback())
                : write_moved_output(source, clouds.output, stays, 0.0, bar.callback());
  }
  bar.finish();
  print_left_out(clouds, source);
  for (const std::string& note : notes) std::cout << note << "\n";
  return exit_registered;
}

constexpr const char* examples =
    "Examples:\n"
    "  igsp convert scan.pcd -o scan.ply\n"
    "  igsp convert scan.ply -o scan.csv\n"
    "  igsp convert scan.ply -o small.pcd --encoding compressed\n"
    "PLY, PCD, LAS and text (XYZ, TXT, CSV, PTS) with all numbers that belong to the points, chunk by chunk: names and "
    "packed\n"
    "colours change to what programs expect, values do not. The command of the Python package reads LAZ, E57 and PTX\n"
    "as well (x, y and z alone), and turns LAS into LAZ and back with all that they hold. LAS is written from LAS "
    "alone.";

}  // namespace

void add_convert_command(CLI::App& app, Command& command) {
  CLI::App* convert = app.add_subcommand("convert", "a cloud in another format, with all that belongs to its points");
  const auto settings = std::make_shared<ConvertSettings>();
  add_cloud_to_cloud_flags(*convert, settings->clouds, "the cloud in the format that FILE's name says");
  convert
      ->add_option("--encoding", settings->encoding,
                   wrapped("of PLY and PCD; by default binary, or as CLOUD is where it has the same format"))
      ->type_name("ascii|binary|compressed");
  convert->footer(examples);
  convert->callback([settings, &command] { command = [settings] { return run_convert(*settings); }; });
}

}  // namespace igsp::cli
