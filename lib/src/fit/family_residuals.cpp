#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "core/parallel.hpp"
#include "fit/scaled_problem.hpp"
#include "lobe/core/error.hpp"
#include "lobe/fit/approximation.hpp"

namespace lobe {
namespace {

using Eigen::Index;

struct BasisFamily {
  std::string name;
  std::vector<Index> members;
};

std::vector<BasisFamily> families_of(std::span<const MaterialLabel> materials) {
  std::vector<BasisFamily> families;
  for (std::size_t i = 0; i < materials.size(); ++i) {
    auto found = std::ranges::find(families, materials[i].family, &BasisFamily::name);
    if (found == families.end()) found = families.insert(found, BasisFamily{materials[i].family, {}});
    found->members.push_back(static_cast<Index>(i));
  }
  return families;
}

ApproximationProblem problem_of(const Metric& metric, const std::vector<Index>& basis, Index target) {
  ApproximationProblem problem;
  problem.gram = metric.gram(basis, basis);
  problem.gram_error = metric.gram_error(basis, basis);
  problem.products = metric.gram.col(target)(basis);
  problem.products_error = metric.gram_error.col(target)(basis);
  problem.target_square = {metric.gram(target, target), metric.gram_error(target, target)};
  return problem;
}

struct Cell {
  double square = 0;  ///< sum over channels of |f - nearest|^2
  double square_error = 0;
  double target = 0;  ///< of |f|^2
  Index rank = 0;
};

void add(Cell& cell, const Metric& metric, double weight, const std::vector<Index>& basis, const ScaledBasis& scaled,
         Index target, const ApproximationForm& form) {
  const double target_square = metric.gram(target, target);
  if (!(target_square > 0)) return;
  const LinearFit result = fit(scaled, problem_of(metric, basis, target), form);
  const auto [value, error] = result.residual;
  cell.square += weight * value * value;
  cell.square_error += weight * (2 * value + error) * error;
  cell.target += weight * target_square;
  cell.rank = std::max(cell.rank, result.rank);
}

}  // namespace

FamilyResiduals family_residuals(const MetricResult& result, std::span<const MaterialLabel> materials,
                                 bool non_negative, std::span<const double> channel_weights) {
  const auto n = static_cast<Index>(materials.size());
  if (result.combined.gram.rows() != n) {
    throw ArgumentError("scalar products of " + std::to_string(result.combined.gram.rows()) + " materials for " +
                        std::to_string(n) + "; expected those of the same materials");
  }
  std::vector<const Metric*> channels;
  for (const Metric& metric : result.channels) channels.push_back(&metric);
  if (channels.empty()) channels.push_back(&result.combined);
  std::vector<double> weights(channel_weights.begin(), channel_weights.end());
  if (weights.empty() || channels.size() == 1) {
    weights.assign(channels.size(), 1.0 / static_cast<double>(channels.size()));
  }
  if (weights.size() != channels.size()) {
    throw ArgumentError(std::to_string(weights.size()) + " channel weights for " + std::to_string(channels.size()) +
                        " channels; expected one per channel");
  }

  const ApproximationForm form{.non_negative = non_negative, .energy = false, .allow_dependent = true};
  const auto families = families_of(materials);
  const auto m = static_cast<Index>(families.size());
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  FamilyResiduals table;
  table.lighting = result.lighting;
  table.non_negative = non_negative;
  table.relative_residual = table.relative_residual_error = Eigen::MatrixXd::Constant(n, m, kNone);
  table.rank = Eigen::MatrixXi::Zero(n, m);
  for (const auto& material : materials) table.targets.push_back(material.name);

  for (Index f = 0; f < m; ++f) {
    const BasisFamily& family = families[static_cast<std::size_t>(f)];
    table.families.push_back(family.name);
    std::vector<std::unique_ptr<ScaledBasis>> whole;
    for (const Metric* metric : channels) {
      whole.push_back(std::make_unique<ScaledBasis>(metric->gram(family.members, family.members),
                                                    metric->gram_error(family.members, family.members)));
    }
    parallel_for(materials.size(), [&](std::size_t t) {
      const auto target = static_cast<Index>(t);
      std::vector<Index> basis = family.members;
      const bool is_member = std::erase(basis, target) > 0;
      if (basis.empty()) return;
      Cell cell;
      for (std::size_t c = 0; c < channels.size(); ++c) {
        if (is_member) {
          const ScaledBasis rest(channels[c]->gram(basis, basis), channels[c]->gram_error(basis, basis));
          add(cell, *channels[c], weights[c], basis, rest, target, form);
        } else {
          add(cell, *channels[c], weights[c], basis, *whole[c], target, form);
        }
      }
      if (!(cell.target > 0)) return;
      const double relative = std::sqrt(cell.square / cell.target);
      const double above = std::sqrt((cell.square + cell.square_error) / cell.target) - relative;
      const double below = relative - std::sqrt(std::max(0.0, cell.square - cell.square_error) / cell.target);
      table.relative_residual(target, f) = relative;
      table.relative_residual_error(target, f) = std::max(above, below);
      table.rank(target, f) = static_cast<int>(cell.rank);
    });
  }
  return table;
}

}  // namespace lobe
