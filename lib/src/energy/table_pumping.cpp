#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "core/parallel.hpp"
#include "core/text.hpp"
#include "energy/repair.hpp"
#include "energy/repair_checks.hpp"
#include "energy/row_kernel.hpp"
#include "lobe/core/error.hpp"
#include "table/ring_bounds.hpp"

namespace lobe {
namespace {

using Albedos = RowKernel::Albedos;

/// The divisor of a channel, step by step, beside that by albedos which are larger by their error bounds.
class ChannelPumping {
 public:
  ChannelPumping(const BrdfTable& table, std::size_t channel, Correction correction)
      : table_(&table),
        channel_(channel),
        correction_(correction),
        full_(table, channel, RowKernel::Rule::full),
        embedded_(table, channel, RowKernel::Rule::embedded),
        other_(table, channel, RowKernel::Rule::other),
        divisor_(full_.rows() * full_.rows(), 1.0),
        larger_(divisor_),
        rings_(table.grid.rings().size()),
        uncertainty_(rings_ * rings_, 0.0) {
    for (std::size_t row = 0; row < full_.rows(); ++row) cosines_.push_back(row_cosine(table, row));
    measure();
  }

  [[nodiscard]] const Albedos& albedos() const { return albedos_; }

  void step() {
    // Relative bounds: where a rule overestimates an albedo it goes on to do so, and the next divisor makes up for it.
    Albedos disturbed = full_.albedos(larger_);
    for (const auto side : {&Albedos::in, &Albedos::out}) {
      for (std::size_t row = 0; row < full_.rows(); ++row) {
        const double albedo = (albedos_.*side)[row];
        if (albedo > 0) (disturbed.*side)[row] *= 1 + (bounds_.*side)[row] / albedo;
      }
    }
    divide(divisor_, albedos_);
    divide(larger_, disturbed);
    compare();
    measure();
  }

  /// Adds the channel's albedos and mirror radiances.
  void describe(PumpStep& step) const {
    const std::size_t rows = full_.rows();
    std::vector<Estimate> albedo;
    std::vector<Estimate> radiance;
    for (std::size_t row = 0; row < rows; ++row) {
      albedo.push_back({albedos_.in[row], bounds_.in[row]});
      const std::size_t to = full_.mirrored(row);
      const double value = mirror_value(row) * cosines_[row] / divisor_[row * rows + to];
      const double error = value_error(row, to) * cosines_[row] / divisor_[row * rows + to];
      radiance.push_back({value, error + std::abs(value) * uncertainty(row, to)});
    }
    step.albedo.push_back(std::move(albedo));
    step.mirror_radiance.push_back(std::move(radiance));
  }

  /// Divides the channel of a table that is as the one given was.
  void apply(BrdfTable& table) const {
    const std::size_t rows = full_.rows();
    multiply_rows(
        table, channel_, [&](std::size_t i, std::size_t j) { return 1 / divisor_[i * rows + j]; },
        [&](std::size_t i, std::size_t j) { return uncertainty(i, j); });
  }

 private:
  /// Albedos over the divisor, and bounds on their errors as albedo() has them.
  void measure() {
    albedos_ = full_.albedos(divisor_);
    const Albedos coarse = embedded_.albedos(divisor_);
    const Albedos other = other_.albedos(divisor_);
    bounds_ = full_.value_errors(divisor_);
    const auto add = [&](std::vector<double> Albedos::*side) {
      std::vector<double> changes(table_->grid.rings().size());
      for (std::size_t row = 0; row < full_.rows(); ++row) {
        double& change = changes[row_ring(*table_, row)];
        const double albedo = (albedos_.*side)[row];
        change =
            std::max(change, kEmbeddedSafety * std::hypot(albedo - (coarse.*side)[row], albedo - (other.*side)[row]));
      }
      const auto spread = spread_over_rings(changes);
      for (std::size_t row = 0; row < full_.rows(); ++row) (bounds_.*side)[row] += spread[row_ring(*table_, row)];
    };
    add(&Albedos::in);
    add(&Albedos::out);
    if (!std::ranges::all_of(albedos_.in, [](double albedo) { return std::isfinite(albedo); })) {
      throw NumericError("'" + table_->expression + "' cannot be pumped up: an albedo is no finite number");
    }
  }

  /// The next divisor, by albedos over the last one.
  void divide(std::vector<double>& divisor, const Albedos& albedos) const {
    const std::size_t rows = full_.rows();
    parallel_for(rows, [&](std::size_t i) {
      for (std::size_t j = 0; j < rows; ++j) {
        const double albedo = std::max(albedos.in[i], albedos.out[j]);
        const double cosine = std::max(cosines_[i], cosines_[j]);
        double& g = divisor[i * rows + j];
        switch (correction_) {
          case Correction::g1:
            // Where there is no light there is nothing to divide.
            if (!(albedo <= 0)) g *= albedo;
            break;
          case Correction::g2:
            g *= std::max(albedo, cosine);
            break;
          case Correction::controlled:
            g = std::max(g * albedo, cosine);
            break;
          case Correction::complement:  // refused by pump()
          case Correction::viewer:
            break;
        }
      }
    });
  }

  /// Takes up how far the two divisors have come apart. They may cross, so the largest of all steps counts.
  void compare() {
    const std::size_t rows = full_.rows();
    for (std::size_t i = 0; i < rows; ++i) {
      for (std::size_t j = 0; j < rows; ++j) {
        const double apart = std::abs(larger_[i * rows + j] / divisor_[i * rows + j] - 1);
        double& largest = uncertainty_[row_ring(*table_, i) * rings_ + row_ring(*table_, j)];
        largest = std::max(largest, std::isnan(apart) ? kUnknown : apart);
      }
    }
    spread_ = uncertainty_;
    std::vector<double> line(rings_);
    const auto spread_lines = [&](std::size_t between_lines, std::size_t step) {
      for (std::size_t l = 0; l < rings_; ++l) {
        for (std::size_t k = 0; k < rings_; ++k) line[k] = spread_[l * between_lines + k * step];
        const auto bounds = spread_over_rings(line);
        for (std::size_t k = 0; k < rings_; ++k) spread_[l * between_lines + k * step] = bounds[k];
      }
    };
    spread_lines(rings_, 1);
    spread_lines(1, rings_);
  }

  /// Error of the divisor, relative.
  [[nodiscard]] double uncertainty(std::size_t i, std::size_t j) const {
    if (spread_.empty()) return 0;
    const double bound = spread_[row_ring(*table_, i) * rings_ + row_ring(*table_, j)];
    return bound == kUnknown ? std::numeric_limits<double>::quiet_NaN() : bound;
  }

  [[nodiscard]] double mirror_value(std::size_t row) const {
    if (table_->form == TableForm::general) return full_.sum(row, full_.mirrored(row));
    const std::size_t half = table_->grid.half_azimuths();
    return table_->channel(channel_)[(row * full_.rows() + row + 1) * half - 1];
  }

  [[nodiscard]] double value_error(std::size_t i, std::size_t j) const {
    return table_->error[(channel_ * rings_ + row_ring(*table_, i)) * rings_ + row_ring(*table_, j)];
  }

  static constexpr double kUnknown = std::numeric_limits<double>::infinity();

  const BrdfTable* table_;
  std::size_t channel_;
  Correction correction_;
  RowKernel full_;
  RowKernel embedded_;
  RowKernel other_;
  std::vector<double> cosines_;
  std::vector<double> divisor_;
  std::vector<double> larger_;
  std::size_t rings_;
  std::vector<double> uncertainty_;  ///< how far the divisors were apart, by rings
  std::vector<double> spread_;       ///< the same, spread over neighbouring rings
  Albedos albedos_;
  Albedos bounds_;
};

}  // namespace

PumpedTable pump(const BrdfTable& table, Correction correction, const PumpOptions& options) {
  check(table);
  require_valid(options);
  for (std::size_t c = 0; c < table.channels; ++c) require_non_negative(table, c, "pumped up");
  std::vector<ChannelPumping> channels;
  for (std::size_t c = 0; c < table.channels; ++c) channels.emplace_back(table, c, correction);
  PumpedTable result{table, {}, 0, false};
  const auto describe = [&] {
    PumpStep& step = result.steps.emplace_back();
    for (const auto& channel : channels) channel.describe(step);
  };
  describe();
  const int limit = options.times.value_or(options.limit);
  for (int k = 0; k < limit && (options.times || !result.is_converged); ++k) {
    if (options.progress && !options.progress("pumping up", static_cast<double>(k) / limit)) {
      throw Cancelled("cancelled");
    }
    result.change = 0;
    for (auto& channel : channels) {
      const std::vector<double> before = channel.albedos().in;
      channel.step();
      for (std::size_t row = 0; row < before.size(); ++row) {
        result.change = std::max(result.change, std::abs(channel.albedos().in[row] - before[row]));
      }
    }
    result.is_converged = result.change <= options.tolerance;
    describe();
  }
  for (const auto& channel : channels) channel.apply(result.table);
  // The result has no formula and is no longer a composition.
  result.table.source.clear();
  result.table.factors.clear();
  result.table.expression = "pump(" + table.expression + ", " + std::string(to_string(correction)) + ", " +
                            std::to_string(result.steps.size() - 1) + ")";
  return result;
}

}  // namespace lobe
