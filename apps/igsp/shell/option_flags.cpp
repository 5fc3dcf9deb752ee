#include "shell/option_flags.hpp"

#include <fmt/format.h>

#include "config/option_list.hpp"
#include "config/preset.hpp"
#include "config/toml_file.hpp"
#include "igsp/errors.hpp"
#include "shell/help_text.hpp"

namespace igsp::cli {
namespace {

// What may be typed is spelt out where it is a choice; completion reads it from here.
std::string type_name(const Option& option) {
  if (option.range.shape == Range::Shape::ends_only) {
    return fmt::format("{}|{}", option.range.low, option.range.high);
  }
  switch (option.kind) {
    case OptionKind::integer:
      return "INTEGER";
    case OptionKind::real:
      return "NUMBER";
    case OptionKind::choice:
      return fmt::format("{}", fmt::join(option.choices, "|"));
    case OptionKind::boolean:
      break;
  }
  return "";
}

std::string description(const Option& option) {
  const std::string unit = option.unit.empty() ? "" : fmt::format(" [{}]", option.unit);
  const std::string range = option.kind == OptionKind::boolean ? "" : "; " + values_in_words(option);
  return wrapped(fmt::format("{}{}{}; default {}", option.help, unit, range, igsp::to_string(option.get(Options{}))));
}

void add_flag(CLI::App& command, const Option& option, std::optional<std::string>& text) {
  const auto store = [&text](const std::string& given) { text = given; };
  const std::string group = option.section.empty() ? "Method" : "Method, " + std::string(option.section);
  if (option.kind == OptionKind::boolean) {
    const std::string name(option.flag.substr(2));
    command
        .add_flag_callback(
            "--" + name, [store] { store("true"); }, description(option))
        ->group(group);
    command
        .add_flag_callback(
            "--no-" + name, [store] { store("false"); }, "the opposite")
        ->group(group);
  } else {
    command.add_option_function<std::string>(std::string(option.flag), store, description(option))
        ->type_name(type_name(option))
        ->group(group);
  }
}

}  // namespace

std::shared_ptr<OptionFlags> add_option_flags(CLI::App& command) {
  auto flags = std::make_shared<OptionFlags>();
  command
      .add_option("--preset", flags->preset,
                  fmt::format("where the options start: {}", fmt::join(preset_names(), " or ")))
      ->type_name(fmt::format("{}", fmt::join(preset_names(), "|")));
  command
      .add_option("--config", flags->config,
                  wrapped("options from a TOML file, as `igsp options` prints it; what it leaves out comes from the "
                          "preset that its key `preset` names; flags override it"))
      ->type_name("FILE");
  flags->texts.resize(option_list().size());
  for (std::size_t i = 0; i < flags->texts.size(); ++i) add_flag(command, option_list()[i], flags->texts[i]);
  return flags;
}

Options resolve(const OptionFlags& flags) {
  if (flags.config && flags.preset) {
    throw InvalidArgument(
        fmt::format("--config and --preset both say where the options start: give one of them, or begin {} with "
                    "preset = \"{}\"",
                    *flags.config, *flags.preset));
  }
  Options options = flags.config ? read_options(*flags.config) : preset(flags.preset.value_or("default"));
  for (std::size_t i = 0; i < flags.texts.size(); ++i) {
    if (flags.texts[i]) assign_text(options, option_list()[i], *flags.texts[i]);
  }
  validate(options);
  return options;
}

}  // namespace igsp::cli
