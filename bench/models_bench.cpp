// Cost of evaluating each model, against Phong and against the elementary functions that it calls, as a page
// of documentation on standard output. Usage: bench_models [--smoke]
#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <exception>
#include <string>
#include <string_view>
#include <vector>

#include "device/evaluate_lobes.hpp"
#include "lobe/lobe.hpp"
#include "measure.hpp"
#include "model/catalogue.hpp"
#include "model_costs.hpp"
#include "operation_counts.hpp"

namespace {

using lobe::Precision;

constexpr double kLeastShare = 0.25;

/// Parameters in the middle of what is used: a default, else a value that rises from lobe to lobe.
double typical_value(const lobe::Parameter& parameter, double share) {
  if (parameter.default_value) return *parameter.default_value;
  if (parameter.name.starts_with("c_x") || parameter.name.starts_with("c_y")) return -1;  // Lafortune: about the mirror
  if (parameter.name == "sigma") return std::clamp(0.18, parameter.minimum, parameter.maximum);
  return std::clamp(0.2 + share, parameter.minimum, parameter.maximum);
}

lobe::LobeBatch typical_lobes(const lobe::CatalogueEntry& entry) {
  lobe::LobeBatch batch{{.model = std::string(entry.kernel), .is_anisotropic = !entry.model.traits.isotropic}, {}};
  for (std::size_t lobe = 0; lobe < bench::kLobes; ++lobe) {
    std::vector<double> values;
    for (const auto& parameter : entry.model.parameters) {
      values.push_back(typical_value(parameter, static_cast<double>(lobe) / static_cast<double>(bench::kLobes)));
    }
    batch.coefficients.push_back(entry.coefficients(values));
  }
  return batch;
}

/// Coefficient that is the number of terms of a model's series; 0 for models without one.
double terms_of(const lobe::LobeBatch& batch) {
  if (batch.kernel.model == "he_torrance") return batch.coefficients.front()[6];
  if (batch.kernel.model == "stam") return batch.coefficients.front()[5];
  return 0;
}

struct Row {
  const lobe::CatalogueEntry* entry;
  std::vector<bench::ModelCost> costs;  ///< double, single precision
};

/// "3 exp, 2 divide"; what is computed once per node and not per lobe is left out.
std::string text(const bench::OperationCounts& counts) {
  std::string list;
  for (const auto& [name, count] : counts) {
    if (count >= 0.5) list += fmt::format("{}{:.0f} {}", list.empty() ? "" : ", ", count, name);
  }
  return list.empty() ? "none" : list;
}

void print_operations(const std::vector<bench::CostTable>& tables) {
  fmt::print("\n## Elementary functions\n\n| | ns, double | ns, single |\n|---|---|---|\n");
  fmt::print("| load, multiply, store | {:.2f} | {:.2f} |\n", 1e9 * tables[0].base, 1e9 * tables[1].base);
  for (const auto& [name, seconds] : tables[0].operations) {
    const auto single = tables[1].operations.find(name);
    fmt::print("| {} | {:.2f} | {} |\n", name, 1e9 * seconds,
               single == tables[1].operations.end() ? "" : fmt::format("{:.2f}", 1e9 * single->second));
  }
}

struct Claim {
  std::string_view where;
  std::string_view model;
  std::string_view other;
  double ratio;  ///< of their times
};
constexpr std::array kClaims{
    Claim{"section 1.2.3", "he_torrance", "ward", 75}, Claim{"section 4.8", "exponential_patch", "blinn_phong", 1},
    Claim{"section 4.8", "exponential_patch", "ward", 0.5}, Claim{"section 4.8", "basic_patch", "blinn_phong", 1},
    Claim{"section 4.8", "basic_patch", "ward", 0.5}};

bool is_in_a_claim(std::string_view model) {
  return std::ranges::any_of(kClaims, [&](const Claim& c) { return c.model == model || c.other == model; });
}

void print_claims(const std::vector<Row>& rows) {
  constexpr double kNear = 0.25;  // programs of two decades apart
  const auto costs = [&](std::string_view name) -> const std::vector<bench::ModelCost>& {
    return std::ranges::find_if(rows, [&](const Row& row) { return row.entry->model.name == name; })->costs;
  };
  fmt::print(
      "\n## What the dissertation says\n\n"
      "Running times of Neumann 2001, against those here; a claim holds when the ratio is within a quarter of it.\n"
      "There, a model began with vectors; here all of them get their cosines ready. The series of he_torrance has\n"
      "{:.0f} terms. \"The new model\" of section 4.8 is a profile over the base-plane distance: `exponential_patch`, "
      "and\n"
      "`basic_patch`, a constant.\n\n"
      "| | claim | double | single | holds |\n|---|---|---|---|---|\n",
      terms_of(typical_lobes(lobe::find_entry("he_torrance"))));
  for (const auto& claim : kClaims) {
    std::string line = fmt::format("| {}: {} against {} | {} |", claim.where, claim.model, claim.other, claim.ratio);
    bool holds = true;
    for (std::size_t p = 0; p < 2; ++p) {
      const auto ratio = bench::ratio_of(costs(claim.model)[p].rounds, costs(claim.other)[p].rounds);
      holds = holds && std::abs(ratio.value - claim.ratio) <= kNear * claim.ratio;
      line += fmt::format(" {:.2f} ± {:.2f} |", ratio.value, ratio.error);
    }
    fmt::print("{} {} |\n", line, holds ? "yes" : "no");
  }
}

void print_page(const lobe::Device& device, const std::vector<Row>& rows, const std::vector<bench::CostTable>& tables,
                int rounds) {
  fmt::print(
      "# What an evaluation costs\n\n"
      "Written by `build/bin/bench_models`. An evaluation is one lobe at one pair of directions, through the "
      "library's\n"
      "evaluator: {} lobes at {} pairs, values in the cache. Rates are those of {} processors at work, from processor "
      "time,\n"
      "medians of {} rounds, each with every model; ± is the median deviation of a round. Vectors have 8 lanes;\n"
      "{}. Measured on {:%F} by lobe {} on {}.\n\n"
      "*Bound*: the time of the model's elementary functions and divisions alone, each timed in the same rounds, or "
      "of\n"
      "loads and stores where that is longer. Counts are clang's, of the code as it is compiled with its launcher. "
      "What\n"
      "depends on the directions alone is computed once for all lobes and counts as its share of one; additions and\n"
      "multiplications do not count. *Share* is the throughput as a share of what the bound would allow.\n\n",
      bench::kLobes, bench::kNodes, device.info().compute_units, rounds, bench::vector_extension(),
      fmt::gmtime(std::chrono::system_clock::to_time_t(std::chrono::system_clock::now())), lobe::version(),
      device.info().name);
  fmt::print(
      "| model | Mevaluations/s, double | cost, Phong = 1 | share | single | cost | share | calls per lobe |\n"
      "|---|---|---|---|---|---|---|---|\n");
  for (const auto& row : rows) {
    std::string line = fmt::format("| {} |", row.entry->model.name);
    for (const auto& cost : row.costs) {
      line += fmt::format(" {:.0f} | {:.2f} ± {:.2f} | {:.0f} % |", 1e-6 / cost.seconds, cost.to_phong.value,
                          cost.to_phong.error, 100 * cost.share);
    }
    fmt::print("{} {} |\n", line, text(row.costs[0].counts));
  }

  fmt::print("\n## Below {:.0f} % of the bound\n\n", 100 * kLeastShare);
  std::size_t below = 0;
  for (const auto& row : rows) {
    for (std::size_t p = 0; p < 2; ++p) {
      if (row.costs[p].share >= kLeastShare) continue;
      ++below;
      fmt::print("* {}, {}: {:.0f} %\n", row.entry->model.name, p == 0 ? "double" : "single", 100 * row.costs[p].share);
    }
  }
  if (below == 0) fmt::print("None.\n");

  print_claims(rows);
  print_operations(tables);
}

}  // namespace

int main(int argc, char** argv) {
  const bool smoke = argc > 1 && std::string_view(argv[1]) == "--smoke";
  try {
    const auto device = lobe::Device::choose();
    const int rounds = smoke ? 1 : 15;
    std::vector<Row> rows;
    for (const auto& entry : lobe::catalogue_entries()) {
      if (entry.kernel.empty()) continue;
      if (!smoke || entry.model.name == "phong" || is_in_a_claim(entry.model.name)) rows.push_back({&entry, {}});
    }
    std::vector<bench::CostTable> tables;
    for (const auto precision : {Precision::double_precision, Precision::single_precision}) {
      std::vector<bench::CountedLobes> models;
      for (const auto& row : rows) {
        auto batch = typical_lobes(*row.entry);
        const double terms = terms_of(batch);
        models.push_back({std::string(row.entry->model.name), std::move(batch), terms});
      }
      tables.push_back(bench::measure_costs(device, models, precision, rounds));
      for (std::size_t i = 0; i < rows.size(); ++i) rows[i].costs.push_back(tables.back().models[i]);
    }
    print_page(device, rows, tables, rounds);
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "bench_models: {}\n", error.what());
    return 1;
  }
}
