#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

#include "lobe/algebra/algebra.hpp"

namespace lobe {
namespace {

constexpr double kRowRounding = 1e-12;  // of sums over a row, relative to albedos of the order of 1

std::span<const double> of_channel(const BrdfTable& table, const std::vector<double>& by_row, std::size_t channel) {
  return std::span(by_row).subspan(channel * table.rows(), table.rows());
}

/// The mean of a function of the rows, (1.20).
double mean(const BrdfTable& table, std::span<const double> by_row) {
  double sum = 0;
  for (std::size_t row = 0; row < by_row.size(); ++row) {
    const Ring& ring = table.grid.rings()[table.form == TableForm::isotropic ? row : table.grid.ring_of(row)];
    sum += by_row[row] * ring.weight * (table.form == TableForm::isotropic ? static_cast<double>(ring.count) : 1);
  }
  return sum / std::numbers::pi;
}

/// How far a value lies outside of an interval; below 0 inside.
double outside(double value, double low, double high) {
  return std::max(low - value, value - high);
}

/// factor(row) min(others) <= albedo(row) <= factor(row) max(others).
BoundCheck check_rows(std::string_view name, const BrdfTable& table, const std::vector<Estimate>& albedo,
                      std::span<const double> factor, std::span<const double> others) {
  const auto [smallest, largest] = std::ranges::minmax(others);
  BoundCheck worst{.name = name, .excess = -std::numeric_limits<double>::infinity()};
  for (std::size_t row = 0; row < albedo.size(); ++row) {
    const double excess = outside(albedo[row].value, factor[row] * smallest, factor[row] * largest);
    const double error = albedo[row].error + kRowRounding;
    if (std::isnan(error) ? excess <= worst.excess : excess - error <= worst.excess - worst.error) continue;
    worst.excess = excess;
    worst.error = error;
    worst.theta = table.grid.rings()[table.form == TableForm::isotropic ? row : table.grid.ring_of(row)].theta;
  }
  return worst;
}

BoundCheck check_mean(const BrdfTable& table, const Estimate& albedo, std::span<const double> first_out,
                      std::span<const double> second_in) {
  const auto [first_min, first_max] = std::ranges::minmax(first_out);
  const auto [second_min, second_max] = std::ranges::minmax(second_in);
  const double first = mean(table, first_out);
  const double second = mean(table, second_in);
  return {.name = "mean albedo (1.25)",
          .excess = outside(albedo.value, std::max(first * second_min, second * first_min),
                            std::min(first * second_max, second * first_max)),
          .error = albedo.error + kRowRounding,
          .theta = std::numeric_limits<double>::quiet_NaN()};
}

}  // namespace

std::vector<BoundCheck> check_bounds(const BrdfTable& table, const TableAlbedo& albedos) {
  std::vector<BoundCheck> checks;
  if (table.factors.size() != 2) return checks;
  for (std::size_t c = 0; c < table.channels; ++c) {
    const auto first_in = of_channel(table, table.factors[0].in, c);
    const auto first_out = of_channel(table, table.factors[0].out, c);
    const auto second_in = of_channel(table, table.factors[1].in, c);
    const auto second_out = of_channel(table, table.factors[1].out, c);
    checks.push_back(check_rows("albedo in (1.23)", table, albedos.in[c], first_in, second_in));
    checks.push_back(check_rows("albedo out (1.23)", table, albedos.out[c], second_out, first_out));
    checks.push_back(check_mean(table, albedos.mean[c], first_out, second_in));
    for (auto check = checks.end() - 3; check != checks.end(); ++check) check->channel = c;
  }
  return checks;
}

}  // namespace lobe
