#include "energy/repair.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "core/text.hpp"
#include "energy/repair_checks.hpp"
#include "energy/row_kernel.hpp"
#include "lobe/algebra/algebra.hpp"
#include "lobe/core/error.hpp"
#include "lobe/table/least_value.hpp"

namespace lobe {

void require_valid(const PumpOptions& options) {
  if (options.times && *options.times < 1) {
    throw ArgumentError("pumping-up " + std::to_string(*options.times) + " times; expected 1 or more");
  }
  if (!(options.tolerance > 0)) {
    throw ArgumentError("tolerance of pumping-up of " + shortest(options.tolerance) + "; expected more than 0");
  }
  if (options.limit < 1) {
    throw ArgumentError("at most " + std::to_string(options.limit) + " steps of pumping-up; expected 1 or more");
  }
}

void require_non_negative(const BrdfTable& table, std::size_t channel, std::string_view what) {
  const PlacedValue least = least_value(table, channel);
  const double error = std::isnan(least.value.error) ? 0 : least.value.error;
  if (least.value.value >= -error) return;
  const auto degrees = [](double radians) { return shortest(std::round(radians * 1800 / std::numbers::pi) / 10); };
  throw NumericError("'" + table.expression + "' cannot be " + std::string(what) + ": its value is " +
                     shortest(least.value.value) + " sr^-1 at theta_in = " + degrees(least.at.theta_in) +
                     ", theta_out = " + degrees(least.at.theta_out) + ", delta_phi = " + degrees(least.at.delta_phi) +
                     " degrees; expected values of 0 and above");
}

BrdfTable normalise(const BrdfTable& table) {
  const TableAlbedo albedos = row_albedos(table);
  Estimate top;
  for (const auto& channel : albedos.in) {
    const Estimate& most = std::ranges::max(channel, {}, &Estimate::value);
    if (most.value > top.value) top = most;
  }
  const double largest = top.value;
  if (!(largest > 0) || !std::isfinite(largest)) {
    throw NumericError("'" + table.expression + "' cannot be normalised: its largest albedo is " + shortest(largest) +
                       "; expected a number above 0");
  }
  if (largest == 1) return table;
  BrdfTable result = scale(table, 1 / largest);
  const auto same = [](std::size_t, std::size_t) { return 1.0; };
  const auto uncertainty = [&](std::size_t, std::size_t) { return top.error / largest; };
  for (std::size_t c = 0; c < result.channels; ++c) multiply_rows(result, c, same, uncertainty);
  result.expression = "normalise(" + table.expression + ")";
  return result;
}

BrdfTable symmetrise(const BrdfTable& table) {
  std::array<BrdfTable, 2> both{table, transpose(table)};
  if (both[0].values == both[1].values && both[0].mirror == both[1].mirror) return std::move(both[0]);
  BrdfTable result = mix(std::array{0.5, 0.5}, both);
  result.expression = "symmetrise(" + table.expression + ")";
  return result;
}

}  // namespace lobe
