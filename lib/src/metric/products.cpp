#include "metric/products.hpp"

#include <cmath>
#include <string>

#include "hemisphere/refinement.hpp"
#include "lobe/core/error.hpp"

namespace lobe {
namespace {

using Mix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// Symmetric to the last bit, which the sums over the terms of mixtures in either order are not.
Eigen::MatrixXd mix_products(const Mix& mix, const Eigen::MatrixXd& products) {
  const Eigen::MatrixXd half = mix * products;
  const Eigen::MatrixXd mixed = mix * half.transpose();
  return mixed.selfadjointView<Eigen::Lower>();
}

/// |f_i - f_j|^2 from products.
Eigen::MatrixXd squared_distances(const Eigen::MatrixXd& gram) {
  const Eigen::VectorXd squares = gram.diagonal();
  Eigen::MatrixXd result = -2 * gram;
  result.colwise() += squares;
  result.rowwise() += squares.transpose();
  return result;
}

/// |a_i - a_j|^2 of the rows of a matrix, without the cancellation of products.
Eigen::MatrixXd squared_row_distances(const Eigen::MatrixXd& rows) {
  const Eigen::Index n = rows.rows();
  const Eigen::MatrixXd columns = rows.transpose();
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = i + 1; j < n; ++j) {
      result(i, j) = result(j, i) = (columns.col(i) - columns.col(j)).squaredNorm();
    }
  }
  return result;
}

/// Sums of |a_i - a_j| over the columns.
Eigen::ArrayXXd row_differences(const Eigen::MatrixXd& rows) {
  const Eigen::Index n = rows.rows();
  const Eigen::MatrixXd columns = rows.transpose();
  Eigen::ArrayXXd result = Eigen::ArrayXXd::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = i + 1; j < n; ++j) {
      result(i, j) = result(j, i) = (columns.col(i) - columns.col(j)).lpNorm<1>();
    }
  }
  return result;
}

/// F F^T; the two triangles of a general product may differ in the last bit.
Eigen::MatrixXd row_products(const Eigen::MatrixXd& rows) {
  Eigen::MatrixXd products = Eigen::MatrixXd::Zero(rows.rows(), rows.rows());
  products.selfadjointView<Eigen::Lower>().rankUpdate(rows);
  return products.selfadjointView<Eigen::Lower>();
}

/// Products of the materials and their squared distances at one level.
struct LevelProducts {
  Eigen::MatrixXd gram, squared_distance;
};

// Differences of materials converge less evenly than products: without it 242 of 58996 daylight distances of the
// published fits were off by up to 1.84 estimates at tolerance 1e-7.
constexpr double kDistanceSafety = 2;

void add_change(ChannelProducts& total, const std::vector<LevelProducts>& levels, double safety) {
  const std::size_t last = levels.size() - 1;
  Eigen::ArrayXXd gram_error = (levels[last].gram - levels[last - 1].gram).array().abs();
  Eigen::ArrayXXd squared_error = (levels[last].squared_distance - levels[last - 1].squared_distance).array().abs();
  if (last >= 2) {
    gram_error = gram_error.max(kEarlierShare * (levels[last - 1].gram - levels[last - 2].gram).array().abs());
    squared_error = squared_error.max(
        kEarlierShare * (levels[last - 1].squared_distance - levels[last - 2].squared_distance).array().abs());
  }
  total.gram_error.array() += safety * gram_error;
  total.squared_distance_error.array() += kDistanceSafety * safety * squared_error;
}

void add(ChannelProducts& total, const std::vector<LevelProducts>& levels, double safety) {
  total.gram += levels.back().gram;
  total.squared_distance += levels.back().squared_distance;
  add_change(total, levels, safety);
}

LevelProducts combine_products(const Mix& mix, const Eigen::MatrixXd& products) {
  LevelProducts result{mix_products(mix, products), {}};
  result.squared_distance = squared_distances(result.gram);
  return result;
}

}  // namespace

template <typename Combine, typename Add>
void ProductSums::add_levels(const std::vector<Eigen::MatrixXd>& levels, const Combine& combine, const Add& add) {
  std::vector<LevelProducts> sums(levels.size());
  for (std::size_t c = 0; c < lobes_.channels(); ++c) {
    std::vector<LevelProducts> products;
    for (std::size_t level = 0; level < levels.size(); ++level) {
      products.push_back(combine(lobes_.mix[c], levels[level]));
      const Eigen::MatrixXd gram = weights_[c] * products.back().gram;
      const Eigen::MatrixXd squared = weights_[c] * products.back().squared_distance;
      if (c == 0) {
        sums[level] = {gram, squared};
      } else {
        sums[level].gram += gram;
        sums[level].squared_distance += squared;
      }
    }
    add(totals_[c], products);
  }
  add(totals_.back(), sums);
}

ProductSums::ProductSums(const LobeSet& lobes, std::vector<double> channel_weights, const SlabStore* slabs)
    : lobes_(lobes), weights_(std::move(channel_weights)), slabs_(slabs) {
  const Eigen::Index n = lobes.mix.front().rows();
  const Eigen::MatrixXd zero = Eigen::MatrixXd::Zero(n, n);
  totals_.assign(lobes.channels() + 1, {zero, zero, zero, zero});
}

void ProductSums::add_lobe_products(const std::vector<Eigen::MatrixXd>& levels, double safety) {
  add_levels(levels, combine_products,
             [&](ChannelProducts& total, const std::vector<LevelProducts>& products) { add(total, products, safety); });
}

void ProductSums::add_lobe_change(const Eigen::MatrixXd& coarse, const Eigen::MatrixXd& fine, double safety) {
  add_levels({coarse, fine}, combine_products, [&](ChannelProducts& total, const std::vector<LevelProducts>& products) {
    add_change(total, products, safety);
  });
}

void ProductSums::add_lobe_factors(const std::vector<Eigen::MatrixXd>& levels, double safety) {
  const auto combine = [](const Mix& mix, const Eigen::MatrixXd& factors) {
    const Eigen::MatrixXd rows = mix * factors;
    return LevelProducts{row_products(rows), squared_row_distances(rows)};
  };
  add_levels(levels, combine,
             [&](ChannelProducts& total, const std::vector<LevelProducts>& products) { add(total, products, safety); });
}

void ProductSums::add_lobe_integrals(const std::vector<Eigen::MatrixXd>& levels, double safety) {
  const auto combine = [](const Mix& mix, const Eigen::MatrixXd& factors) {
    const Eigen::MatrixXd rows = (mix * factors).rowwise().sum();
    return LevelProducts{row_products(rows), squared_row_distances(rows)};
  };
  add_levels(levels, combine,
             [&](ChannelProducts& total, const std::vector<LevelProducts>& products) { add(total, products, safety); });
  ChannelProducts& combined = totals_.back();
  Eigen::ArrayXXd bound_of_combined = Eigen::ArrayXXd::Zero(combined.gram.rows(), combined.gram.cols());
  for (std::size_t c = 0; c < lobes_.channels(); ++c) {
    std::vector<Eigen::MatrixXd> rows;
    for (const auto& level : levels) rows.emplace_back(lobes_.mix[c] * level);
    const std::size_t last = rows.size() - 1;
    Eigen::ArrayXXd change = row_differences(rows[last] - rows[last - 1]);
    if (last >= 2) change = change.max(kEarlierShare * row_differences(rows[last - 1] - rows[last - 2]));
    const Eigen::ArrayXXd distance = squared_row_distances(rows[last].rowwise().sum()).cwiseSqrt().array();
    const Eigen::ArrayXXd bound = kDistanceSafety * safety * change * (2 * distance + change);
    auto& error = totals_[c].squared_distance_error;
    error = error.array().max(bound);
    bound_of_combined += std::abs(weights_[c]) * bound;
  }
  combined.squared_distance_error = combined.squared_distance_error.array().max(bound_of_combined);
}

void add_common_share(double difference, ChannelProducts& total) {
  total.gram_error += kCommonShare * difference * total.gram.cwiseAbs();
  total.squared_distance_error += kDistanceSafety * kCommonShare * difference * total.squared_distance.cwiseAbs();
}

double level_safety(const LobeSet& lobes) {
  // Norms of power patches with n from 0.03 to 2.5 under daylight and mean-albedo were off by up to 1.95 estimates.
  constexpr double kFractionalEdge = 3;
  constexpr double kHiddenJumps = 3;
  return lobes.has_hidden_jumps() ? kHiddenJumps : lobes.has_fractional_edge ? kFractionalEdge : 1;
}

int most_levels(const LobeSet& lobes) {
  constexpr int kWithHiddenJumps = 4;
  return lobes.has_hidden_jumps() ? kWithHiddenJumps : kLevels;
}

void add_hidden_jumps(const LobeSet& lobes, ChannelProducts& total) {
  constexpr double kShare = 1e-3;
  const auto is_hiding = [&](Eigen::Index i) { return lobes.hides_jumps[static_cast<std::size_t>(i)]; };
  for (Eigen::Index j = 0; j < total.gram.cols(); ++j) {
    for (Eigen::Index i = 0; i < total.gram.rows(); ++i) {
      if (!is_hiding(i) && !is_hiding(j)) continue;
      total.gram_error(i, j) += kShare * std::sqrt(std::abs(total.gram(i, i) * total.gram(j, j)));
      total.squared_distance_error(i, j) += kShare * std::abs(total.squared_distance(i, j));
    }
  }
}

std::vector<ClosePair> find_close_pairs(ProductSums& sums, double share) {
  std::vector<ClosePair> pairs;
  const auto& totals = sums.totals();
  for (std::size_t c = 0; c + 1 < totals.size(); ++c) {
    const auto& total = totals[c];
    for (Eigen::Index j = 0; j < total.gram.cols(); ++j) {
      for (Eigen::Index i = 0; i < j; ++i) {
        if (total.squared_distance(i, j) <= share * (total.gram(i, i) + total.gram(j, j))) pairs.push_back({c, i, j});
      }
    }
  }
  return pairs;
}

Eigen::SparseMatrix<double, Eigen::RowMajor> differences(const LobeSet& lobes, std::span<const ClosePair> pairs) {
  std::vector<Eigen::Triplet<double>> terms;
  for (std::size_t e = 0; e < pairs.size(); ++e) {
    const auto& mix = lobes.mix[pairs[e].channel];
    const Eigen::SparseVector<double> row = (mix.row(pairs[e].i) - mix.row(pairs[e].j)).transpose();
    for (Eigen::SparseVector<double>::InnerIterator term(row); term; ++term) {
      if (term.value() != 0) terms.emplace_back(static_cast<int>(e), static_cast<int>(term.index()), term.value());
    }
  }
  Eigen::SparseMatrix<double, Eigen::RowMajor> result(static_cast<Eigen::Index>(pairs.size()),
                                                      static_cast<Eigen::Index>(lobes.lobes()));
  result.setFromTriplets(terms.begin(), terms.end());
  return result;
}

void replace_distances(ProductSums& sums, std::span<const ClosePair> pairs,
                       const Eigen::SparseMatrix<double, Eigen::RowMajor>& differences, const Eigen::VectorXd& squared,
                       const Eigen::VectorXd& squared_error, double rounding) {
  auto& totals = sums.totals();
  for (std::size_t e = 0; e < pairs.size(); ++e) {
    const auto [c, i, j] = pairs[e];
    const auto row = static_cast<Eigen::Index>(e);
    auto& total = totals[c];
    // Each sample is known to its rounding only: |d^2| moves by 2 d (e_i + e_j).
    const double samples = rounding * (std::sqrt(total.gram(i, i)) + std::sqrt(total.gram(j, j)));
    const bool is_identical = differences.row(row).nonZeros() == 0;
    const double value = std::max(squared(row), 0.0);
    total.squared_distance(i, j) = total.squared_distance(j, i) = value;
    total.squared_distance_error(i, j) = total.squared_distance_error(j, i) =
        is_identical ? 0 : squared_error(row) + samples * (2 * std::sqrt(value) + samples);
  }
  auto& combined = totals.back();
  for (const auto& [channel, i, j] : pairs) {
    double sum = 0;
    double error = 0;
    for (std::size_t c = 0; c + 1 < totals.size(); ++c) {
      sum += sums.channel_weights()[c] * totals[c].squared_distance(i, j);
      error += std::abs(sums.channel_weights()[c]) * totals[c].squared_distance_error(i, j);
    }
    combined.squared_distance(i, j) = combined.squared_distance(j, i) = sum;
    combined.squared_distance_error(i, j) = combined.squared_distance_error(j, i) = error;
  }
}

Eigen::ArrayXXd relative_differences(const Eigen::MatrixXd& fine, const Eigen::MatrixXd& coarse,
                                     const Eigen::MatrixXd& reference) {
  // Products of all but disjoint lobes are measured against the norms, where their own size means nothing.
  constexpr double kDisjoint = 1e-6;
  const Eigen::ArrayXd norms = reference.diagonal().array().max(0).sqrt();
  Eigen::ArrayXXd differences = (fine - coarse).array().abs();
  for (Eigen::Index j = 0; j < fine.cols(); ++j) {
    const Eigen::ArrayXd scale = reference.col(j).array().abs().max(kDisjoint * norms(j) * norms);
    differences.col(j) = (scale > 0).select(differences.col(j) / scale, 0.0);
  }
  return differences;
}

double relative_difference(const Eigen::MatrixXd& fine, const Eigen::MatrixXd& coarse,
                           const Eigen::MatrixXd& reference) {
  return relative_differences(fine, coarse, reference).maxCoeff();
}

void require_finite(const Eigen::MatrixXd& products, const LobeSet& lobes, const Lighting& lighting) {
  if (products.allFinite()) return;
  for (Eigen::Index j = 0; j < products.cols(); ++j) {
    for (Eigen::Index i = 0; i < products.rows(); ++i) {
      if (std::isfinite(products(i, j))) continue;
      throw NumericError("the product of " + lobes.names[static_cast<std::size_t>(i)] + " and " +
                         lobes.names[static_cast<std::size_t>(j)] + " under lighting '" + lighting.name() +
                         "' is no finite number");
    }
  }
}

void report_progress(const MetricOptions& options, const Lighting& lighting, double fraction) {
  if (options.progress && !options.progress(lighting.name(), fraction)) throw Cancelled("cancelled");
}

}  // namespace lobe
