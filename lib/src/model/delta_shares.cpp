#include "model/delta_shares.hpp"

#include <algorithm>
#include <numbers>

#include "device/evaluate_lobes.hpp"
#include "hemisphere/albedo_curve.hpp"
#include "hemisphere/geometry.hpp"

namespace lobe {
namespace {

constexpr std::size_t kLongest = 1024;  // elevations at once

}  // namespace

DeltaShares::DeltaShares(const Device& device, std::span<const DeltaLobe> deltas)
    : deltas_(deltas.begin(), deltas.end()) {
  for (std::size_t k = 0; k < deltas_.size(); ++k) {
    const Term& term = deltas_[k].term;
    if (term.factors.empty() && !term.pumping) continue;
    const Material material{term.model, {}, {without_delta(deltas_[k])}};
    const LobeSet lobes = make_lobe_set({&material, 1});
    varying_.push_back({k, LobeEvaluator(device, lobes.batches, Precision::double_precision, kLongest)});
  }
}

Eigen::MatrixXd DeltaShares::at(std::span<const double> elevations) {
  const auto count = static_cast<Eigen::Index>(elevations.size());
  Eigen::MatrixXd shares = Eigen::MatrixXd::Ones(static_cast<Eigen::Index>(deltas_.size()), count);
  for (auto& [delta, evaluator] : varying_) {
    const double psi = deltas_[delta].kind == DeltaKind::mirror ? 0 : std::numbers::pi;
    NodeBlock block(evaluator.node_stride());
    for (std::size_t first = 0; first < elevations.size(); first += kLongest) {
      const auto part = elevations.subspan(first, std::min(kLongest, elevations.size() - first));
      block.clear();
      for (const double e : part) block.push(node_of_elevations(e, e, psi, std::numbers::pi));
      shares.block(static_cast<Eigen::Index>(delta), static_cast<Eigen::Index>(first), 1,
                   static_cast<Eigen::Index>(part.size())) = values_at(evaluator, block);
    }
  }
  for (std::size_t k = 0; k < deltas_.size(); ++k) {
    const auto& curve = deltas_[k].term.complement_of;
    if (curve.empty()) continue;
    for (Eigen::Index i = 0; i < count; ++i) {
      // An albedo of 1 may be above it by its error.
      const double left = 1 - curve_value(curve, std::sin(elevations[static_cast<std::size_t>(i)]));
      shares(static_cast<Eigen::Index>(k), i) *= std::max(left, 0.0);
    }
  }
  return shares;
}

DeltaParts delta_parts(const Device& device, const Material& deltas, std::size_t channels,
                       std::span<const double> elevations) {
  const auto rows = static_cast<Eigen::Index>(channels);
  const auto columns = static_cast<Eigen::Index>(elevations.size());
  DeltaParts parts{Eigen::MatrixXd::Zero(rows, columns), Eigen::MatrixXd::Zero(rows, columns)};
  if (deltas.terms.empty()) return parts;
  const LobeSet lobes = make_lobe_set({&deltas, 1}, {.with_deltas = true});
  const Eigen::MatrixXd shares = DeltaShares(device, lobes.deltas).at(elevations);
  for (std::size_t c = 0; c < channels; ++c) {
    const auto& mix = lobes.mix[lobes.channels() == 1 ? 0 : c];
    for (std::size_t k = 0; k < lobes.deltas.size(); ++k) {
      auto& part = lobes.deltas[k].kind == DeltaKind::mirror ? parts.mirror : parts.retro;
      const double weight = mix.coeff(0, static_cast<Eigen::Index>(lobes.smooth_lobes() + k));
      part.row(static_cast<Eigen::Index>(c)) += weight * shares.row(static_cast<Eigen::Index>(k));
    }
  }
  return parts;
}

}  // namespace lobe
