#include <fmt/core.h>

#include <initializer_list>
#include <optional>

#include "core/text.hpp"
#include "interface/command.hpp"
#include "interface/deviations.hpp"
#include "interface/operand_json.hpp"
#include "interface/options.hpp"
#include "interface/output_file.hpp"
#include "interface/reading.hpp"
#include "interface/session.hpp"
#include "interface/table_making.hpp"
#include "interface/table_report.hpp"
#include "interface/values_report.hpp"
#include "lobe/core/error.hpp"
#include "lobe/formats/direction_pairs.hpp"
#include "lobe/formats/measurement.hpp"
#include "lobe/reflectance/evaluate.hpp"

namespace lobe::cli {
namespace {

constexpr Numbers kDeltaPhi{"delta-phi"};
constexpr Text kPairs{"pairs"};
constexpr Numbers kPhiIn{"phi-in"};
constexpr Flag kRadians{"radians"};
constexpr Numbers kThetaIn{"theta-in"};
constexpr Numbers kThetaOut{"theta-out"};

std::vector<double> polar_angles(const Arguments& arguments, const Numbers& option) {
  auto angles = arguments.numbers(option);
  for (const double angle : angles) {
    if (!(angle >= 0 && angle <= 90)) {
      throw ArgumentError(
          fmt::format("{} {} is out of range; expected 0 to 90 degrees", option.dashed(), shortest(angle)));
    }
  }
  return angles;
}

std::vector<Directions> all_combinations(const Arguments& arguments) {
  std::vector<Directions> degrees;
  const auto theta_out = polar_angles(arguments, kThetaOut);
  const auto delta_phi = arguments.numbers(kDeltaPhi);
  const auto phi_in = arguments.has(kPhiIn) ? arguments.numbers(kPhiIn) : std::vector<double>{0};
  for (const double azimuth : phi_in) {
    for (const double in : polar_angles(arguments, kThetaIn)) {
      for (const double out : theta_out) {
        for (const double phi : delta_phi) degrees.push_back({in, out, phi, azimuth});
      }
    }
  }
  return degrees;
}

void warn_of_delta(Session& session, const Operand& operand) {
  if (!operand.shape().has_delta()) return;
  session.warn(
      fmt::format("'{}' has delta parts, which have no values; see 'lobe info' and 'lobe albedo'", operand.label()));
}

Json answer_to(const Operand& operand) {
  Json answer = json_answer("eval");
  add_operand(answer, operand);
  answer["units"] = {{"angles", "deg"}, {"brdf", "sr^-1"}};
  return answer;
}

/// Standard deviations of values, as caused by those of the samples, [channel][pair]; none if the file states none.
std::vector<std::vector<double>> deviations_at(Session& session, const Operand& operand,
                                               std::span<const Directions> degrees) {
  const auto replicates = replicated(session, {&operand, 1});
  if (replicates.empty()) return {};
  return measurement_deviations(replicates.front(), replicates.front().at(to_radians(degrees)).value);
}

/// The pairs that options combine.
ExitCode evaluate_given(Session& session, const Operand& operand, std::span<const Directions> degrees) {
  const Device& device = session.device();
  BrdfValues found =
      evaluate(device, session.reflectance(operand), to_radians(degrees), {.precision = session.precision()});
  const auto deviations = deviations_at(session, operand, degrees);
  // Values that the file defines have no numerical error to stand beside a deviation.
  if (!deviations.empty() && found.error.size() == 0) found.error.setZero(found.value.rows(), found.value.cols());
  warn_of_delta(session, operand);
  const bool has_errors = found.error.size() > 0;
  if (session.wants_json()) {
    Json answer = answer_to(operand);
    answer["values"] =
        has_errors ? values_json(degrees, estimates(found), deviations) : values_json(degrees, found.value);
    if (device.is_chosen()) {
      answer["precision"] = to_string(session.precision());
      answer["device"] = to_json(device.info());
    }
    session.print_json(answer);
    return ExitCode::success;
  }
  const bool color = session.colors_output();
  const auto names = channel_names(operand.shape());
  session.print(has_errors ? values_text(degrees, estimates(found), names, color, deviations)
                           : values_text(degrees, found.value, names, color));
  return ExitCode::success;
}

/// The pairs of a list.
ExitCode evaluate_list(Session& session) {
  const auto& arguments = session.arguments();
  for (const Numbers& option : {kThetaIn, kThetaOut, kDeltaPhi, kPhiIn}) {
    if (arguments.has(option)) {
      throw ArgumentError(option.dashed() + " and --pairs are given, whose file says all directions; choose one");
    }
  }
  const OutputFile output(session);
  if (session.wants_json() && !output.is_wanted()) {
    throw ArgumentError("--json says of --pairs what was written; give a file by --output, or leave out --json");
  }
  const auto operand = session.operand(argument::material);
  const Reflectance reflectance = session.reflectance(operand);
  const auto replicates = replicated(session, {&operand, 1});
  const PairOptions options{.radians = arguments.has(kRadians),
                            .overwrite = output.overwrites(),
                            .precision = session.precision(),
                            .replicated = replicates.empty() ? std::nullopt : std::optional(replicates.front()),
                            .progress = session.progress()};
  const std::string& pairs = arguments.text(kPairs);
  std::string text;
  const PairSummary found = output.is_wanted()
                                ? evaluate_pairs(session.device(), reflectance, pairs, output.path(), options)
                                : evaluate_pairs(session.device(), reflectance, pairs, text, options);
  session.end_progress();
  warn_of_delta(session, operand);
  if (found.may_be_radians) {
    session.warn("the angles of " + pairs +
                 " are taken as degrees, and none is above 6.3; if they are radians, say --radians");
  }
  if (session.wants_json()) {
    Json answer = answer_to(operand);
    answer["file"] = output.path().string();
    answer["pairs"] = found.pairs;
    answer["directions"] = found.directions;
    answer["values"] = found.values;
    session.print_json(answer);
  } else if (output.is_wanted()) {
    session.print(fmt::format("{} ({} pairs)\n", output.path().string(), found.pairs));
  } else {
    session.print(text);
  }
  return ExitCode::success;
}

ExitCode execute_eval(Session& session) {
  const auto& arguments = session.arguments();
  if (arguments.has(kPairs)) return evaluate_list(session);
  for (const Numbers& option : {kThetaIn, kThetaOut, kDeltaPhi}) {
    if (!arguments.has(option)) {
      throw ArgumentError("'lobe eval' needs " + option.dashed() +
                          ", or all directions by --pairs; see 'lobe eval --help'");
    }
  }
  for (const Handle& other : std::initializer_list<Handle>{kRadians, option::output, option::force}) {
    if (arguments.has(other)) throw ArgumentError(other.dashed() + " belongs to --pairs; leave it out");
  }
  const auto operand = session.operand(argument::material);
  return evaluate_given(session, operand, all_combinations(session.arguments()));
}

}  // namespace

Command eval_command() {
  return {
      .name = "eval",
      .group = "Materials",
      .summary = "evaluate a material at given directions",
      .description =
          "Evaluates a material: prints its BRDF in sr^-1, per channel. Each A is an angle in degrees or a list such "
          "as 0,15,30; lists are combined in all ways. --pairs takes any pairs of directions instead, see below. Theta "
          "is measured from the surface normal; delta-phi = phi_out - phi_in is 180 on the side of the mirror "
          "direction and 0 on the side of the light; anisotropic materials also depend on phi-in, the light's azimuth. "
          "For a table, the smooth part is interpolated (on klems and shirley-chiu grids it is that of the cell), and "
          "each value has its error; for measured files these are errors of interpolation, if known.\n"
          "The --pairs file has a row per pair of directions, as text or as a NumPy array (.npy). Columns of text are "
          "named, in any order: theta_in, theta_out, delta_phi and optionally phi_in; or theta_in, phi_in, theta_out, "
          "phi_out; or the vectors x_in, y_in, z_in, x_out, y_out, z_out, with z along the normal. In arrays, and in "
          "text without names, 3, 4 or 6 columns are the first, second or third of these. Angles are in "
          "degrees, as everywhere here, unless a name ends in _rad or --radians is given. CSV repeats the directions "
          "and then has a column for each channel, one for its error, where errors are known, and one for its standard "
          "deviation (_std), where the samples state theirs; NPY has these columns without the directions; HDF5 has "
          "the datasets directions, brdf, brdf_error and brdf_std. With --output rows "
          "are read, computed and written in blocks.",
      .positionals = {{.handle = argument::material, .help = "the material to evaluate", .is_material = true}},
      .options = {{.handle = kThetaIn, .value = "A", .help = "angle towards the light, 0 to 90"},
                  {.handle = kThetaOut, .value = "A", .help = "angle towards the viewer, 0 to 90"},
                  {.handle = kDeltaPhi, .value = "A", .help = "azimuth from the light to the viewer"},
                  {.handle = kPhiIn, .value = "A", .help = "azimuth towards the light (default 0)"},
                  {.handle = kPairs,
                   .value = "FILE",
                   .help = "read pairs of directions from this file, text or .npy (see above)"},
                  {.handle = kRadians, .help = "take angles of --pairs in radians unless their columns name a unit"},
                  {.handle = option::output,
                   .letter = 'o',
                   .value = "FILE",
                   .help = "write the values of --pairs to FILE.csv, FILE.npy or FILE.h5"},
                  {.handle = option::force, .letter = 'f', .help = "replace an existing file"},
                  json_option()},
      .examples =
          {{"the highlight of a Phong material",
            "lobe eval phong:n=20 --theta-in 30 --theta-out 20,25,30,35,40 --delta-phi 180"},
           {"across a brushed metal and along it",
            "lobe eval ward_anisotropic:m_x=0.05,m_y=0.3 --theta-in 30 --theta-out 40 --delta-phi 180 --phi-in "
            "0,90"},
           {"pairs of directions from a file",
            "printf '%s\\n' theta_in,theta_out,delta_phi 30,20,180 30,40,180 > pairs.csv && lobe eval ward:m=0.2 "
            "--pairs pairs.csv"}},
      .execute = execute_eval};
}

}  // namespace lobe::cli
