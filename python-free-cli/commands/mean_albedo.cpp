#include <fmt/core.h>

#include <algorithm>
#include <optional>
#include <span>

#include "interface/command.hpp"
#include "interface/deviations.hpp"
#include "interface/operand_list.hpp"
#include "interface/options.hpp"
#include "interface/session.hpp"
#include "interface/table_making.hpp"
#include "interface/table_report.hpp"
#include "lobe/energy/albedo.hpp"
#include "lobe/formats/measurement.hpp"
#include "lobe/reflectance/tabulate.hpp"

namespace lobe::cli {
namespace {

std::vector<Figure> mean_albedos(Session& session, const Operand& operand, const AlbedoOptions& options) {
  const Reflectance reflectance = session.reflectance(operand);
  std::vector<double> deviations;
  if (const auto replicates = replicated(session, {&operand, 1}); !replicates.empty()) {
    // Those of a table are taken on its grid.
    const BrdfTable* table = reflectance.table();
    const Reflectance copies =
        table == nullptr ? Reflectance(replicates.front())
                         : tabulate(session.device(), replicates.front(), table->grid, {.allow_unresolved = true});
    std::vector<double> numbers;
    for (const Estimate& mean : mean_albedo(session.device(), copies, options)) numbers.push_back(mean.value);
    deviations = measurement_deviations(replicates.front(), numbers);
  }
  return figures(mean_albedo(session.device(), reflectance, options), deviations);
}

/// A row per material, a column per channel.
std::string means_text(const std::vector<Operand>& operands, const std::vector<std::vector<Figure>>& means,
                       bool color) {
  std::vector<std::string> labels = channel_labels(operands);
  if (labels.size() == 1) labels = {"mean albedo"};
  std::vector<std::vector<std::string>> rows{{"material"}};
  rows.front().insert(rows.front().end(), labels.begin(), labels.end());
  for (std::size_t i = 0; i < operands.size(); ++i) {
    rows.push_back({operands[i].label()});
    for (const auto& figure : means[i]) rows.back().push_back(format_figure(figure));
    rows.back().resize(labels.size() + 1);
  }
  return format_table(rows, 1, color);
}

ExitCode execute_mean_albedo(Session& session) {
  std::vector<bool> reached;
  const AlbedoOptions options{.tolerance = session.tolerance(AlbedoOptions{}.tolerance),
                              .precision = session.precision(),
                              .missed = [&](const MissedTolerance& missed) {
                                session.note_missed(missed);
                                reached.back() = false;
                              }};
  const auto operands = read_operands(session, session.arguments().texts(argument::materials), {}).operands;
  std::vector<std::vector<Figure>> means;
  for (const auto& operand : operands) {
    reached.push_back(true);
    means.push_back(mean_albedos(session, operand, options));
    if (operand.is_formula() || !session.arguments().has(option::tolerance)) continue;
    for (const Figure& figure : means.back()) {
      session.note_if_missed("mean albedo of '" + operand.label() + "'", figure.estimate, options.tolerance);
    }
  }
  if (!session.wants_json()) {
    session.print(means_text(operands, means, session.colors_output()));
    return ExitCode::success;
  }
  Json answer = json_answer("mean-albedo");
  answer["units"] = {{"mean_albedo", "1"}};
  answer["materials"] = Json::array();
  for (std::size_t i = 0; i < operands.size(); ++i) {
    Json json{{"name", operands[i].label()}};
    json["mean_albedo"] = Json::array();
    for (const auto& figure : means[i]) json["mean_albedo"].push_back(to_json(figure));
    if (operands[i].is_formula()) json["reached_tolerance"] = static_cast<bool>(reached[i]);
    answer["materials"].push_back(std::move(json));
  }
  if (std::ranges::any_of(operands, &Operand::is_formula)) {
    answer["tolerance"] = options.tolerance;
    answer["precision"] = to_string(options.precision);
    answer["device"] = to_json(session.device().info());
  }
  session.print_json(answer);
  return ExitCode::success;
}

}  // namespace

Command mean_albedo_command() {
  return {.name = "mean-albedo",
          .group = "Materials",
          .summary = "compute the albedo under diffuse light",
          .description =
              "Computes the mean albedo A = 1/pi times the integral of a(L) over the projected solid angle, per "
              "channel, with an error bound: the albedo under light of equal radiance from everywhere, also called "
              "white-sky or bihemispherical albedo. For a table it is summed from the values on its grid; the error "
              "for a measured file is that of its interpolation and of the quadrature.",
          .positionals = {{.handle = argument::materials,
                           .help = "materials, tables, or study files for all their materials",
                           .is_material = true,
                           .is_repeated = true}},
          .options = {tolerance_option("largest relative error, for materials (default 1e-6)"), strict_option(),
                      set_option(), json_option()},
          .examples = {{"two models of rough surfaces", "lobe mean-albedo oren_nayar:sigma=0.5 cook_torrance:m=0.3"},
                       {"every material of a study", "lobe mean-albedo studies/metals.toml --tolerance 1e-4"}},
          .execute = execute_mean_albedo};
}

}  // namespace lobe::cli
