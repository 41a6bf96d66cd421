#include <fmt/core.h>

#include <numbers>

#include "command.hpp"
#include "core/text.hpp"
#include "lobe/error.hpp"
#include "lobe/evaluate.hpp"
#include "session.hpp"

namespace lobe::cli {
namespace {

constexpr double kRadiansPerDegree = std::numbers::pi / 180;

std::vector<double> polar_angles(const Arguments& arguments, std::string_view name) {
  auto angles = arguments.numbers(name);
  for (const double angle : angles) {
    if (!(angle >= 0 && angle <= 90)) {
      throw ArgumentError(fmt::format("--{} {} is out of range; expected 0 to 90 degrees", name, shortest(angle)));
    }
  }
  return angles;
}

struct AngleProduct {
  std::vector<Directions> degrees;
  std::vector<Directions> radians;
};

AngleProduct all_combinations(const Arguments& arguments) {
  AngleProduct product;
  const auto theta_out = polar_angles(arguments, "theta-out");
  const auto delta_phi = arguments.numbers("delta-phi");
  for (const double in : polar_angles(arguments, "theta-in")) {
    for (const double out : theta_out) {
      for (const double phi : delta_phi) {
        product.degrees.push_back({in, out, phi});
        product.radians.push_back({in * kRadiansPerDegree, out * kRadiansPerDegree, phi * kRadiansPerDegree});
      }
    }
  }
  return product;
}

ExitCode execute(Session& session) {
  const auto material = session.material("MATERIAL");
  const auto angles = all_combinations(session.arguments());
  const auto precision = session.precision();
  const auto device = session.choose_device();
  const Eigen::MatrixXd values = evaluate(device, material, angles.radians, precision);

  if (session.wants_json()) {
    Json answer = json_answer("eval");
    answer["material"] = material_json(material);
    answer["units"] = {{"angles", "deg"}, {"brdf", "sr^-1"}};
    answer["values"] = Json::array();
    for (Eigen::Index row = 0; row < values.rows(); ++row) {
      const auto& at = angles.degrees[static_cast<std::size_t>(row)];
      Json entry{{"theta_in_deg", at.theta_in}, {"theta_out_deg", at.theta_out}, {"delta_phi_deg", at.delta_phi}};
      entry["brdf"] = Json::array();
      for (Eigen::Index channel = 0; channel < values.cols(); ++channel) {
        entry["brdf"].push_back(to_json(values(row, channel)));
      }
      answer["values"].push_back(std::move(entry));
    }
    answer["precision"] = to_string(precision);
    answer["device"] = to_json(device.info());
    session.print_json(answer);
    return ExitCode::success;
  }
  std::vector<std::vector<std::string>> rows{{"theta_in/deg", "theta_out/deg", "delta_phi/deg"}};
  for (Eigen::Index channel = 0; channel < values.cols(); ++channel) {
    rows.front().push_back(values.cols() == 1 ? "brdf/sr^-1" : fmt::format("brdf_{}/sr^-1", channel));
  }
  for (Eigen::Index row = 0; row < values.rows(); ++row) {
    const auto& at = angles.degrees[static_cast<std::size_t>(row)];
    rows.push_back({shortest(at.theta_in), shortest(at.theta_out), shortest(at.delta_phi)});
    for (Eigen::Index channel = 0; channel < values.cols(); ++channel) {
      rows.back().push_back(shortest(values(row, channel)));
    }
  }
  session.print(format_table(rows, 0, session.colors_output()));
  return ExitCode::success;
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
          "phi_out - phi_in is 180 on the side of the mirror direction and 0 on the side of the light.",
      .positionals = {{.name = "MATERIAL", .help = "the material to evaluate", .is_material = true}},
      .options = {{.name = "theta-in", .value = "A", .help = "angle towards the light, 0 to 90", .required = true},
                  {.name = "theta-out", .value = "A", .help = "angle towards the viewer, 0 to 90", .required = true},
                  {.name = "delta-phi", .value = "A", .help = "azimuth between the two", .required = true},
                  json_option()},
      .examples = {{"the highlight of a Phong material",
                    "lobe eval phong:n=20 --theta-in 30 --theta-out 20,25,30,35,40 --delta-phi 180"},
                   {"diffuse and glossy together, as JSON",
                    "lobe eval lambert:scale=0.3+ward:m=0.1,scale=0.5 --theta-in 0 --theta-out 0,60 --delta-phi 0 "
                    "--json"}},
      .execute = execute};
}

}  // namespace lobe::cli
