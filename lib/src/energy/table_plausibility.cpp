#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "energy/plausibility.hpp"

namespace lobe {
namespace {

using std::numbers::pi;

double known(double error) {
  return std::isnan(error) ? 0 : error;
}

/// Differences across the diagonal of a channel.
class Antisymmetry {
 public:
  Antisymmetry(const BrdfTable& table, std::size_t channel)
      : table_(table),
        values_(table.channel(channel)),
        channel_(channel),
        half_(table.form == TableForm::isotropic ? table.grid.half_azimuths() : 1) {
    if (table.form == TableForm::general) nodes_ = table.grid.directions();
    for (std::size_t row = 0; row < table.rows(); ++row) weights_.push_back(table.grid.rings()[ring(row)].weight);
  }

  void judge(ChannelPlausibility& result) const {
    constexpr double kRounding = 1e-12;
    const std::size_t rows = table_.rows();
    double differences = 0;
    double squares = 0;
    for (std::size_t i = 0; i < rows; ++i) {
      for (std::size_t j = 0; j < rows; ++j) {
        const double bound = error(i, j) + error(j, i);
        for (std::size_t k = 0; k < half_; ++k) {
          const double f = values_[(i * rows + j) * half_ + k];
          const double g = values_[(j * rows + i) * half_ + k];
          const double weight = weights_[i] * weights_[j] * azimuth_weight(k);
          differences += weight * (f - g) * (f - g);
          squares += weight * f * f;
          const double difference = std::abs(f - g);
          if (difference > result.reciprocity.absolute) {
            result.reciprocity.absolute = difference;
            result.reciprocity.absolute_at = result.reciprocity.relative_at = place(i, j, k);
          }
          if (difference > bound + kRounding * std::max(std::abs(f), std::abs(g))) result.is_reciprocal = false;
        }
      }
    }
    result.reciprocity.relative = squares > 0 ? std::sqrt(differences / squares) : 0;
  }

 private:
  /// Azimuths between 0 and pi stand for both sides.
  [[nodiscard]] double azimuth_weight(std::size_t k) const { return half_ == 1 || k == 0 || k + 1 == half_ ? 1 : 2; }

  [[nodiscard]] std::size_t ring(std::size_t row) const { return nodes_.empty() ? row : table_.grid.ring_of(row); }

  [[nodiscard]] double error(std::size_t in, std::size_t out) const {
    const std::size_t rings = table_.grid.rings().size();
    return known(table_.error[(channel_ * rings + ring(in)) * rings + ring(out)]);
  }

  [[nodiscard]] Directions place(std::size_t in, std::size_t out, std::size_t k) const {
    const auto rings = table_.grid.rings();
    if (nodes_.empty()) {
      return {rings[in].theta, rings[out].theta,
              2 * pi * static_cast<double>(k) / static_cast<double>(table_.grid.n_phi())};
    }
    return {nodes_[in].theta, nodes_[out].theta, std::remainder(nodes_[out].phi - nodes_[in].phi, 2 * pi),
            nodes_[in].phi};
  }

  const BrdfTable& table_;
  std::span<const double> values_;
  std::size_t channel_;
  std::size_t half_;
  std::span<const Direction> nodes_;  // of general tables
  std::vector<double> weights_;
};

}  // namespace

Plausibility check_plausibility(const BrdfTable& table) {
  check(table);
  const TableAlbedo albedos = row_albedos(table);
  const bool is_general = table.form == TableForm::general;
  Plausibility result;
  result.pairs = table.size();
  result.incident = table.rows();
  result.channels.resize(table.channels);
  for (std::size_t c = 0; c < table.channels; ++c) {
    ChannelPlausibility& channel = result.channels[c];
    channel.least = least_value(table, c);
    channel.is_non_negative = channel.least.value.value >= -known(channel.least.value.error);
    Antisymmetry(table, c).judge(channel);
    const auto largest = std::ranges::max_element(albedos.in[c], {}, &Estimate::value);
    const auto row = static_cast<std::size_t>(largest - albedos.in[c].begin());
    channel.albedo.largest = *largest;
    channel.albedo.at = is_general ? table.grid.directions()[row] : Direction{table.grid.rings()[row].theta, 0};
    channel.conserves_energy = largest->value - known(largest->error) <= 1;
    channel.mean_albedo = albedos.mean[c];
  }
  return result;
}

}  // namespace lobe
