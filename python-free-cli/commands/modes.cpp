#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "interface/command.hpp"
#include "interface/operand_json.hpp"
#include "interface/options.hpp"
#include "interface/output_file.hpp"
#include "interface/session.hpp"
#include "interface/table_report.hpp"
#include "lobe/core/error.hpp"
#include "lobe/formats/modes_file.hpp"
#include "lobe/reflectance/azimuthal_modes.hpp"

namespace lobe::cli {
namespace {

constexpr Text kConvention{"convention"};
constexpr Text kCosines{"cosines"};
constexpr Text kCosinesIn{"cosines-in"};
constexpr Count kModes{"modes"};
constexpr std::size_t kUsual = 16;  // cosines, and modes

/// Cosines by their number, with weights, or one by one.
CosineRule cosines_of(const Handle& option, const std::string& text) {
  constexpr double kMost = 1000;
  const std::vector<double> numbers = numbers_in(option, text);
  if (text.find_first_not_of("0123456789") == std::string::npos) {
    if (numbers.front() >= 1 && numbers.front() <= kMost) return cosine_rule(static_cast<std::size_t>(numbers.front()));
    throw ArgumentError(option.dashed() + " " + text + "; expected 1 to 1000 nodes, or a list of cosines");
  }
  if (std::ranges::adjacent_find(numbers, std::greater_equal{}) != numbers.end()) {
    throw ArgumentError(option.dashed() + " " + text + " does not rise; expected a number of nodes, or a rising list");
  }
  return {numbers, {}};
}

Json list_json(const std::vector<double>& numbers) {
  Json all = Json::array();
  for (const double number : numbers) all.push_back(to_json(number));
  return all;
}

/// Numbers by channel, mode, viewer and light.
Json nested_json(const AzimuthalModes& modes, const std::vector<double>& numbers) {
  Json all = Json::array();
  for (std::size_t c = 0; c < modes.channels.size(); ++c) {
    Json of_channel = Json::array();
    for (std::size_t m = 0; m < modes.count; ++m) {
      Json of_mode = Json::array();
      for (std::size_t out = 0; out < modes.cosines_out.size(); ++out) {
        Json row = Json::array();
        for (std::size_t in = 0; in < modes.cosines_in.size(); ++in)
          row.push_back(to_json(numbers[modes.at(c, m, out, in)]));
        of_mode.push_back(std::move(row));
      }
      of_channel.push_back(std::move(of_mode));
    }
    all.push_back(std::move(of_channel));
  }
  return all;
}

std::string rows_text(const AzimuthalModes& modes, bool color) {
  std::vector<std::vector<std::string>> rows{{"mode", "cosine_in", "cosine_out"}};
  for (const auto& channel : modes.channels) rows.front().push_back(channel);
  for (std::size_t m = 0; m < modes.count; ++m) {
    for (std::size_t out = 0; out < modes.cosines_out.size(); ++out) {
      for (std::size_t in = 0; in < modes.cosines_in.size(); ++in) {
        rows.push_back({std::to_string(m), fmt::format("{:.6g}", modes.cosines_in[in]),
                        fmt::format("{:.6g}", modes.cosines_out[out])});
        for (std::size_t c = 0; c < modes.channels.size(); ++c) {
          const std::size_t at = modes.at(c, m, out, in);
          rows.back().push_back(format_estimate({modes.values[at], modes.errors[at]}));
        }
      }
    }
  }
  return format_table(rows, 0, color);
}

std::string by_channel(const AzimuthalModes& modes, const std::vector<double>& numbers) {
  std::string text;
  for (std::size_t c = 0; c < numbers.size(); ++c) {
    text += fmt::format("{}{:.2g}{}", c == 0 ? "" : ", ", numbers[c],
                        numbers.size() == 1 ? "" : " (" + modes.channels[c] + ")");
  }
  return text;
}

ExitCode execute_modes(Session& session) {
  const auto& arguments = session.arguments();
  const CosineRule viewer =
      arguments.has(kCosines) ? cosines_of(kCosines, arguments.text(kCosines)) : cosine_rule(kUsual);
  const CosineRule light = arguments.has(kCosinesIn) ? cosines_of(kCosinesIn, arguments.text(kCosinesIn)) : viewer;
  const std::size_t count = arguments.has(kModes) ? arguments.count(kModes, kMostModes) : kUsual;
  AzimuthalModesOptions options{
      .precision = session.precision(), .missed = session.missed(), .progress = session.progress()};
  if (arguments.has(option::tolerance)) options.tolerance = session.tolerance(0);
  if (arguments.has(kConvention)) options.convention = parse_mode_convention(arguments.text(kConvention));
  const OutputFile output(session);
  std::optional<ModesFormat> format;
  if (output.is_wanted()) {
    format = takes_standard_output(arguments) ? ModesFormat::hdf5 : modes_format_of(output.path());
  }
  const Operand operand = session.operand(argument::material);

  const AzimuthalModes modes =
      azimuthal_modes(session.device(), session.reflectance(operand), light.cosines, viewer.cosines, count, options);

  if (format) output.write(modes_file(modes, *format, session.command_line()));
  session.end_progress();
  if (takes_standard_output(arguments)) return ExitCode::success;
  const bool is_brdf = modes.convention == ModeConvention::brdf;
  if (session.wants_json()) {
    Json answer = json_answer("modes");
    answer["material"] = operand_json(operand);
    answer["convention"] = mode_convention_names()[static_cast<std::size_t>(modes.convention)];
    answer["units"] = {{"modes", is_brdf ? "sr^-1" : "1"}, {"one_sided", "sr^-1"}};
    answer["channels"] = modes.channels;
    answer["cosines_in"] = list_json(modes.cosines_in);
    answer["cosines_out"] = list_json(modes.cosines_out);
    if (!light.weights.empty()) answer["weights_in"] = list_json(light.weights);
    if (!viewer.weights.empty()) answer["weights_out"] = list_json(viewer.weights);
    if (format) {
      answer["file"] = output.path().string();
    } else {
      answer["modes"] = nested_json(modes, modes.values);
      answer["errors"] = nested_json(modes, modes.errors);
    }
    answer["largest_error"] = to_json(std::ranges::max(modes.errors));
    answer["left_out"] = list_json(modes.left_out);
    answer["one_sided"] = list_json(modes.one_sided);
    answer["tolerance"] = modes.tolerance;
    answer["reached_tolerance"] = session.reached_tolerance();
    answer["device"] = to_json(session.device().info());
    session.print_json(answer);
    return ExitCode::success;
  }
  if (!format) {
    session.print(rows_text(modes, session.colors_output()));
    return ExitCode::success;
  }
  session.print(
      fields_text({{"modes", fmt::format("{}, at {} x {} cosines of viewer and light", modes.count,
                                         modes.cosines_out.size(), modes.cosines_in.size())},
                   {"convention", is_brdf ? "f = f_0 + 2 sum f_m cos(m phi), sr^-1, phi = 0 on the retro side"
                                          : "pi f = sum rho_m cos(m phi), phi = 0 on the mirror side"},
                   {"largest error", fmt::format("{:.2g}{}", std::ranges::max(modes.errors), is_brdf ? " sr^-1" : "")},
                   {"left out", by_channel(modes, modes.left_out) + " (root mean square, relative)"},
                   {"file", output.path().string()}}));
  return ExitCode::success;
}

}  // namespace

Command modes_command() {
  return {
      .name = "modes",
      .group = "Materials",
      .summary = "compute azimuthal modes for radiative transfer",
      .description =
          "Computes the Fourier coefficients of an isotropic reflectance over the azimuth between light and viewer, at "
          "the quadrature cosines of a radiative-transfer solver: the lower boundary of a discrete-ordinate "
          "calculation. Each has its error. How much the modes leave out of the reflectance is printed when a file is "
          "written, and stands in the JSON answer. A file holds HDF5 that netCDF tools read (.h5, .nc), with errors, "
          "or a NumPy array [mode][out][in] (.npy), with the channel in front if there are several. With --convention "
          "brdf (default) f = f_0 + 2 sum f_m cos(m phi), and phi = 0 is the retro side; with disort pi f = sum rho_m "
          "cos(m phi), and phi = 0 is the mirror side. Of a reflectance that is not the same on both sides of the "
          "plane of incidence the modes are those of the mean of both.",
      .positionals = {{.handle = argument::material, .help = "the material, file or table", .is_material = true}},
      .options =
          {{.handle = kCosines,
            .value = "N|LIST",
            .help =
                "number of Gauss nodes in (0, 1), or a rising list of cosines (1.0 alone is the normal), of viewer and "
                "light (default 16)"},
           {.handle = kCosinesIn,
            .value = "N|LIST",
            .help = "those of the light alone, for example that of the sun (default: as the viewer's)"},
           {.handle = kModes, .value = "N", .help = "number of modes, from mode 0 on, at most 512 (default 16)"},
           {.handle = kConvention,
            .value = "NAME",
            .help = "brdf (default) or disort",
            .choices = mode_convention_names()},
           {.handle = option::output,
            .letter = 'o',
            .value = "FILE",
            .help = "the file (.h5, .nc or .npy); without it, modes are printed"},
           {.handle = option::force, .letter = 'f', .help = "replace an existing file"},
           tolerance_option("largest error relative to the root mean square over the azimuth (default: 1e-8 for "
                            "formulas, 1e-4 for files, tables and single precision)"),
           strict_option(),
           json_option()},
      .examples = {{"a soil under 8 + 8 streams, as the lower boundary of DISORT",
                    "lobe modes hapke_isotropic:g=5 --cosines 8 --convention disort -o soil.nc"},
                   {"the modes under a sun 60 degrees from the normal",
                    "lobe modes rpv:rho=0.1,k=0.7,asymmetry=0.1 --cosines 0.3,0.6,0.9 --cosines-in 0.5 --modes 3"}},
      .execute = execute_modes};
}

}  // namespace lobe::cli
