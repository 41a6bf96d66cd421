#include <fmt/core.h>

#include "command.hpp"
#include "core/text.hpp"
#include "lobe/error.hpp"
#include "lobe/evaluate.hpp"
#include "reading.hpp"
#include "session.hpp"
#include "table_making.hpp"
#include "table_report.hpp"
#include "values_report.hpp"

namespace lobe::cli {
namespace {

std::vector<double> polar_angles(const Arguments& arguments, std::string_view name) {
  auto angles = arguments.numbers(name);
  for (const double angle : angles) {
    if (!(angle >= 0 && angle <= 90)) {
      throw ArgumentError(fmt::format("--{} {} is out of range; expected 0 to 90 degrees", name, shortest(angle)));
    }
  }
  return angles;
}

std::vector<Directions> all_combinations(const Arguments& arguments) {
  std::vector<Directions> degrees;
  const auto theta_out = polar_angles(arguments, "theta-out");
  const auto delta_phi = arguments.numbers("delta-phi");
  const auto phi_in = arguments.has("phi-in") ? arguments.numbers("phi-in") : std::vector<double>{0};
  for (const double azimuth : phi_in) {
    for (const double in : polar_angles(arguments, "theta-in")) {
      for (const double out : theta_out) {
        for (const double phi : delta_phi) degrees.push_back({in, out, phi, azimuth});
      }
    }
  }
  return degrees;
}

Json answer_to(const Operand& operand) {
  Json answer = json_answer("eval");
  if (operand.is_foreign()) {
    answer["function"] = function_json(operand.function());
  } else if (operand.is_table()) {
    answer["table"] = header_json(operand.header());
  } else {
    answer["material"] = material_json(operand.material());
  }
  answer["units"] = {{"angles", "deg"}, {"brdf", "sr^-1"}};
  return answer;
}

/// Values between the nodes of a table, each with its error.
ExitCode evaluate_table(Session& session, const Operand& operand, std::span<const Directions> degrees) {
  session.state_memory(value_bytes(operand.header()));
  const BrdfTable table = operand.load();
  const auto values = evaluate(table, to_radians(degrees));
  if (table.has_delta()) session.warn("the table has delta parts, which have no values; see 'lobe info'");
  if (session.wants_json()) {
    Json answer = answer_to(operand);
    answer["values"] = values_json(degrees, values);
    session.print_json(answer);
  } else {
    session.print(values_text(degrees, values, session.colors_output()));
  }
  return ExitCode::success;
}

/// Values with their errors, [channel][pair].
std::vector<std::vector<Estimate>> estimates(const BrdfValues& found) {
  std::vector<std::vector<Estimate>> values(static_cast<std::size_t>(found.value.cols()));
  for (Eigen::Index c = 0; c < found.value.cols(); ++c) {
    for (Eigen::Index i = 0; i < found.value.rows(); ++i) {
      values[static_cast<std::size_t>(c)].push_back({found.value(i, c), found.error(i, c)});
    }
  }
  return values;
}

/// What a foreign file has at the directions themselves.
ExitCode evaluate_foreign(Session& session, const Operand& operand, std::span<const Directions> degrees) {
  const BrdfValues found = operand.function().at(to_radians(degrees));
  const bool has_errors = found.error.size() > 0;
  if (session.wants_json()) {
    Json answer = answer_to(operand);
    answer["values"] = has_errors ? values_json(degrees, estimates(found)) : values_json(degrees, found.value);
    session.print_json(answer);
    return ExitCode::success;
  }
  const bool color = session.colors_output();
  session.print(has_errors ? values_text(degrees, estimates(found), color) : values_text(degrees, found.value, color));
  return ExitCode::success;
}

ExitCode evaluate_material(Session& session, const Operand& operand, std::span<const Directions> degrees) {
  const auto precision = session.precision();
  const auto device = session.choose_device();
  const Eigen::MatrixXd values = evaluate(device, operand.material(), to_radians(degrees), precision);
  if (session.wants_json()) {
    Json answer = answer_to(operand);
    answer["values"] = values_json(degrees, values);
    answer["precision"] = to_string(precision);
    answer["device"] = to_json(device.info());
    session.print_json(answer);
  } else {
    session.print(values_text(degrees, values, session.colors_output()));
  }
  return ExitCode::success;
}

ExitCode execute(Session& session) {
  const auto operand = session.operand("MATERIAL");
  const auto degrees = all_combinations(session.arguments());
  if (operand.is_foreign()) return evaluate_foreign(session, operand, degrees);
  return operand.is_table() ? evaluate_table(session, operand, degrees) : evaluate_material(session, operand, degrees);
}

}  // namespace

Command eval_command() {
  return {
      .name = "eval",
      .group = "Materials",
      .summary = "values of a material for given directions",
      .description =
          "Prints the reflectance in sr^-1, per channel. Each A is an angle in degrees or a list such as "
          "0,15,30; lists are combined in all ways. Theta counts from the surface normal; delta-phi = "
          "phi_out - phi_in is 180 on the side of the mirror direction and 0 on the side of the light; anisotropic "
          "materials also see phi-in, the light's azimuth. Of a table "
          "the smooth part is interpolated (on klems and shirley-chiu grids that of the cell), and each value has its "
          "error; of measurements these are errors of interpolation, where they are known.",
      .positionals = {{.name = "MATERIAL", .help = "the material to evaluate", .is_material = true}},
      .options = {{.name = "theta-in", .value = "A", .help = "angle towards the light, 0 to 90", .required = true},
                  {.name = "theta-out", .value = "A", .help = "angle towards the viewer, 0 to 90", .required = true},
                  {.name = "delta-phi", .value = "A", .help = "azimuth between the two", .required = true},
                  {.name = "phi-in", .value = "A", .help = "azimuth towards the light (default 0)"},
                  json_option()},
      .examples = {{"the highlight of a Phong material",
                    "lobe eval phong:n=20 --theta-in 30 --theta-out 20,25,30,35,40 --delta-phi 180"},
                   {"across a brushed metal and along it",
                    "lobe eval ward_anisotropic:m_x=0.05,m_y=0.3 --theta-in 30 --theta-out 40 --delta-phi 180 --phi-in "
                    "0,90"}},
      .execute = execute};
}

}  // namespace lobe::cli
