#include "interface/pair.hpp"

#include "interface/options.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"

namespace lobe::cli {
namespace {

/// \param deviations null: none are known
Pair pair_of(const Metric& metric, const ProductDeviations* deviations) {
  const Estimate radians = angle(metric, 0, 1);
  Pair pair{.distance = {{metric.distance(0, 1), metric.distance_error(0, 1)}},
            .norm_a = {{metric.norm(0), metric.norm_error(0)}},
            .norm_b = {{metric.norm(1), metric.norm_error(1)}},
            .product = {{metric.gram(0, 1), metric.gram_error(0, 1)}},
            .angle_deg = {{to_degrees(radians.value), to_degrees(radians.error)}}};
  if (deviations != nullptr) {
    pair.distance.measurement = deviations->distance(0, 1);
    pair.norm_a.measurement = deviations->norm(0);
    pair.norm_b.measurement = deviations->norm(1);
    pair.product.measurement = deviations->gram(0, 1);
    pair.angle_deg.measurement = to_degrees(deviations->angle(0, 1));
  }
  return pair;
}

Json pair_json(const Pair& pair) {
  return {{"distance", to_json(pair.distance)},
          {"norm_a", to_json(pair.norm_a)},
          {"norm_b", to_json(pair.norm_b)},
          {"product", to_json(pair.product)},
          {"angle_deg", to_json(pair.angle_deg)}};
}

void print_json(Session& session, std::string_view command, const PairAnswer& found, const Json& more) {
  Json answer = json_answer(command);
  answer["a"] = operand_json(found.operands[0]);
  answer["b"] = operand_json(found.operands[1]);
  answer["lighting"] = found.lighting.name();
  answer["tolerance"] = found.measurement.results.front().tolerance;
  answer["units"] = {{"distance", norm_unit(found.lighting)},
                     {"norm", norm_unit(found.lighting)},
                     {"product", product_unit(found.lighting)},
                     {"angle_deg", "degree"}};
  answer.update(pair_json(found.combined));
  if (!found.channels.empty()) {
    answer["channels"] = Json::array();
    for (const auto& channel : found.channels) answer["channels"].push_back(pair_json(channel));
  }
  answer["reached_tolerance"] = found.measurement.results.front().unresolved.empty();
  answer.update(more);
  answer.update(circumstances_json(found.measurement));
  session.print_json(answer);
}

}  // namespace

PairAnswer compare(Session& session, InfiniteNorms norms) {
  const std::array operands{session.operand(argument::a), session.operand(argument::b)};
  const auto lightings = lightings_of(session.arguments());
  if (lightings.size() > 1) throw ArgumentError("--lighting is given more than once; give it once");

  const bool may_cancel = norms == InfiniteNorms::of_equal_deltas && operands[0].shape().has_delta();
  const bool allow_infinite =
      norms == InfiniteNorms::allowed ||
      (may_cancel && have_equal_deltas(session.choose_device(), operands[0].reflectance(), operands[1].reflectance()));
  Measurement measurement = measured(session, operands, lightings, {}, allow_infinite);
  const MetricResult& result = measurement.results.front();
  std::vector<Pair> channels;
  const MetricDeviations* found = measurement.deviations.empty() ? nullptr : measurement.deviations.data();
  for (std::size_t c = 0; c < result.channels.size(); ++c) {
    channels.push_back(pair_of(result.channels[c], found == nullptr ? nullptr : &found->channels[c]));
  }
  const Pair combined = pair_of(result.combined, found == nullptr ? nullptr : &found->combined);
  return {operands, lightings.front(), std::move(measurement), combined, std::move(channels)};
}

void require_norms(const PairAnswer& answer) {
  const MetricResult& result = answer.measurement.results.front();
  const auto require = [&](const Metric& metric) {
    for (const int k : {0, 1}) {
      require_root({metric.norm(k), 0}, "norm of '" + answer.operands.at(static_cast<std::size_t>(k)).label() + "'",
                   {metric.gram(k, k), metric.gram_error(k, k)}, result.lighting);
    }
  };
  require(result.combined);
  for (const Metric& channel : result.channels) require(channel);
}

void require_distance(const PairAnswer& answer) {
  const MetricResult& result = answer.measurement.results.front();
  const auto require = [&](const Metric& metric) {
    const Eigen::MatrixXd& gram = metric.gram;
    const Eigen::MatrixXd& error = metric.gram_error;
    require_root({metric.distance(0, 1), 0},
                 "distance of '" + answer.operands[0].label() + "' and '" + answer.operands[1].label() + "'",
                 {gram(0, 0) - 2 * gram(0, 1) + gram(1, 1), error(0, 0) + 2 * error(0, 1) + error(1, 1)},
                 result.lighting);
  };
  require(result.combined);
  for (const Metric& channel : result.channels) require(channel);
}

void print(Session& session, std::string_view command, const PairAnswer& answer, Figure Pair::*quantity,
           const Json& more) {
  if (session.wants_json()) {
    print_json(session, command, answer, more);
  } else {
    std::vector<Figure> channels;
    for (const auto& channel : answer.channels) channels.push_back(channel.*quantity);
    session.print(channels_text(answer.combined.*quantity, channels, answer.operands, answer.measurement));
  }
  const Pair& pair = answer.combined;
  session.remark(format_table({{"|A|", format_figure(pair.norm_a)},
                               {"|B|", format_figure(pair.norm_b)},
                               {"A.B", format_figure(pair.product)},
                               {"|A-B|", format_figure(pair.distance)},
                               {"angle/deg", format_figure(pair.angle_deg)}},
                              2, false));
}

std::vector<Positional> pair_positionals() {
  return {{.handle = argument::a, .help = "the first material or table", .is_material = true},
          {.handle = argument::b, .help = "the second material or table", .is_material = true}};
}

std::vector<Option> pair_options(const std::vector<Option>& own) {
  std::vector<Option> options = measuring_options(false);
  options.insert(options.end(), own.begin(), own.end());
  options.push_back(json_option());
  return options;
}

}  // namespace lobe::cli
