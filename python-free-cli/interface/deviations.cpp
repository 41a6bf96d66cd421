#include "interface/deviations.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "lobe/core/error.hpp"
#include "lobe/formats/measurement.hpp"
#include "lobe/reflectance/as_function.hpp"

namespace lobe::cli {

std::string format_figure(const Figure& figure) {
  const std::string text = format_estimate(figure.estimate);
  if (!figure.measurement) return text;
  return text + fmt::format(" (numerical) ± {:.2g} (measurement)", *figure.measurement);
}

Json to_json(const Figure& figure) {
  Json json = to_json(figure.estimate);
  if (figure.measurement) json["measurement"] = to_json(*figure.measurement);
  return json;
}

std::vector<Figure> figures(std::span<const Estimate> estimates, std::span<const double> deviations) {
  std::vector<Figure> list;
  for (std::size_t k = 0; k < estimates.size(); ++k) {
    list.push_back({estimates[k]});
    if (!deviations.empty()) list.back().measurement = deviations[k];
  }
  return list;
}

bool state_deviations(std::span<const Operand> operands) {
  return std::ranges::any_of(operands, &Operand::states_deviations);
}

std::vector<BrdfFunction> replicated(Session& session, std::span<const Operand> operands) {
  if (!state_deviations(operands)) return {};
  std::vector<BrdfFunction> functions;
  std::vector<std::size_t> source;
  for (std::size_t k = 0; k < operands.size(); ++k) {
    const Operand& operand = operands[k];
    try {
      if (operand.states_deviations()) {
        functions.push_back(operand.replicated(kReplicates));
      } else {
        functions.push_back(as_function(session.device(), operand.reflectance()));
      }
    } catch (const ArgumentError& error) {
      session.warn(fmt::format("standard deviations are not followed: {}", error.what()));
      return {};
    }
    if (operand.states_deviations() && functions.back().replicates == 0) {
      session.warn(
          fmt::format("{} has too many samples for their standard deviations to be followed", operand.label()));
    }
    const auto same = std::ranges::find(operands.first(k), operand.label(), &Operand::label);
    source.push_back(static_cast<std::size_t>(same - operands.begin()));
  }
  if (std::ranges::all_of(functions, [](const BrdfFunction& f) { return f.replicates == 0; })) return {};
  return aligned_replicates(functions, source);
}

std::size_t own_channels(std::span<const BrdfFunction> functions) {
  return lobe::own_channels(functions.front());
}

}  // namespace lobe::cli
