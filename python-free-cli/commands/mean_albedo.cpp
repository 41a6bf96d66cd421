#include <fmt/core.h>

#include <algorithm>
#include <optional>
#include <span>

#include "interface/command.hpp"
#include "interface/deviations.hpp"
#include "interface/operand_list.hpp"
#include "interface/session.hpp"
#include "interface/table_making.hpp"
#include "interface/table_report.hpp"
#include "lobe/energy/energy.hpp"
#include "lobe/io/measurement.hpp"

namespace lobe::cli {
namespace {

std::vector<Figure> mean_albedos(Session& session, const Operand& operand, const std::optional<Device>& device,
                                 const AlbedoOptions& options) {
  if (!operand.is_table()) return figures(mean_albedo(*device, operand.material(), options), {});
  const auto replicates = replicated(session, std::nullopt, {&operand, 1});
  std::vector<double> deviations;
  if (!replicates.empty()) {
    std::vector<double> numbers;
    const auto means =
        operand.is_function()
            ? mean_albedo(replicates.front())
            : albedo(tabulate(replicates.front(), operand.header().grid, {.allow_unresolved = true})).mean;
    for (const Estimate& mean : means) numbers.push_back(mean.value);
    deviations = measurement_deviations(replicates.front(), numbers);
  }
  if (operand.is_function()) return figures(mean_albedo(operand.function()), deviations);
  session.state_memory(value_bytes(operand.header()));
  return figures(albedo(operand.load()).mean, deviations);
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

ExitCode execute(Session& session) {
  std::vector<bool> reached;
  const AlbedoOptions options{.tolerance = session.tolerance(AlbedoOptions{}.tolerance),
                              .precision = session.precision(),
                              .missed = [&](const MissedTolerance& missed) {
                                session.note_missed(missed);
                                reached.back() = false;
                              }};
  const auto operands = read_operands(session, session.arguments().texts("MATERIAL"), {}).operands;
  std::optional<Device> device;
  if (!std::ranges::all_of(operands, &Operand::is_table)) device = session.choose_device();
  std::vector<std::vector<Figure>> means;
  for (const auto& operand : operands) {
    reached.push_back(true);
    means.push_back(mean_albedos(session, operand, device, options));
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
    if (!operands[i].is_table()) json["reached_tolerance"] = static_cast<bool>(reached[i]);
    answer["materials"].push_back(std::move(json));
  }
  if (device) {  // for formulas
    answer["tolerance"] = options.tolerance;
    answer["precision"] = to_string(options.precision);
    answer["device"] = to_json(device->info());
  }
  session.print_json(answer);
  return ExitCode::success;
}

}  // namespace

Command mean_albedo_command() {
  return {.name = "mean-albedo",
          .group = "Materials",
          .summary = "share of diffuse light that a material reflects",
          .description =
              "Prints the mean albedo A = 1/pi times the integral of a(L) over the projected solid angle, per channel, "
              "with a bound on its error: the albedo under light of equal radiance from everywhere, also called "
              "white-sky or bihemispherical. Of a table it is that of its values on their grid; the error of a "
              "measurement is that of its interpolation and of the quadrature.",
          .positionals = {{.name = "MATERIAL",
                           .help = "materials, tables, or study files for all their materials",
                           .is_material = true,
                           .is_repeated = true}},
          .options = {tolerance_option("largest relative error, of materials (default 1e-6)"), strict_option(),
                      set_option(), json_option()},
          .examples = {{"two models of rough surfaces", "lobe mean-albedo oren_nayar:sigma=0.5 cook_torrance:m=0.3"},
                       {"every material of a study", "lobe mean-albedo studies/metals.toml --tolerance 1e-4"}},
          .execute = execute};
}

}  // namespace lobe::cli
