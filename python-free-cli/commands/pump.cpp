#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
#include <span>

#include "core/text.hpp"
#include "interface/chart_output.hpp"
#include "interface/options.hpp"
#include "interface/repairing.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"
#include "lobe/energy/repair.hpp"
#include "lobe/study/chart.hpp"

namespace lobe::cli {
namespace {

constexpr Text kCorrection{"correction"};
constexpr Numbers kPumpTheta{"theta"};
constexpr Text kTimes{"times"};

namespace fs = std::filesystem;

constexpr std::string_view kConverged = "until-converged";
constexpr int kMaterialSteps = 10;

struct PumpRequest {
  Correction correction = Correction::g1;
  PumpOptions options;
  std::vector<double> theta_deg;
};

Correction correction_of(const std::string& text) {
  return parse_adjustment("pump:correction=" + text).correction;
}

PumpRequest request_of(Session& session) {
  const auto& arguments = session.arguments();
  PumpRequest request;
  request.correction = correction_of(arguments.text(kCorrection));
  request.options = {.tolerance = session.tolerance(PumpOptions{}.tolerance), .progress = session.progress()};
  const std::string& times = arguments.has(kTimes) ? arguments.text(kTimes) : std::string("1");
  if (times == kConverged) {
    request.options.times.reset();
  } else {
    double count = 0;
    if (!parse_number(times, count) || !(count >= 1 && count <= 1000) || count != std::floor(count)) {
      throw ArgumentError("--times " + times + "; expected a whole number from 1 to 1000, or " +
                          std::string(kConverged));
    }
    request.options.times = static_cast<int>(count);
  }
  request.theta_deg =
      arguments.has(kPumpTheta) ? arguments.numbers(kPumpTheta) : std::vector<double>{0, 15, 30, 45, 60, 75, 85, 89};
  for (const double angle : request.theta_deg) {
    if (!(angle >= 0 && angle < 90)) {
      throw ArgumentError(
          fmt::format("--theta {} is out of range; expected at least 0 and less than 90 degrees", shortest(angle)));
    }
  }
  return request;
}

/// Steps with the angles of incidence that they have, in degrees.
struct Curves {
  std::vector<double> theta_deg;
  std::vector<PumpStep> steps;
};

using Side = std::vector<std::vector<Estimate>> PumpStep::*;

/// The first, second and last steps where there are many.
std::vector<std::size_t> shown_steps(std::size_t count) {
  constexpr std::size_t kMost = 5;
  std::vector<std::size_t> shown;
  for (std::size_t k = 0; k < count; ++k) {
    if (count <= kMost || k + 2 < kMost || k + 1 == count) shown.push_back(k);
  }
  return shown;
}

std::string curves_text(std::string_view title, const Curves& curves, Side side,
                        const std::vector<std::string>& channels, bool color) {
  std::string text;
  for (std::size_t c = 0; c < channels.size(); ++c) {
    text += channels.size() == 1 ? fmt::format("{}\n", title) : fmt::format("{}, {}\n", title, channels[c]);
    std::vector<std::vector<std::string>> rows{{"theta/deg"}};
    for (std::size_t i = 0; i < curves.theta_deg.size(); ++i)
      rows.push_back({fmt::format("{:.6g}", curves.theta_deg[i])});
    for (const std::size_t k : shown_steps(curves.steps.size())) {
      rows.front().push_back(k == 0 ? "before" : fmt::format("step {}", k));
      for (std::size_t i = 0; i < curves.theta_deg.size(); ++i) {
        rows[i + 1].push_back(format_estimate((curves.steps[k].*side)[c][i]));
      }
    }
    text += format_table(rows, 0, color) + "\n";
  }
  return text;
}

void print_curves(Session& session, const Operand& operand, const Curves& curves) {
  if (session.wants_json()) return;
  const auto channels = channel_labels(std::span(&operand, 1));
  session.print(curves_text("albedo", curves, &PumpStep::albedo, channels, session.colors_output()));
  session.print(curves_text("mirror radiance f(L,R) cos theta, sr^-1", curves, &PumpStep::mirror_radiance, channels,
                            session.colors_output()));
}

Json curves_json(const Curves& curves) {
  const auto values = [&](const std::vector<std::vector<Estimate>>& channels) {
    Json json = Json::array();
    for (const auto& channel : channels) {
      Json& list = json.emplace_back(Json::array());
      for (const auto& estimate : channel) list.push_back(to_json(estimate));
    }
    return json;
  };
  Json json{{"theta_deg", curves.theta_deg}, {"steps", Json::array()}};
  for (const auto& step : curves.steps) {
    json["steps"].push_back({{"albedo", values(step.albedo)}, {"mirror_radiance", values(step.mirror_radiance)}});
  }
  return json;
}

/// The picture of one quantity, of the first channel.
void draw(Session& session, const Curves& curves, Side side, ChartQuantity quantity, const fs::path& path) {
  Chart chart;
  chart.name = "pump";
  chart.title = "Pumping-up by " + session.arguments().text(kCorrection);
  chart.quantity = quantity;
  for (const double degrees : curves.theta_deg) chart.x.push_back(degrees * kDegree);
  ChartValues values;
  for (const std::size_t k : shown_steps(curves.steps.size())) {
    chart.curves.push_back({.label = k == 0 ? "before" : fmt::format("step {}", k), .materials = {}});
    values.push_back((curves.steps[k].*side).front());
  }
  draw_chart(session, chart, values, path);
}

/// STEM.png of the albedos and STEM.mirror-radiance.png.
void draw(Session& session, const Curves& curves) {
  const fs::path stem = *picture_stem(session.arguments());
  draw(session, curves, &PumpStep::albedo, ChartQuantity::albedo, stem);
  draw(session, curves, &PumpStep::mirror_radiance, ChartQuantity::mirror_radiance,
       fs::path(stem.string() + ".mirror-radiance"));
}

/// Findings that every pumping-up reports.
Findings findings_of(const PumpRequest& request, std::size_t steps, bool is_converged, const Curves& curves) {
  Findings findings;
  findings.fields.push_back({"steps", fmt::format("{}{}", steps, is_converged ? ", converged" : "")});
  findings.json["correction"] = to_string(request.correction);
  findings.json["times"] = steps;
  findings.json["is_converged"] = is_converged;
  findings.json["tolerance"] = request.options.tolerance;
  findings.json["curves"] = curves_json(curves);
  return findings;
}

/// The steps at the angles nearest to those wanted, each once; none wanted: at all of them. Of several directions of
/// one angle, as general tables have them, the first.
Curves curves_at(const Pumped& pumped, const std::vector<double>& theta_deg) {
  std::vector<std::size_t> first;  // of each angle
  for (std::size_t i = 0; i < pumped.theta_in.size(); ++i) {
    const auto is_same = [&](std::size_t k) { return pumped.theta_in[k] == pumped.theta_in[i]; };
    if (std::ranges::none_of(first, is_same)) first.push_back(i);
  }
  std::vector<std::size_t> chosen;
  for (const std::size_t i : first) {
    const bool is_wanted = std::ranges::any_of(theta_deg, [&](double degrees) {
      const auto distance = [&](std::size_t k) { return std::abs(pumped.theta_in[k] - degrees * kDegree); };
      return *std::ranges::min_element(first, {}, distance) == i;
    });
    if (theta_deg.empty() || is_wanted) chosen.push_back(i);
  }
  Curves curves;
  for (const std::size_t i : chosen) curves.theta_deg.push_back(to_degrees(pumped.theta_in[i]));
  const auto select = [&](const std::vector<std::vector<Estimate>>& channels) {
    std::vector<std::vector<Estimate>> selected;
    for (const auto& channel : channels) {
      auto& list = selected.emplace_back();
      for (const std::size_t i : chosen) list.push_back(channel[i]);
    }
    return selected;
  };
  for (const PumpStep& step : pumped.steps) {
    curves.steps.push_back({select(step.albedo), select(step.mirror_radiance)});
  }
  return curves;
}

/// Specification that pumps a material up in this way; for files the line that they need.
std::string specification(const std::string& text, const Adjustment& adjustment) {
  if (!text.ends_with(".toml")) return text + "@" + to_string(adjustment);
  return fmt::format("{} with adjustments = [\"{}\"]", text, to_string(adjustment));
}

/// The steps at `count` of their angles from the one of number `first` on.
std::vector<PumpStep> some_of(const std::vector<PumpStep>& steps, std::size_t first, std::size_t count) {
  const auto cut = [&](std::vector<std::vector<Estimate>> channels) {
    for (auto& channel : channels) {
      const auto begin = channel.begin() + static_cast<std::ptrdiff_t>(first);
      channel = std::vector<Estimate>(begin, begin + static_cast<std::ptrdiff_t>(count));
    }
    return channels;
  };
  std::vector<PumpStep> some;
  for (const PumpStep& step : steps) some.push_back({cut(step.albedo), cut(step.mirror_radiance)});
  return some;
}

ExitCode pump_table(Session& session, const Operand& operand, const PumpRequest& request) {
  const std::array operands{operand};
  const TableOutput output(session);
  const Device& device = session.choose_device();
  const auto grid = common_grid(session, device, operands);
  const std::uint64_t bytes = value_bytes(operand, grid);
  // The table, two divisors and the result, which stays.
  session.state_memory(tabulated_bytes(operands, grid) + 3 * bytes, 2 * bytes);
  const Reflectance before = tabulated(session, device, operand, grid, tabulate_options(session));
  const Pumped pumped = pump(device, before, request.correction, request.options);
  const Curves curves = curves_at(pumped, request.theta_deg);
  if (session.arguments().has(option::plot)) draw(session, curves_at(pumped, {}));
  if (!pumped.obstacle.empty()) session.warn_of_miss("not converged: " + pumped.obstacle);
  print_curves(session, operand, curves);
  Findings findings = findings_of(request, pumped.steps.size() - 1, pumped.is_converged, curves);
  findings.json["change"] = pumped.change;
  add_displacement(findings, device, before, pumped.result);
  return finish(session, "pump", device, *pumped.result.table(), output, findings);
}

ExitCode pump_formulas(Session& session, const Operand& operand, PumpRequest request) {
  const auto& arguments = session.arguments();
  if (request.options.times.value_or(1) > kMaterialSteps) {
    throw ArgumentError(fmt::format("--times {} of a material; expected at most {}, or a table ('lobe tabulate')",
                                    *request.options.times, kMaterialSteps));
  }
  const TableOutput output(session);
  const Device& device = session.choose_device();
  auto& angles = request.options.theta_in;
  for (const double degrees : request.theta_deg) angles.push_back(degrees * kDegree);
  const std::size_t told = angles.size();
  const auto drawn =
      arguments.has(option::plot) ? default_abscissae(ChartQuantity::albedo, false) : std::vector<double>();
  angles.insert(angles.end(), drawn.begin(), drawn.end());
  const Pumped pumped = pump(device, operand.shape(), request.correction, request.options);
  const int times = static_cast<int>(pumped.steps.size()) - 1;
  const Adjustment adjustment{Adjustment::Kind::pump, request.correction, times};
  const Curves curves{request.theta_deg, some_of(pumped.steps, 0, told)};
  if (!drawn.empty()) {
    Curves picture{{}, some_of(pumped.steps, told, drawn.size())};
    for (const double angle : drawn) picture.theta_deg.push_back(angle / kDegree);
    draw(session, picture);
  }
  if (!pumped.obstacle.empty()) session.warn_of_miss("not converged: " + pumped.obstacle);
  Findings findings = findings_of(request, pumped.steps.size() - 1, pumped.is_converged, curves);
  const std::string text = specification(arguments.text(argument::material), adjustment);
  findings.json["specification"] = text;
  print_curves(session, operand, curves);
  if (output.is_wanted()) {
    Material last = *pumped.result.formula();
    last.name = text;
    const Operand result(last);
    const auto grid = common_grid(session, device, {&result, 1});
    session.state_memory(tabulated_bytes({&result, 1}, grid), value_bytes(result, grid));
    return finish(session, "pump", device, tabulated(session, device, result, grid, tabulate_options(session)), output,
                  findings);
  }
  if (!session.wants_json()) {
    findings.fields.push_back({"specification", text});
    session.print(fields_text(findings.fields));
    return ExitCode::success;
  }
  Json answer = json_answer("pump");
  answer.update(findings.json);
  answer["units"] = {{"theta", "deg"}, {"albedo", "1"}, {"mirror_radiance", "sr^-1"}};
  answer["device"] = to_json(device.info());
  session.print_json(answer);
  return ExitCode::success;
}

ExitCode execute_pump(Session& session) {
  static_cast<void>(picture_stem(session.arguments()));  // before anything is computed
  const PumpRequest request = request_of(session);
  const Operand operand = session.operand(argument::material);
  const bool has_formulas = operand.is_formula() && operand.shape().is_isotropic();
  return has_formulas ? pump_formulas(session, operand, request) : pump_table(session, operand, request);
}

}  // namespace

Command pump_command() {
  return {
      .name = "pump",
      .group = "Repair",
      .summary = "brighten a reflectance by its own albedos",
      .description =
          "Brightens a reflectance (energy compensation): divides it by g(L, V), step by step, and prints its albedos "
          "and mirror radiances before and after. Afterwards no albedo exceeds 1, and none is smaller than before if "
          "all were at most 1.\n"
          "g1 = max(a(L), a(V)), with the albedos of the previous step: albedos tend to 1, and radiances may exceed "
          "those of the light. g2 = max(a(L), a(V), N.L, N.V) is the printed recursion (2.21) of 'controlled "
          "pumping-up'; applied repeatedly, it does not keep its promises: its albedos also tend to 1, its mirror "
          "radiances exceed those of the light from the second step on, and for Phong it equals g1 throughout. "
          "'controlled' bounds the divisor of all steps together, G = max(G' max(a(L), a(V)), N.L, N.V), and keeps "
          "them: no radiance exceeds that of the light, and albedos stay below 1.\n"
          "A material is pumped up by albedos of its formula; the command prints the specification that does the same "
          "wherever a material is expected, and tabulates it with --output. A table is pumped up by its own albedos, "
          "the sums over its grid, at the angles of its rings. Delta parts are divided by g at (L, R) and (L, L); the "
          "radiances exclude them. Anisotropic models and albedos that jump can be pumped up as tables only (lobe "
          "tabulate).",
      .positionals = {{.handle = argument::material, .help = "the material or table", .is_material = true}},
      .options = table_command_options(
          {{.handle = kCorrection,
            .value = "KIND",
            .help = "the divisor",
            .choices = {"g1", "g2", "controlled"},
            .required = true},
           {.handle = kTimes,
            .value = "N",
            .help = "number of steps (default 1), or until-converged: until no albedo changes by more than "
                    "--tolerance, at most 10 steps for a material, 200 for a table"},
           {.handle = kPumpTheta,
            .value = "A",
            .help = "angles of incidence in degrees (default 0,15,30,45,60,75,85,89)"},
           plot_option("draw the albedos into this file (.png), and the mirror radiances into another beside it"),
           tolerance_option("absolute change of albedos that counts as converged (default 1e-4)")},
          "the grid (default: the table's own; else as fine as a material or file needs)", false),
      .examples = {{"a Phong lobe that becomes metallic in two steps",
                    "lobe pump phong:n=20 --correction controlled --times 2"},
                   {"a brighter paint, as a table",
                    "lobe pump lambert:scale=0.3+phong:n=20,scale=0.4 --correction g1 -o paint.h5"}},
      .execute = execute_pump};
}

}  // namespace lobe::cli
