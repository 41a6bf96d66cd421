#include "interface/command.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "core/text.hpp"
#include "interface/options.hpp"
#include "interface/reading.hpp"
#include "lobe/core/error.hpp"

namespace lobe::cli {
namespace {

double to_number(const Handle& option, std::string_view text) {
  double value = 0;
  if (!parse_number(trim(text), value)) {
    throw ArgumentError("'" + std::string(text) + "' in " + option.dashed() +
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
  static const std::vector<Command> kCommands = with_file_options({run_command(),          merge_command(),
                                                                   new_study_command(),    report_command(),
                                                                   product_command(),      norm_command(),
                                                                   distance_command(),     angle_command(),
                                                                   gram_command(),         distance_matrix_command(),
                                                                   agreement_command(),    approximate_command(),
                                                                   fit_command(),          eval_command(),
                                                                   albedo_command(),       mean_albedo_command(),
                                                                   lut_command(),          modes_command(),
                                                                   sample_command(),       preview_command(),
                                                                   render_command(),       shader_command(),
                                                                   view_command(),         check_command(),
                                                                   tabulate_command(),     import_command(),
                                                                   export_command(),       compose_command(),
                                                                   self_compose_command(), mix_command(),
                                                                   scale_command(),        transpose_command(),
                                                                   resample_command(),     info_command(),
                                                                   verify_command(),       plot_command(),
                                                                   spectrum_command(),     square_root_command(),
                                                                   solve_command(),        pump_command(),
                                                                   balance_command(),      normalise_command(),
                                                                   symmetrise_command(),   models_command(),
                                                                   devices_command(),      help_command()});
  return kCommands;
}

std::span<const Option> common_options() {
  static const std::array kOptions{
      Option{.handle = option::device,
             .value = "SELECTOR",
             .help = "OpenCL device as PLATFORM[:DEVICE], each a number or a piece of the name, for example portable:0 "
                     "(else $LOBE_DEVICE, else the first one with double precision); 'run' takes several of one kind, "
                     "0:0,0:1"},
      Option{.handle = option::precision,
             .value = "KIND",
             .help = "arithmetic of the models: double (default) or single",
             .choices = {"double", "single"}},
      Option{
          .handle = option::memory,
          .value = "SIZE",
          .help = "bound the memory of the process, for example 2G: tables lie in files of $TMPDIR, else of /var/tmp"},
      Option{
          .handle = option::quiet, .letter = 'q', .help = "print only results and errors, no progress and no warnings"},
      Option{.handle = option::no_progress,
             .help = "show no progress line; it only appears if errors go to a terminal"},
      Option{
          .handle = option::verbose, .letter = 'v', .help = "also show intermediate results, timings and build logs"},
      Option{.handle = option::color,
             .value = "WHEN",
             .help = "auto (default), always or never; NO_COLOR and TERM=dumb are respected",
             .choices = {"auto", "always", "never"}},
      Option{.handle = option::help, .letter = 'h', .help = "show this text and exit"},
      Option{.handle = option::version, .help = "show version, commit and libraries, and exit"}};
  return kOptions;
}

Option json_option() {
  return {.handle = option::json, .help = "print one JSON object instead of text"};
}

Option set_option() {
  return {.handle = option::set,
          .value = "KEY=VALUE",
          .help = "set a value of the study file (study.tolerance=1e-4, family.Ward.m=[0.1,0.2]); may be repeated"};
}

Option tolerance_option(std::string_view what) {
  return {.handle = option::tolerance, .value = "X", .help = what};
}

Option strict_option() {
  return {.handle = option::strict,
          .help = "fail where a tolerance is missed or a grid too coarse, instead of warning"};
}

std::vector<double> numbers_in(const Handle& option, std::string_view list) {
  std::vector<double> values;
  for (const auto part : split(list, ',')) values.push_back(to_number(option, part));
  return values;
}

Arguments::Arguments() {
  for (const auto& option : common_options()) declare(option.handle);
}

const std::vector<std::string>* Arguments::find(const Handle& handle) const {
  if (!takes(handle)) {
    throw std::logic_error("'" + std::string(handle.name()) + "' is read by a command that does not declare it");
  }
  const auto found = values_.find(handle.name());
  return found == values_.end() ? nullptr : &found->second;
}

const std::string& Arguments::text(const Text& handle) const {
  static const std::string kNone;
  const auto given = all(handle);
  return given.empty() ? kNone : given.back();
}

std::span<const std::string> Arguments::all(const Handle& handle) const {
  const auto* const found = find(handle);
  return found == nullptr ? std::span<const std::string>{} : *found;
}

double Arguments::number_of(const Text& handle) const {
  return to_number(handle, text(handle));
}

unsigned Arguments::count(const Count& handle, unsigned largest) const {
  const double value = number_of(handle);
  if (!(value >= 1 && value <= largest) || value != std::floor(value)) {
    throw ArgumentError(handle.dashed() + " " + text(handle) + " is out of range; expected a whole number from 1 to " +
                        std::to_string(largest));
  }
  return static_cast<unsigned>(value);
}

std::vector<std::string> Arguments::words(const Words& handle) const {
  std::vector<std::string> words;
  const std::string list = text(handle);
  for (const auto word : split(list, ',')) words.emplace_back(trim(word));
  return words;
}

}  // namespace lobe::cli
