#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/text.hpp"
#include "energy/plausibility.hpp"
#include "energy/repair.hpp"
#include "energy/row_kernel.hpp"
#include "lobe/core/error.hpp"

namespace lobe {
namespace {

/// \return the largest |f(L, V) - f(V, L)| where that is more than its errors; else 0
double asymmetry_of(const BrdfTable& table) {
  const Plausibility found = check_plausibility(table);
  double asymmetry = 0;
  for (const auto& channel : found.channels) {
    if (!channel.is_non_negative) {
      throw NumericError("'" + table.expression + "' cannot be balanced: it has the value " +
                         shortest(channel.least.value.value) + " sr^-1; expected values of 0 and above");
    }
    if (!channel.is_reciprocal) asymmetry = std::max(asymmetry, channel.reciprocity.absolute);
  }
  return asymmetry;
}

/// The factors of one channel, or of several that share them.
class Scaling {
 public:
  Scaling(std::vector<RowKernel> kernels, const BalanceOptions& options)
      : kernels_(std::move(kernels)), options_(&options), factors_(kernels_.front().rows(), 1.0) {}

  [[nodiscard]] const std::vector<double>& factors() const { return factors_; }

  /// Moves every factor in turn to where its row is balanced.
  /// \return the largest departure that a row showed, before
  double sweep() {
    double worst = 0;
    for (std::size_t row = 0; row < factors_.size(); ++row) {
      double& s = factors_[row];
      double next = options_->to_white ? std::numeric_limits<double>::infinity() : 1;
      double albedo = 0;
      for (const RowKernel& kernel : kernels_) {
        const auto [own, others] = parts(kernel, row);
        albedo = std::max(albedo, s * (others + own * s));
        // The root of s (others + own s) = 1.
        next = std::min(next, 2 / (others + std::sqrt(others * others + 4 * own)));
      }
      worst = std::max(worst, s == 1 && !options_->to_white ? albedo - 1 : std::abs(albedo - 1));
      s = next;
    }
    return worst;
  }

  /// Whether the balance holds as things are.
  [[nodiscard]] bool is_balanced() const {
    for (std::size_t row = 0; row < factors_.size(); ++row) {
      double albedo = 0;
      for (const RowKernel& kernel : kernels_) {
        const auto [own, others] = parts(kernel, row);
        albedo = std::max(albedo, factors_[row] * (others + own * factors_[row]));
      }
      if (albedo > 1 + options_->tolerance) return false;
      if ((options_->to_white || factors_[row] < 1) && albedo < 1 - options_->tolerance) return false;
    }
    return true;
  }

 private:
  /// The albedo of a row over its factor s is others + own s.
  struct Parts {
    double own = 0;
    double others = 0;
  };
  [[nodiscard]] Parts parts(const RowKernel& kernel, std::size_t row) const {
    Parts result{kernel.weight(row) * kernel.sum(row, row) + kernel.retro(row), 0};
    for (std::size_t j = 0; j < factors_.size(); ++j) {
      if (j != row) result.others += kernel.weight(j) * kernel.sum(row, j) * factors_[j];
    }
    const std::size_t mirrored = kernel.mirrored(row);
    (mirrored == row ? result.own : result.others) += kernel.mirror(row) * (mirrored == row ? 1 : factors_[mirrored]);
    return result;
  }

  std::vector<RowKernel> kernels_;
  const BalanceOptions* options_;
  std::vector<double> factors_;
};

/// Counts sweeps in the result, and how far off the last one was.
void balance(Scaling& scaling, const BrdfTable& table, const BalanceOptions& options, BalancedTable& result) {
  if (scaling.is_balanced()) return;
  double departure = 0;
  for (std::size_t sweep = 1; sweep <= options.limit; ++sweep) {
    departure = scaling.sweep();
    if (!std::isfinite(departure) ||
        !std::ranges::all_of(scaling.factors(), [](double s) { return std::isfinite(s); })) {
      throw NumericError("'" + table.expression +
                         "' cannot be balanced: an albedo is 0 or no finite number; expected one above 0");
    }
    result.sweeps = std::max(result.sweeps, sweep);
    if (departure <= options.tolerance && scaling.is_balanced()) {
      result.departure = std::max(result.departure, departure);
      return;
    }
    const double share = static_cast<double>(sweep) / static_cast<double>(options.limit);
    if (options.progress && !options.progress("balancing", share)) throw Cancelled("cancelled");
  }
  result.departure = std::max(result.departure, departure);
  if (!options.missed) return;
  options.missed({.quantity = "an albedo of '" + table.expression + "', after " + std::to_string(options.limit) +
                              " sweeps of balancing,",
                  .relative_error = departure,
                  .tolerance = options.tolerance});
}

/// Multiplies a channel. To first order a factor below 1 is as uncertain as the albedo of its row; one of 1 may have to
/// be lower by what the albedo may be above 1.
void apply(BrdfTable& table, std::size_t channel, const std::vector<double>& s, const std::vector<Estimate>& albedos) {
  const auto uncertainty = [&](std::size_t row) {
    const auto& [value, error] = albedos[row];
    return s[row] == 1 ? std::max(0.0, value + error - 1) : error / std::abs(value);
  };
  multiply_rows(
      table, channel, [&](std::size_t i, std::size_t j) { return s[i] * s[j]; },
      [&](std::size_t i, std::size_t j) { return uncertainty(i) + uncertainty(j); });
}

}  // namespace

BalancedTable scale_symmetrically(const BrdfTable& given, const BalanceOptions& options) {
  constexpr double kLeastTolerance = 1e-14;  // rounding of sums
  if (!(options.tolerance >= kLeastTolerance && options.tolerance < 1)) {
    throw ArgumentError("tolerance of balancing of " + shortest(options.tolerance) + "; expected 1e-14 to below 1");
  }
  check(given);
  const double asymmetry = asymmetry_of(given);
  if (asymmetry > 0 && !options.reciprocal_part) {
    throw NumericError("'" + given.expression + "' cannot be balanced: f(L, V) and f(V, L) differ by " +
                           shortest(asymmetry) + " sr^-1; make it reciprocal by symmetrise() first",
                       {.fault = Fault::not_reciprocal});
  }
  const BrdfTable table = asymmetry > 0 ? symmetrise(given) : given;
  BalancedTable result{table, {}};
  result.asymmetry = asymmetry;
  std::vector<Scaling> scalings;
  std::vector<RowKernel> kernels;
  for (std::size_t c = 0; c < table.channels; ++c) {
    kernels.emplace_back(table, c, RowKernel::Rule::full);
    if (options.channels_together && c + 1 < table.channels) continue;
    scalings.emplace_back(std::exchange(kernels, {}), options);
  }
  for (auto& scaling : scalings) balance(scaling, table, options, result);
  for (std::size_t c = 0; c < table.channels; ++c)
    result.factors.push_back(scalings[scalings.size() == 1 ? 0 : c].factors());
  if (result.sweeps == 0) return result;

  const TableAlbedo albedos = row_albedos(table);
  for (std::size_t c = 0; c < table.channels; ++c) apply(result.table, c, result.factors[c], albedos.in[c]);
  result.table.source.clear();
  result.table.factors.clear();
  result.table.expression = "balance(" + table.expression + (options.to_white ? ", white)" : ")");
  return result;
}

}  // namespace lobe
