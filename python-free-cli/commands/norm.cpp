#include <array>
#include <optional>

#include "interface/measuring.hpp"
#include "interface/options.hpp"
#include "lobe/core/error.hpp"

namespace lobe::cli {
namespace {

/// \param channel none: of all together
Figure norm_of(const Measurement& measurement, std::optional<std::size_t> channel = {}) {
  const MetricResult& result = measurement.results.front();
  const Metric& metric = channel ? result.channels[*channel] : result.combined;
  Figure norm{{metric.norm(0), metric.norm_error(0)}};
  if (!measurement.deviations.empty()) {
    const MetricDeviations& found = measurement.deviations.front();
    norm.measurement = (channel ? found.channels[*channel] : found.combined).norm(0);
  }
  return norm;
}

std::vector<Figure> norms_of_channels(const Measurement& measurement) {
  std::vector<Figure> norms;
  for (std::size_t c = 0; c < measurement.results.front().channels.size(); ++c) {
    norms.push_back(norm_of(measurement, c));
  }
  return norms;
}

void print_json(Session& session, const Operand& operand, const Measurement& measurement) {
  const MetricResult& result = measurement.results.front();
  Json answer = json_answer("norm");
  answer["a"] = operand_json(operand);
  answer["lighting"] = result.lighting.name();
  answer["tolerance"] = result.tolerance;
  answer["units"] = {{"norm", norm_unit(result.lighting)}};
  answer["norm"] = to_json(norm_of(measurement));
  if (!result.channels.empty()) {
    answer["channels"] = Json::array();
    for (const auto& norm : norms_of_channels(measurement)) answer["channels"].push_back({{"norm", to_json(norm)}});
  }
  answer["reached_tolerance"] = result.unresolved.empty();
  answer.update(circumstances_json(measurement));
  session.print_json(answer);
}

ExitCode execute_norm(Session& session) {
  const std::array operands{session.operand(argument::a)};
  const auto lightings = lightings_of(session.arguments());
  if (lightings.size() > 1) throw ArgumentError("--lighting is given more than once; give it once");

  const Measurement measurement = measured(session, operands, lightings);
  const auto require_norm = [&](const Metric& metric) {
    require_root({metric.norm(0), metric.norm_error(0)}, "norm of '" + operands.front().label() + "'",
                 {metric.gram(0, 0), metric.gram_error(0, 0)}, measurement.results.front().lighting);
  };
  require_norm(measurement.results.front().combined);
  for (const Metric& channel : measurement.results.front().channels) require_norm(channel);
  if (session.wants_json()) {
    print_json(session, operands.front(), measurement);
    return ExitCode::success;
  }
  session.print(channels_text(norm_of(measurement), norms_of_channels(measurement), operands, measurement));
  return ExitCode::success;
}

}  // namespace

Command norm_command() {
  std::vector<Option> options = measuring_options(false);
  options.push_back(json_option());
  return {.name = "norm",
          .group = "Metric",
          .summary = "compute the norm of a material",
          .description =
              "Computes the norm |A| of a material under a lighting, the square root of its product with itself, with "
              "an error bound; for materials with several channels, over all channels together and for each one.\n"
              "A mirror has no norm under 'point': it would be infinite.",
          .positionals = {{.handle = argument::a, .help = "the material or table", .is_material = true}},
          .options = std::move(options),
          .examples = {{"a sharp highlight has a large norm under point light", "lobe norm ward:m=0.02"},
                       {"but not under daylight", "lobe norm ward:m=0.02 --lighting daylight"}},
          .execute = execute_norm};
}

}  // namespace lobe::cli
