// What giving back the energy that microfacet models lose does to them, and what it costs, as the tables of
// docs/energy-compensation.md on standard output. Usage: bench_compensation [--smoke]
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <memory>
#include <numbers>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "device/error.hpp"
#include "device/evaluate_lobes.hpp"
#include "hemisphere/geometry.hpp"
#include "lobe/lobe.hpp"
#include "measure.hpp"
#include "model/lobes.hpp"

namespace {

using lobe::Estimate;
using lobe::Reflectance;

constexpr std::size_t kNodes = 2048;
constexpr std::size_t kCopies = 64;  // of a lobe, as an evaluator has many

/// A model, and whether the grid of the balanced tables resolves it.
struct Model {
  std::string_view text;
  bool is_balanced;
};
constexpr std::array kModels{Model{"ggx:alpha=0.2", false},
                             Model{"ggx:alpha=0.5", true},
                             Model{"ggx:alpha=1", true},
                             Model{"ggx_separable:alpha=0.5", true},
                             Model{"ggx_separable:alpha=1", true},
                             Model{"beckmann:m=0.5", true},
                             Model{"beckmann_separable:m=0.5", true},
                             Model{"cook_torrance:m=0.5", false},
                             Model{"cook_torrance_smith:m=0.5", true},
                             Model{"disney_specular:rough=0.7", true}};

/// What is done to a model.
struct Treatment {
  std::string_view name;
  std::string_view adjustment;
};
constexpr std::array kTreatments{
    Treatment{"as it is", ""},
    Treatment{"`@kulla_conty`", "@kulla_conty"},
    Treatment{"`@turquin`", "@turquin"},
    Treatment{"`@pump` (g1)", "@pump"},
    Treatment{"`@pump:correction=g2`", "@pump:correction=g2"},
    Treatment{"`@pump:correction=controlled,times=2`", "@pump:correction=controlled,times=2"}};

struct Column {
  std::string_view head;
  std::optional<lobe::LiteratureMetric> metric;  ///< none: a lighting
};
constexpr std::array kColumns{Column{"point", {}},
                              Column{"daylight", {}},
                              Column{"ngan-l2", lobe::LiteratureMetric::ngan_l2},
                              Column{"low-l2", lobe::LiteratureMetric::low_l2},
                              Column{"bieron-l2", lobe::LiteratureMetric::bieron_l2},
                              Column{"bieron-log", lobe::LiteratureMetric::bieron_log},
                              Column{"log-relative", lobe::LiteratureMetric::log_relative},
                              Column{"albedo-of-difference", lobe::LiteratureMetric::albedo_of_difference},
                              Column{"cube-root-l2", lobe::LiteratureMetric::cube_root_l2},
                              Column{"cube-root-log", lobe::LiteratureMetric::cube_root_log}};

/// Pairs of directions, the same for all.
lobe::NodeBlock random_nodes() {
  std::mt19937 engine(4);
  std::uniform_real_distribution<double> theta(0, 0.49 * std::numbers::pi);
  std::uniform_real_distribution<double> phi(-std::numbers::pi, std::numbers::pi);
  lobe::NodeBlock block(kNodes);
  for (std::size_t node = 0; node < kNodes; ++node) {
    block.push(lobe::node_of_directions({theta(engine), theta(engine), phi(engine), phi(engine)}));
  }
  return block;
}

/// Times a material as so many of its kind, term by term.
bench::Contender contender(const lobe::Device& device, const std::string& name, const lobe::Material& material) {
  auto batches = lobe::make_lobe_set({&material, 1}).batches;
  for (lobe::LobeBatch& batch : batches) {
    batch.coefficients.resize(kCopies, batch.coefficients.front());
    if (!batch.curves.empty()) batch.curves.resize(kCopies, batch.curves.front());
  }
  const auto evaluator =
      std::make_shared<lobe::LobeEvaluator>(device, batches, lobe::Precision::double_precision, kNodes);
  const auto nodes = std::make_shared<lobe::NodeBlock>(random_nodes());
  return {name, [evaluator, nodes, device] {
            evaluator->evaluate(*nodes);
            lobe::finish(device);
          }};
}

/// "0.858 to 0.971", or one number where both are the same; 1 less 1e-5 is not 1.000.
std::string range(const std::vector<Estimate>& albedos) {
  const auto [least, most] = std::ranges::minmax(albedos, {}, &Estimate::value);
  constexpr double kWhite = 2 * lobe::kAdjustmentError;
  if (std::max(std::abs(least.value - 1), std::abs(most.value - 1)) <= kWhite) return "1";
  const auto number = [](double value) {
    if (std::abs(value - 1) <= kWhite) return std::string("1");
    for (int digits = 3; digits < 6; ++digits) {
      std::string text = fmt::format("{:.{}f}", value, digits);
      if (value >= 1 || !text.starts_with('1')) return text;
    }
    return fmt::format("{:.6f}", value);
  };
  return fmt::format("{} to {}", number(least.value), number(most.value));
}

/// One row of both tables.
struct Row {
  std::string name;
  std::string albedo, reciprocity, cost;
  std::vector<std::string> changes;
};

std::vector<std::string> changes(const lobe::Device& device, const Reflectance& before, const Reflectance& after,
                                 std::span<const Column> columns) {
  std::vector<std::string> list;
  const auto add = [&](double distance, double size) { list.push_back(fmt::format("{:.3f}", distance / size)); };
  for (const Column& column : columns) {
    if (column.metric) {
      const auto found = lobe::compare(device, {before, after}, *column.metric);
      add(found.combined.distance(0, 1), found.combined.size(0));
    } else {
      const auto found = lobe::measure(device, {before, after}, lobe::parse_lighting(column.head)).combined;
      add(found.distance(0, 1), found.norm(0));
    }
  }
  return list;
}

std::string reciprocity_of(const lobe::Device& device, const Reflectance& reflectance) {
  const auto found = lobe::check_plausibility(device, reflectance, {.with_mean_albedo = false}).channels.front();
  return found.is_reciprocal ? "yes" : fmt::format("no, up to {:.0f} %", 100 * found.reciprocity.relative);
}

/// How much is asked.
struct Extent {
  std::span<const Treatment> treatments;
  std::span<const Column> columns;
  int rounds;
};

std::vector<Row> rows_of(const lobe::Device& device, const Model& model, const Extent& extent) {
  std::vector<double> angles{0, 15, 30, 45, 60, 75, 85, 89};
  for (double& angle : angles) angle *= std::numbers::pi / 180;
  const Reflectance plain = lobe::parse_material(model.text);
  std::vector<Row> rows;
  std::vector<bench::Contender> contenders;
  for (const Treatment& treatment : extent.treatments) {
    const Reflectance given = lobe::parse_material(std::string(model.text) + std::string(treatment.adjustment));
    const Reflectance after = lobe::adjusted(device, given);
    contenders.push_back(contender(device, std::string(treatment.name), *after.formula()));
    rows.push_back({std::string(treatment.name),
                    range(lobe::albedo(device, after, angles).front()),
                    reciprocity_of(device, after),
                    {},
                    {}});
    if (!treatment.adjustment.empty()) rows.back().changes = changes(device, plain, after, extent.columns);
  }
  const auto timings = bench::measure_together(contenders, extent.rounds, bench::Clock::processors);
  for (std::size_t k = 0; k < timings.size(); ++k) {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < timings[k].rounds.size(); ++i) {
      ratios.push_back(timings[k].rounds[i] / timings.front().rounds[i]);
    }
    rows[k].cost = fmt::format("{:.1f}", bench::median(ratios));
  }
  if (!model.is_balanced) return rows;
  const auto table = lobe::tabulate(device, plain, lobe::HemisphereGrid::gauss(128, 256));
  const auto white = lobe::scale_symmetrically(device, table, {.to_white = true}).table;
  rows.push_back({"`lobe balance --white`", range(lobe::albedo(device, white, angles).front()),
                  reciprocity_of(device, white), "a table", changes(device, table, white, extent.columns)});
  return rows;
}

void print_tables(const std::vector<std::pair<std::string_view, std::vector<Row>>>& models,
                  std::span<const Column> columns) {
  fmt::print("| model | | albedo | reciprocal | cost |\n|---|---|---|---|---|\n");
  for (const auto& [text, rows] : models) {
    for (const Row& row : rows) {
      const bool is_first = &row == rows.data();
      fmt::print("| {} | {} | {} | {} | {} |\n", is_first ? fmt::format("`{}`", text) : "", row.name, row.albedo,
                 row.reciprocity, row.cost);
    }
  }
  fmt::print("\n| model | |");
  for (const Column& column : columns) fmt::print(" {} |", column.head);
  fmt::print("\n|---|---|");
  for (std::size_t k = 0; k < columns.size(); ++k) fmt::print("---|");
  fmt::print("\n");
  for (const auto& [text, rows] : models) {
    for (std::size_t k = 1; k < rows.size(); ++k) {
      fmt::print("| {} | {} |", k == 1 ? fmt::format("`{}`", text) : "", rows[k].name);
      for (const std::string& change : rows[k].changes) fmt::print(" {} |", change);
      fmt::print("\n");
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  const bool smoke = argc > 1 && std::string_view(argv[1]) == "--smoke";
  try {
    const auto device = lobe::Device::choose();
    const Extent extent = smoke ? Extent{std::span(kTreatments).first(3), std::span(kColumns).first(2), 1}
                                : Extent{kTreatments, kColumns, 15};
    std::vector<std::pair<std::string_view, std::vector<Row>>> models;
    for (const Model& model : kModels) {
      if (smoke && model.text != "ggx:alpha=0.5") continue;
      models.emplace_back(model.text, rows_of(device, smoke ? Model{model.text, false} : model, extent));
    }
    print_tables(models, extent.columns);
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "bench_compensation: {}\n", error.what());
    return 1;
  }
}
