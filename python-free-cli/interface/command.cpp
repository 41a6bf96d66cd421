#include "interface/command.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/text.hpp"
#include "interface/reading.hpp"
#include "lobe/core/error.hpp"

namespace lobe::cli {
namespace {

double to_number(std::string_view option, std::string_view text) {
  double value = 0;
  if (!parse_number(trim(text), value)) {
    throw ArgumentError("'" + std::string(text) + "' in --" + std::string(option) +
                        " is not a number; expected one without a unit, such as 30, 0.5 or 1e-6");
  }
  return value;
}

/// Options of files wherever a material may be one.
std::vector<Command> with_file_options(std::vector<Command> commands) {
  for (Command& command : commands) {
    if (std::ranges::none_of(command.positionals, &Positional::is_material)) continue;
    const auto options = reading_options();
    command.options.insert(command.options.end(), options.begin(), options.end());
  }
  return commands;
}

}  // namespace

std::span<const Command> commands() {
  static const std::vector<Command> kCommands =
      with_file_options({run_command(),        new_study_command(),    report_command(),
                         product_command(),    norm_command(),         distance_command(),
                         angle_command(),      gram_command(),         distance_matrix_command(),
                         agreement_command(),  approximate_command(),  fit_command(),
                         eval_command(),       albedo_command(),       mean_albedo_command(),
                         sample_command(),     preview_command(),      check_command(),
                         tabulate_command(),   import_command(),       export_command(),
                         compose_command(),    self_compose_command(), mix_command(),
                         scale_command(),      transpose_command(),    resample_command(),
                         info_command(),       verify_command(),       plot_command(),
                         spectrum_command(),   square_root_command(),  solve_command(),
                         pump_command(),       balance_command(),      normalise_command(),
                         symmetrise_command(), models_command(),       devices_command(),
                         help_command()});
  return kCommands;
}

std::span<const Option> common_options() {
  static const std::array kOptions{
      Option{.name = "device",
             .value = "SELECTOR",
             .help = "OpenCL device as PLATFORM[:DEVICE], each a number or a piece of the name, for example portable:0 "
                     "(else $LOBE_DEVICE, else the first one with double precision)"},
      Option{.name = "precision",
             .value = "KIND",
             .help = "arithmetic of the models: double (default) or single",
             .choices = {"double", "single"}},
      Option{.name = "quiet", .letter = 'q', .help = "only results and errors: no progress, no warnings"},
      Option{.name = "no-progress", .help = "no progress line; there is none either where errors go to no terminal"},
      Option{
          .name = "verbose", .letter = 'v', .help = "also show intermediate results, where the time went, build logs"},
      Option{.name = "color",
             .value = "WHEN",
             .help = "auto (default), always or never; NO_COLOR and TERM=dumb are respected",
             .choices = {"auto", "always", "never"}},
      Option{.name = "help", .letter = 'h', .help = "show this text and exit"},
      Option{.name = "version", .help = "show version, commit and libraries, and exit"}};
  return kOptions;
}

Option json_option() {
  return {.name = "json", .help = "print one JSON object instead of text"};
}

Option set_option() {
  return {.name = "set",
          .value = "KEY=VALUE",
          .help = "set a value of the study file (study.tolerance=1e-4, family.Ward.m=[0.1,0.2]); to be repeated"};
}

Option tolerance_option(std::string_view what) {
  return {.name = "tolerance", .value = "X", .help = what};
}

Option strict_option() {
  return {.name = "strict", .help = "fail where a value misses the tolerance, instead of a warning"};
}

std::vector<double> numbers_in(std::string_view option, std::string_view list) {
  std::vector<double> values;
  for (const auto part : split(list, ',')) values.push_back(to_number(option, part));
  return values;
}

const std::string& Arguments::text(std::string_view name) const {
  static const std::string kNone;
  const auto found = values_.find(name);
  return found == values_.end() || found->second.empty() ? kNone : found->second.back();
}

std::span<const std::string> Arguments::texts(std::string_view name) const {
  const auto found = values_.find(name);
  return found == values_.end() ? std::span<const std::string>{} : found->second;
}

double Arguments::number(std::string_view name) const {
  return to_number(name, text(name));
}

unsigned Arguments::count(std::string_view name, unsigned largest) const {
  const double value = number(name);
  if (!(value >= 1 && value <= largest) || value != std::floor(value)) {
    throw ArgumentError("--" + std::string(name) + " " + text(name) +
                        " is out of range; expected a whole number from 1 to " + std::to_string(largest));
  }
  return static_cast<unsigned>(value);
}

std::vector<std::string> Arguments::words(std::string_view name) const {
  std::vector<std::string> words;
  const std::string list = text(name);
  for (const auto word : split(list, ',')) words.emplace_back(trim(word));
  return words;
}

}  // namespace lobe::cli
