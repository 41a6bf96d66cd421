#include <algorithm>
#include <cmath>
#include <limits>
#include <ranges>

#include "algebra/channel_mix.hpp"
#include "algebra/operands.hpp"
#include "core/parallel.hpp"
#include "core/text.hpp"
#include "lobe/algebra/algebra.hpp"
#include "lobe/core/error.hpp"
#include "model/traits.hpp"
#include "table/tabulate.hpp"

namespace lobe {
namespace {

/// Weight of a channel among those of a table.
double weight_of(const std::vector<double>& weights, std::size_t channel) {
  return weights[weights.size() == 1 ? 0 : channel];
}

/// Adds numbers of channels, each times its weight, or the weight's magnitude for errors.
void add_scaled(std::vector<double>& sum, const std::vector<double>& weights, const std::vector<double>& part,
                std::size_t channels, bool is_error) {
  if (part.empty()) return;
  sum.resize(part.size(), 0.0);
  const std::size_t size = part.size() / channels;
  for (std::size_t i = 0; i < part.size(); ++i) {
    const double weight = weight_of(weights, i / size);
    sum[i] += (is_error ? std::abs(weight) : weight) * part[i];
  }
}

/// sum of weight_k material_k as one material; none where a table has no single formula.
std::vector<Material> mixed_source(std::span<const std::vector<double>> weights, const Operands& tables,
                                   const std::string& name) {
  Material mixed{name, "mixture", {}};
  for (std::size_t k = 0; k < tables.size(); ++k) {
    if (tables[k].source.size() != 1) return {};
    for (Term term : tables[k].source.front().terms) {
      term.weight.resize(std::max(term.weight.size(), weights[k].size()), term.weight.front());
      for (std::size_t c = 0; c < term.weight.size(); ++c) term.weight[c] *= weight_of(weights[k], c);
      mixed.terms.push_back(std::move(term));
    }
  }
  return {std::move(mixed)};
}

std::string mixed_expression(std::span<const std::vector<double>> weights, std::span<const BrdfTable> tables) {
  std::string text;
  for (std::size_t k = 0; k < tables.size(); ++k) {
    text += k == 0 ? "mix(" : ", ";
    for (std::size_t c = 0; c < weights[k].size(); ++c) text += (c == 0 ? "" : "/") + shortest(weights[k][c]);
    text += " * " + tables[k].expression;
  }
  return text + ")";
}

}  // namespace

BrdfTable mix(std::span<const double> weights, std::span<const BrdfTable> tables, bool exact_grid) {
  std::vector<std::vector<double>> all;
  for (const double weight : weights) all.push_back({weight});
  return mix_channels(all, tables, exact_grid);
}

BrdfTable mix_channels(std::span<const std::vector<double>> weights, std::span<const BrdfTable> tables,
                       bool exact_grid) {
  if (tables.empty()) throw ArgumentError("nothing to mix; expected at least one table");
  if (weights.size() != tables.size()) {
    throw ArgumentError(std::to_string(weights.size()) + " weights for " + std::to_string(tables.size()) +
                        " tables; expected as many");
  }
  const auto is_finite = [](double weight) { return std::isfinite(weight); };
  if (!std::ranges::all_of(weights, [&](const auto& of_table) { return std::ranges::all_of(of_table, is_finite); })) {
    throw ArgumentError("a weight is no finite number");
  }
  std::vector<const BrdfTable*> pointers;
  for (const auto& table : tables) {
    check(table);
    pointers.push_back(&table);
  }
  OperandShape shape = common_shape(pointers, exact_grid);
  for (const auto& of_table : weights) shape.channels = std::max(shape.channels, of_table.size());
  const Operands operands(pointers, shape, resample);

  BrdfTable sum;
  sum.grid = operands[0].grid;
  sum.form = operands[0].form;
  sum.channels = operands[0].channels;
  sum.error.assign(operands[0].error.size(), 0);
  sum.expression = mixed_expression(weights, tables);
  sum.source = mixed_source(weights, operands, sum.expression);
  for (std::size_t k = 0; k < operands.size(); ++k) {
    add_scaled(sum.mirror, weights[k], operands[k].mirror, sum.channels, false);
    add_scaled(sum.retro, weights[k], operands[k].retro, sum.channels, false);
    add_scaled(sum.error, weights[k], operands[k].error, sum.channels, true);
    if (std::ranges::any_of(operands.all(), [](const BrdfTable* one) { return !one->even_error.empty(); })) {
      sum.odd_part.resize(sum.error.size(), 0.0);
      const auto& even = operands[k].even_error;
      add_scaled(sum.even_error, weights[k], even.empty() ? operands[k].error : even, sum.channels, true);
      add_scaled(sum.odd_part, weights[k], operands[k].odd_part, sum.channels, true);
    }
    if (sum.channel_names.empty()) sum.channel_names = operands[k].channel_names;
    // A maximum that keeps NaN: unknown.
    if (!(operands[k].resolution_error <= sum.resolution_error)) sum.resolution_error = operands[k].resolution_error;
    sum.is_unresolved = sum.is_unresolved || operands[k].is_unresolved;
  }
  sum.values.resize(operands[0].values.size());
  const std::size_t row = sum.size() / sum.rows();
  parallel_for(sum.channels * sum.rows(), [&](std::size_t i) {
    std::vector<double> of_row;
    for (const auto& of_table : weights) of_row.push_back(weight_of(of_table, i / sum.rows()));
    for (std::size_t at = i * row; at < (i + 1) * row; ++at) {
      double value = of_row[0] * operands[0].values[at];
      for (std::size_t k = 1; k < operands.size(); ++k) value += of_row[k] * operands[k].values[at];
      sum.values[at] = value;
    }
  });
  return sum;
}

BrdfTable scale(BrdfTable table, double factor) {
  if (!std::isfinite(factor)) throw ArgumentError("scale factor is no finite number");
  check(table);
  const auto multiply = [factor](auto& numbers) {
    for (double& number : numbers) number *= factor;
  };
  multiply(table.values);
  multiply(table.mirror);
  multiply(table.retro);
  for (auto* errors : {&table.error, &table.even_error, &table.odd_part}) {
    for (double& error : *errors) error *= std::abs(factor);
  }
  if (!table.source.empty()) {
    for (Term& term : table.source.front().terms) multiply(term.weight);
  }
  if (factor < 0) table.factors.clear();
  if (!table.factors.empty()) {
    multiply(table.factors.front().in);
    multiply(table.factors.front().out);
  }
  table.expression = "scale(" + table.expression + ", " + shortest(factor) + ")";
  return table;
}

BrdfTable transpose(const BrdfTable& table) {
  check(table);
  BrdfTable result = table;
  const std::size_t rows = table.rows();
  const std::size_t block = table.size() / (rows * rows);
  const std::size_t rings = table.grid.rings().size();
  for (std::size_t c = 0; c < table.channels; ++c) {
    parallel_for(rows, [&](std::size_t i) {
      for (std::size_t j = 0; j < rows; ++j) {
        std::copy_n(table.channel(c).data() + (j * rows + i) * block, block,
                    result.channel(c).data() + (i * rows + j) * block);
      }
    });
    const auto swap_rings = [&](const std::vector<double>& from, std::vector<double>& to) {
      for (std::size_t at = 0; !from.empty() && at < rings * rings; ++at) {
        to[c * rings * rings + at] = from[(c * rings + at % rings) * rings + at / rings];
      }
    };
    swap_rings(table.error, result.error);
    swap_rings(table.even_error, result.even_error);
    swap_rings(table.odd_part, result.odd_part);
    // (diag(m) R)* = diag(m R) R
    for (std::size_t i = 0; !table.mirror.empty() && table.form == TableForm::general && i < rows; ++i) {
      result.mirror[c * rows + i] = table.mirror[c * rows + table.grid.opposite(i)];
    }
  }
  // (T_1 T_2)* = T_2* T_1*
  std::ranges::reverse(result.source);
  if (!std::ranges::all_of(result.source, is_reciprocal)) result.source.clear();
  std::ranges::reverse(result.factors);
  for (auto& factor : result.factors) std::swap(factor.in, factor.out);
  result.expression = "transpose(" + table.expression + ")";
  return result;
}

}  // namespace lobe
