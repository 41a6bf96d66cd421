#include "help.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "core/text.hpp"
#include "lobe/version.hpp"
#include "report.hpp"

namespace lobe::cli {
namespace {

constexpr std::size_t kIndent = 26;  // where explanations begin

std::string entry(std::string_view left, std::string_view explanation) {
  std::string line = fmt::format("  {:<{}}", left, kIndent - 2);
  if (line.size() > kIndent) line += fmt::format("\n{:{}}", "", kIndent);
  return line + wrap(explanation, kIndent) + "\n";
}

std::string entry(const Option& option) {
  std::string left = option.letter == '\0' ? "    " : fmt::format("-{}, ", option.letter);
  left += fmt::format("--{}", option.name);
  if (!option.value.empty()) left += fmt::format(" {}", option.value);
  return entry(left, option.help);
}

std::string examples_text(std::span<const Example> examples) {
  std::string text = "\nExamples:\n";
  for (const auto& example : examples) text += fmt::format("  # {}\n  {}\n", example.purpose, example.line);
  return text;
}

constexpr std::string_view kMaterial =
    "A MATERIAL is MODEL[:key=value,...], where besides the model's parameters scale=x multiplies it; several are "
    "added by '+', as in lambert:scale=0.3+ward:m=0.1,scale=0.5. Or it is the path of a .toml file, or of a table "
    "(.h5).";

}  // namespace

std::string help_text(std::span<const Command> commands) {
  std::string text =
      "lobe composes reflectance functions (BRDFs) and measures how alike they are, on\nOpenCL devices.\n\n";
  text += "Usage: lobe COMMAND [ARGUMENTS] [OPTIONS]\n";
  std::string_view group;
  for (const auto& command : commands) {
    if (command.group != group) text += fmt::format("\n{}:\n", command.group);
    group = command.group;
    text += entry(command.name, command.summary);
  }
  text += "\nOptions, before or after the command:\n";
  for (const auto& option : common_options()) text += entry(option);
  text += fmt::format("\n{}\n", wrap(kMaterial, 0));
  text +=
      "\nExit status: 0 done; 1 the comparison asked for does not hold; 2 mistake on the\n"
      "command line or in a study file; 3 file cannot be read or written; 4 OpenCL\n"
      "device missing or failing; 5 quantity cannot be computed; 130 interrupted.\n";
  text += examples_text(std::vector<Example>{{"what there is to compare", "lobe models"},
                                             {"distance of two materials", "lobe distance phong:n=20 ward:m=0.2"}});
  text += "\n'lobe COMMAND --help' explains one command.\n";
  return text;
}

std::string help_text(const Command& command) {
  std::string text = fmt::format("lobe {}: {}\n\nUsage: lobe {}", command.name, command.summary, command.name);
  for (const auto& positional : command.positionals) {
    text += positional.required ? fmt::format(" {}", positional.name) : fmt::format(" [{}]", positional.name);
    if (positional.is_repeated) text += "...";
  }
  for (const auto& option : command.options) {
    if (option.required) text += fmt::format(" --{} {}", option.name, option.value);
  }
  text += " [OPTIONS]\n";
  for (const auto paragraph : split(command.description, '\n')) text += fmt::format("\n{}\n", wrap(paragraph, 0));
  if (!command.positionals.empty()) text += "\nArguments:\n";
  for (const auto& positional : command.positionals) text += entry(positional.name, positional.help);
  text += "\nOptions:\n";
  for (const auto& option : command.options) text += entry(option);
  text += "\nCommon options:\n";
  for (const auto& option : common_options()) text += entry(option);
  if (std::ranges::any_of(command.positionals, &Positional::is_material))
    text += fmt::format("\n{}\n", wrap(kMaterial, 0));
  return text + examples_text(command.examples);
}

std::string version_text() {
  return fmt::format("lobe {}\ncommit: {}\nOpenCL headers: {}\nHDF5: {}\n", version(), commit(),
                     opencl_headers_version(), hdf5_version().substr(hdf5_version().rfind(' ') + 1));
}

}  // namespace lobe::cli
