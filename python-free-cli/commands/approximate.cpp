#include <fmt/core.h>

#include <array>
#include <filesystem>
#include <optional>
#include <span>

#include "core/text.hpp"
#include "interface/command.hpp"
#include "interface/measuring.hpp"
#include "interface/operand_list.hpp"
#include "interface/options.hpp"
#include "interface/report.hpp"
#include "interface/session.hpp"
#include "interface/terminal.hpp"
#include "lobe/core/error.hpp"
#include "lobe/core/version.hpp"
#include "lobe/fit/approximation.hpp"
#include "lobe/metric/unit.hpp"
#include "lobe/plot/approximation_pictures.hpp"
#include "lobe/study/material_file.hpp"

namespace lobe::cli {
namespace {

constexpr Flag kAllowDependent{"allow-dependent"};
constexpr Texts kBasis{"basis"};
constexpr Flag kCommon{"common"};
constexpr Flag kEnergy{"energy"};
constexpr Count kGreedy{"greedy"};
constexpr Flag kNonNegative{"non-negative"};

namespace fs = std::filesystem;

/// The request.
struct ApproximationRequest {
  Operand target;
  std::vector<Operand> basis;
  std::vector<Lighting> lightings;
  ApproximationOptions options;
  std::optional<unsigned> greedy;
};

/// An approximation under one lighting, and what was made of it.
struct Answer {
  Approximation approximation;
  std::vector<Operand> basis;  ///< with --greedy those chosen, in order
  std::vector<GreedyStep> steps;
  std::optional<fs::path> file;
  PictureFiles pictures;
};

ApproximationRequest read_approximation(Session& session) {
  const auto& arguments = session.arguments();
  ApproximationRequest request{
      .target = session.operand(argument::target), .basis = {}, .lightings = {}, .options = {}, .greedy = {}};
  request.basis = read_operands(session, arguments.texts(kBasis), {}).operands;
  request.lightings = lightings_of(arguments);
  if (arguments.has(kGreedy)) request.greedy = arguments.count(kGreedy);
  ApproximationOptions& options = request.options;
  options.form = {.non_negative = arguments.has(kNonNegative),
                  .energy = arguments.has(kEnergy),
                  .allow_dependent = arguments.has(kAllowDependent)};
  if (arguments.has(kCommon)) options.channels = ChannelCoefficients::common;
  options.metric.tolerance = session.tolerance(options.metric.tolerance);
  options.metric.patch_tolerance = session.tolerance(options.metric.patch_tolerance);
  options.metric.function_tolerance = session.tolerance(options.metric.function_tolerance);
  options.metric.theta_max = domain_of(arguments);
  options.metric.precision = session.precision();
  options.metric.progress = session.progress();
  return request;
}

/// Path from --output; with several lightings, their names stand before the extension.
fs::path output_path(const Session& session, const ApproximationRequest& request, const Lighting& lighting) {
  const fs::path path = session.arguments().text(option::output);
  if (request.lightings.size() == 1) return path;
  return path.parent_path() / (path.stem().string() + "." + lighting.stem() + path.extension().string());
}

void check_outputs(const Session& session, const ApproximationRequest& request) {
  const auto& arguments = session.arguments();
  if (!arguments.has(option::output)) return;
  for (const Operand& operand : request.basis) {
    if (operand.is_formula()) continue;
    throw ArgumentError("'" + operand.label() + "' has no formula, and a combination with it is no material for " +
                        "--output; mix it as a table: lobe mix MATERIAL... --weights COEFFICIENTS -o FILE.h5");
  }
  if (fs::path(arguments.text(option::output)).extension() != ".toml") {
    throw ArgumentError("--output " + arguments.text(option::output) +
                        " is no name of a material file; expected FILE.toml");
  }
  for (const auto& lighting : request.lightings) {
    const fs::path path = output_path(session, request, lighting);
    std::error_code ignored;
    if (fs::exists(path, ignored) && !arguments.has(option::force)) {
      throw IoError(path.string() + " exists; use --force to replace it, or give another --output");
    }
  }
}

Answer compute(const Device& device, const ApproximationRequest& request, const Reflectance& target,
               const std::vector<Reflectance>& basis, const Lighting& lighting) {
  if (!request.greedy) {
    return {approximate(device, target, basis, lighting, request.options), request.basis, {}, {}, {}};
  }
  auto greedy = greedy_basis(device, target, basis, *request.greedy, lighting, request.options);
  std::vector<Operand> chosen;
  for (const auto& step : greedy.steps) chosen.push_back(request.basis[step.chosen]);
  return {std::move(greedy.approximation), std::move(chosen), std::move(greedy.steps), {}, {}};
}

std::string form_name(const ApproximationForm& form) {
  if (form.non_negative && form.energy) return "non-negative within the energy balance";
  return form.non_negative ? "non-negative" : form.energy ? "within the energy balance" : "unconstrained";
}

/// Comments of the material file: where it comes from and how good it is.
std::string provenance(const Session& session, const ApproximationRequest& request, const Answer& answer) {
  const Approximation& result = answer.approximation;
  std::string text = session.command_line() + "\n" + fmt::format("lobe {} ({})\n", version(), commit());
  text += fmt::format("best approximation of '{}' under lighting '{}', {}\n", request.target.label(),
                      result.lighting.name(), form_name(request.options.form));
  text += fmt::format("relative residual {}\n", format_estimate(result.relative_residual));
  std::vector<Operand> operands{request.target};
  operands.insert(operands.end(), answer.basis.begin(), answer.basis.end());
  const auto labels = channel_labels(operands);
  for (std::size_t c = 0; c < result.fits.size(); ++c) {
    if (result.fits.size() > 1) text += labels[c] + "\n";
    for (std::size_t i = 0; i < answer.basis.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      const LinearFit& fit = result.fits[c];
      text += fmt::format("  {} of {}\n", format_estimate({fit.coefficients(at), fit.coefficients_error(at)}),
                          answer.basis[i].label());
    }
  }
  return text;
}

void write_files(Session& session, const Device& device, const ApproximationRequest& request, const Reflectance& target,
                 Answer& answer) {
  const auto& arguments = session.arguments();
  const Lighting& lighting = answer.approximation.lighting;
  if (arguments.has(option::output)) {
    const fs::path path = output_path(session, request, lighting);
    save_material(answer.approximation.material, path, arguments.has(option::force),
                  provenance(session, request, answer));
    answer.file = path;
  }
  if (arguments.has(option::plot)) {
    answer.pictures =
        write_approximation_pictures(device, target, answer.approximation, arguments.text(option::plot),
                                     "approximation." + lighting.stem(), {.overwrite = arguments.has(option::force)});
    if (!answer.pictures.note.empty()) session.warn(answer.pictures.note);
  }
}

Json fit_json(const LinearFit& fit, const std::vector<Operand>& basis, bool has_energy) {
  Json json;
  json["coefficients"] = Json::array();
  for (std::size_t i = 0; i < basis.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    json["coefficients"].push_back({{"material", basis[i].label()},
                                    {"value", to_json(fit.coefficients(at))},
                                    {"error", to_json(fit.coefficients_error(at))},
                                    {"at_zero", static_cast<bool>(fit.at_zero[i])}});
  }
  json["residual"] = to_json(fit.residual);
  json["relative_residual"] = to_json(fit.relative_residual);
  json["rank"] = fit.rank;
  json["condition"] = to_json(fit.condition);
  json["dependent"] = Json::array();
  for (const std::size_t i : fit.dependent) json["dependent"].push_back(basis[i].label());
  json["kkt_residual"] = to_json(fit.kkt_residual);
  if (has_energy) {
    json["energy"] = to_json(fit.energy);
    json["at_energy_bound"] = fit.at_energy_bound;
  }
  return json;
}

Json answer_json(const ApproximationRequest& request, const Answer& answer) {
  const Approximation& result = answer.approximation;
  Json json;
  json["lighting"] = result.lighting.name();
  if (const auto degrees = domain_degrees(request.options.metric.theta_max)) json["domain_theta_max_deg"] = *degrees;
  json["units"] = {{"residual", norm_unit(result.lighting, UnitStyle::plain)}};
  json["target_norm"] = to_json(result.target_norm);
  json["residual"] = to_json(result.residual);
  json["relative_residual"] = to_json(result.relative_residual);
  if (!answer.steps.empty()) {
    json["steps"] = Json::array();
    for (const auto& step : answer.steps) {
      json["steps"].push_back({{"material", request.basis[step.chosen].label()},
                               {"residual", to_json(step.residual)},
                               {"relative_residual", to_json(step.relative_residual)}});
    }
  }
  json["fits"] = Json::array();
  for (const auto& fit : result.fits) json["fits"].push_back(fit_json(fit, answer.basis, request.options.form.energy));
  if (result.combination.formula() != nullptr) json["material"] = material_json(result.material);
  json["tolerance"] = result.tolerance;
  json["reached_tolerance"] = result.unresolved.empty();
  if (answer.file) json["file"] = answer.file->string();
  if (!answer.pictures.scripts.empty()) {
    json["pictures"] = files_json(answer.pictures.pictures);
    json["scripts"] = files_json(answer.pictures.scripts);
  }
  return json;
}

void print_json(Session& session, const Device& device, const ApproximationRequest& request,
                const std::vector<Answer>& answers) {
  Json json = json_answer("approximate");
  json["target"] = operand_json(request.target);
  json["basis"] = Json::array();
  for (const auto& operand : request.basis) {
    const Material* const material = operand.shape().formula();
    json["basis"].push_back(material != nullptr ? material_json(*material) : operand_json(operand));
  }
  const ApproximationForm& form = request.options.form;
  json["form"] = {{"non_negative", form.non_negative},
                  {"energy", form.energy},
                  {"allow_dependent", form.allow_dependent},
                  {"common", request.options.channels == ChannelCoefficients::common}};
  if (request.greedy) json["greedy"] = *request.greedy;
  json["answers"] = Json::array();
  for (const auto& answer : answers) json["answers"].push_back(answer_json(request, answer));
  json["precision"] = to_string(request.options.metric.precision);
  json["device"] = to_json(device.info());
  session.print_json(json);
}

std::string coefficients_text(const Answer& answer, bool color) {
  const auto& fits = answer.approximation.fits;
  std::vector<std::vector<std::string>> rows{{"material"}};
  for (std::size_t c = 0; c < fits.size(); ++c) {
    rows.front().push_back(fits.size() == 1 ? "coefficient" : fmt::format("coefficient_{}", c + 1));
  }
  for (std::size_t i = 0; i < answer.basis.size(); ++i) {
    rows.push_back({answer.basis[i].label()});
    const auto at = static_cast<Eigen::Index>(i);
    for (const auto& fit : fits) {
      rows.back().push_back(format_estimate({fit.coefficients(at), fit.coefficients_error(at)}));
    }
  }
  return format_table(rows, 1, color);
}

std::string steps_text(const ApproximationRequest& request, const Answer& answer, bool color) {
  std::vector<std::vector<std::string>> rows{{"step", "material", "relative_residual"}};
  for (const auto& step : answer.steps) {
    rows.push_back(
        {std::to_string(rows.size()), request.basis[step.chosen].label(), format_estimate(step.relative_residual)});
  }
  return format_table(rows, 2, color);
}

std::string quality_text(const ApproximationRequest& request, const Answer& answer) {
  const Approximation& result = answer.approximation;
  std::vector<std::vector<std::string>> rows{{"residual", format_estimate(result.residual)},
                                             {"relative residual", format_estimate(result.relative_residual)}};
  for (std::size_t c = 0; c < result.fits.size(); ++c) {
    const LinearFit& fit = result.fits[c];
    const std::string which = result.fits.size() == 1 ? "" : fmt::format(" {}", c + 1);
    rows.push_back({"rank" + which, fmt::format("{} of {}", fit.rank, answer.basis.size())});
    rows.push_back({"condition" + which, fmt::format("{:.4g}", fit.condition)});
    rows.push_back({"KKT residual" + which, fmt::format("{:.2g}", fit.kkt_residual)});
    if (request.options.form.energy) {
      rows.push_back(
          {"energy" + which, fmt::format("{:.6g}{}", fit.energy, fit.at_energy_bound ? ", at the bound" : "")});
    }
  }
  return format_table(rows, 2, false);
}

void print_text(Session& session, const ApproximationRequest& request, const std::vector<Answer>& answers) {
  for (const auto& answer : answers) {
    const bool color = session.colors_output();
    if (&answer != answers.data()) session.print("\n");
    if (answers.size() > 1) session.print(fmt::format("lighting {}\n", answer.approximation.lighting.name()));
    if (!answer.steps.empty()) session.print(steps_text(request, answer, color) + "\n");
    session.print(coefficients_text(answer, color) + "\n" + quality_text(request, answer));
    if (answer.file) session.print(fmt::format("material           {}\n", answer.file->string()));
    for (const auto& picture : answer.pictures.pictures) {
      session.print(fmt::format("picture            {}\n", picture.lexically_normal().string()));
    }
  }
}

void note_unresolved(Session& session, const ApproximationRequest& request, const Approximation& result) {
  const auto name = [&](std::size_t i) {
    return i < request.basis.size() ? request.basis[i].label() : request.target.label();
  };
  for (const auto& product : result.unresolved) {
    session.note_missed({.quantity = fmt::format("{}: the product of '{}' and '{}'", result.lighting.name(),
                                                 name(product.first), name(product.second)),
                         .relative_error = product.relative_error,
                         .tolerance = result.tolerance});
  }
  if (!session.arguments().has(option::tolerance) || result.route == Route::formulas) return;
  // By other routes nothing is listed; the error of the residual counts, relative to what it is a part of.
  session.note_if_missed(fmt::format("{}: the residual", result.lighting.name()),
                         {result.target_norm.value, result.residual.error}, session.tolerance(result.tolerance));
}

void warn_of_doubts(Session& session, const Answer& answer) {
  constexpr double kLargestViolation = 1e-9;
  const Approximation& result = answer.approximation;
  for (const auto& fit : result.fits) {
    if (fit.kkt_residual > kLargestViolation) {
      session.warn(fmt::format("the optimality conditions under lighting '{}' are met to {:.2g} only",
                               result.lighting.name(), fit.kkt_residual));
    }
  }
}

ExitCode execute_approximate(Session& session) {
  const ApproximationRequest request = read_approximation(session);
  check_outputs(session, request);
  const auto device = session.choose_device();
  std::vector<Answer> answers;
  const Reflectance target = request.target.reflectance();
  std::vector<Reflectance> basis;
  for (const Operand& operand : request.basis) basis.push_back(operand.reflectance());
  for (const auto& lighting : request.lightings) {
    answers.push_back(compute(device, request, target, basis, lighting));
    const Approximation& approximation = answers.back().approximation;
    if (approximation.is_coarse) note_coarse(session, request.target, *approximation.grid, device);
  }
  for (const auto& answer : answers) note_unresolved(session, request, answer.approximation);
  if (InterruptWatch::interrupted()) throw Cancelled("interrupted");
  for (auto& answer : answers) write_files(session, device, request, target, answer);
  session.end_progress();
  for (const auto& answer : answers) warn_of_doubts(session, answer);
  if (session.wants_json()) {
    print_json(session, device, request, answers);
  } else {
    print_text(session, request, answers);
  }
  return ExitCode::success;
}

}  // namespace

Command approximate_command() {
  return {
      .name = "approximate",
      .group = "Materials",
      .summary = "find the best linear combination of a basis",
      .description =
          "Finds the combination of basis materials that is nearest to the target under a lighting. Prints its "
          "coefficients, the residual distance, and the residual divided by the target's norm, each with an error "
          "bound; then the rank and the condition of the Gram matrix, with the basis materials scaled to norm 1, and "
          "how well the optimality conditions are met. Each lighting gets its own answer, and each channel its own "
          "coefficients.\n"
          "Products with a measured file are as exact as its interpolation; with a table as target or in the basis, "
          "all others are tabulated on its grid.\n"
          "Fails if the basis is linearly dependent within the errors of its scalar products.",
      .positionals = {{.handle = argument::target,
                       .help = "the material, measurement or table to approximate",
                       .is_material = true}},
      .options = {{.handle = kBasis,
                   .letter = 'b',
                   .value = "MATERIAL",
                   .help = "a basis material, measured file or table, FILE.toml#FAMILY for a family of a study, or "
                           "FILE.toml# for a whole study; may be repeated",
                   .required = true},
                  {.handle = kNonNegative, .help = "allow no negative coefficients"},
                  {.handle = kEnergy,
                   .help = "require sum |coefficient| * albedo <= 1, with each basis material's largest albedo up to "
                           "89 degrees"},
                  {.handle = kGreedy,
                   .value = "K",
                   .help = "choose K basis materials, one after the other (orthogonal matching pursuit)"},
                  {.handle = option::lighting,
                   .value = "LIGHTING",
                   .help = "as for 'distance'; may be repeated (default: point)"},
                  domain_option(),
                  {.handle = kCommon, .help = "use the same coefficients for all channels"},
                  {.handle = kAllowDependent,
                   .help = "accept a dependent basis, and give the best combination of least norm or, with "
                           "constraints, one of independent materials"},
                  tolerance_option("largest relative error of the scalar products (default 1e-6)"),
                  strict_option(),
                  {.handle = option::output,
                   .letter = 'o',
                   .value = "FILE.toml",
                   .help = "write the approximation as a material file, FILE.LIGHTING.toml with several lightings"},
                  {.handle = option::plot,
                   .value = "DIR",
                   .help = "draw target, approximation and residual into this directory"},
                  {.handle = option::force, .letter = 'f', .help = "replace existing files"},
                  set_option(),
                  json_option()},
      .examples = {{"a metal as a sum of two highlights and a diffuse part",
                    "lobe approximate cook_torrance:m=0.3 -b lambert -b metal_phong:n=5 -b metal_phong:n=20"},
                   {"three of a study's Phong materials, as a material file",
                    "lobe approximate ward:m=0.2 -b studies/classical-families.toml#Phong --greedy 3 --non-negative "
                    "-o ward.toml"},
                   {"another program's file",
                    "lobe export ward:m=0.4,scale=0.5 --format merl -o paint.binary && "
                    "lobe approximate paint.binary -b lambert -b phong:n=5 -b phong:n=20"}},
      .execute = execute_approximate};
}

}  // namespace lobe::cli
