#include "lobe/compare/rank_correlation.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <numeric>
#include <string>
#include <string_view>

#include "core/parallel.hpp"
#include "lobe/core/error.hpp"

namespace lobe {
namespace {

void check_series(std::span<const double> a, std::span<const double> b) {
  if (a.size() != b.size() || a.empty()) {
    throw ArgumentError("series of " + std::to_string(a.size()) + " and " + std::to_string(b.size()) +
                        " values to correlate; expected the same number, at least one");
  }
  const auto is_nan = [](double x) { return std::isnan(x); };
  if (std::ranges::any_of(a, is_nan) || std::ranges::any_of(b, is_nan))
    throw NumericError("a value to be ranked is no number");
}

std::vector<std::size_t> order_of(std::span<const double> values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return values[i] < values[j]; });
  return order;
}

/// Ranks from their mean; equal values share the mean of their ranks.
std::vector<double> centred_ranks(std::span<const double> values) {
  const auto order = order_of(values);
  const double middle = static_cast<double>(values.size() - 1) / 2;
  std::vector<double> ranks(values.size());
  for (std::size_t begin = 0; begin < order.size();) {
    std::size_t end = begin;
    while (end < order.size() && values[order[end]] == values[order[begin]]) ++end;
    const double rank = static_cast<double>(begin + end - 1) / 2 - middle;
    for (std::size_t k = begin; k < end; ++k) ranks[order[k]] = rank;
    begin = end;
  }
  return ranks;
}

/// Pairs within runs of equal elements of a sorted range.
template <typename Equal>
std::uint64_t tied_pairs(std::size_t count, const Equal& equal) {
  std::uint64_t pairs = 0;
  for (std::size_t begin = 0; begin < count;) {
    std::size_t end = begin + 1;
    while (end < count && equal(begin, end)) ++end;
    const std::uint64_t run = end - begin;
    pairs += run * (run - 1) / 2;
    begin = end;
  }
  return pairs;
}

/// Sorts and counts the pairs that stand in falling order.
std::uint64_t sort_and_count(std::vector<double>& values) {
  std::uint64_t inversions = 0;
  std::vector<double> merged(values.size());
  for (std::size_t width = 1; width < values.size(); width *= 2) {
    for (std::size_t low = 0; low < values.size(); low += 2 * width) {
      const std::size_t middle = std::min(low + width, values.size());
      const std::size_t high = std::min(low + 2 * width, values.size());
      std::size_t left = low;
      std::size_t right = middle;
      for (std::size_t k = low; k < high; ++k) {
        if (right < high && (left == middle || values[right] < values[left])) {
          inversions += middle - left;
          merged[k] = values[right++];
        } else {
          merged[k] = values[left++];
        }
      }
    }
    values.swap(merged);
  }
  return inversions;
}

std::vector<double> below_diagonal(const Eigen::MatrixXd& matrix) {
  std::vector<double> values;
  for (Eigen::Index j = 0; j < matrix.cols(); ++j) {
    for (Eigen::Index i = j + 1; i < matrix.rows(); ++i) values.push_back(matrix(i, j));
  }
  return values;
}

}  // namespace

double spearman(std::span<const double> a, std::span<const double> b) {
  check_series(a, b);
  const auto x = centred_ranks(a);
  const auto y = centred_ranks(b);
  const double squares =
      std::inner_product(x.begin(), x.end(), x.begin(), 0.0) * std::inner_product(y.begin(), y.end(), y.begin(), 0.0);
  if (squares == 0) return std::numeric_limits<double>::quiet_NaN();
  return std::inner_product(x.begin(), x.end(), y.begin(), 0.0) / std::sqrt(squares);
}

double kendall(std::span<const double> a, std::span<const double> b) {
  check_series(a, b);
  const std::size_t n = a.size();
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t i, std::size_t j) { return a[i] != a[j] ? a[i] < a[j] : b[i] < b[j]; });
  const auto ties_a = tied_pairs(n, [&](std::size_t i, std::size_t j) { return a[order[i]] == a[order[j]]; });
  const auto ties_both = tied_pairs(
      n, [&](std::size_t i, std::size_t j) { return a[order[i]] == a[order[j]] && b[order[i]] == b[order[j]]; });
  std::vector<double> values(n);
  for (std::size_t k = 0; k < n; ++k) values[k] = b[order[k]];
  const auto discordant = static_cast<double>(sort_and_count(values));
  const auto ties_b = tied_pairs(n, [&](std::size_t i, std::size_t j) { return values[i] == values[j]; });

  const double pairs = static_cast<double>(n) * static_cast<double>(n - 1) / 2;
  const double untied_a = pairs - static_cast<double>(ties_a);
  const double untied_b = pairs - static_cast<double>(ties_b);
  if (untied_a == 0 || untied_b == 0) return std::numeric_limits<double>::quiet_NaN();
  const double concordant = untied_a - static_cast<double>(ties_b) + static_cast<double>(ties_both) - discordant;
  // Roots round: 1 is not to be passed.
  return std::clamp((concordant - discordant) / std::sqrt(untied_a) / std::sqrt(untied_b), -1.0, 1.0);
}

RankAgreement rank_agreement(std::span<const Eigen::MatrixXd> distances) {
  if (distances.empty()) throw ArgumentError("no distance matrices to compare; expected at least one");
  std::vector<std::vector<double>> entries;
  for (const auto& matrix : distances) {
    if (matrix.rows() != matrix.cols() || matrix.rows() < 2 || matrix.rows() != distances.front().rows()) {
      throw ArgumentError("a distance matrix is " + std::to_string(matrix.rows()) + " x " +
                          std::to_string(matrix.cols()) + "; expected square ones of one size, at least 2 x 2");
    }
    entries.push_back(below_diagonal(matrix));
  }
  const auto n = static_cast<Eigen::Index>(distances.size());
  RankAgreement agreement{Eigen::MatrixXd(n, n), Eigen::MatrixXd(n, n)};
  parallel_for(distances.size(), [&](std::size_t first) {
    for (std::size_t second = 0; second <= first; ++second) {
      const auto i = static_cast<Eigen::Index>(first);
      const auto j = static_cast<Eigen::Index>(second);
      agreement.spearman(i, j) = agreement.spearman(j, i) = spearman(entries[first], entries[second]);
      agreement.kendall(i, j) = agreement.kendall(j, i) = kendall(entries[first], entries[second]);
    }
  });
  return agreement;
}

RankAgreement rank_agreement_within(std::span<const Eigen::MatrixXd> distances, std::span<const std::string> group) {
  if (distances.empty()) throw ArgumentError("no distance matrices to compare; expected at least one");
  if (std::ssize(group) != distances.front().rows()) {
    throw ArgumentError(std::to_string(group.size()) + " groups for " + std::to_string(distances.front().rows()) +
                        " materials; expected one per material");
  }
  std::map<std::string_view, std::vector<Eigen::Index>> members;
  for (std::size_t i = 0; i < group.size(); ++i) members[group[i]].push_back(static_cast<Eigen::Index>(i));

  const auto n = static_cast<Eigen::Index>(distances.size());
  RankAgreement sum{Eigen::MatrixXd::Zero(n, n), Eigen::MatrixXd::Zero(n, n)};
  Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(n, n);
  for (const auto& [name, list] : members) {
    if (list.size() < 3) continue;
    std::vector<Eigen::MatrixXd> parts;
    for (const auto& matrix : distances) parts.emplace_back(matrix(list, list));
    const RankAgreement part = rank_agreement(parts);
    const double pairs = static_cast<double>(list.size() * (list.size() - 1)) / 2;
    for (Eigen::Index j = 0; j < n; ++j) {
      for (Eigen::Index i = 0; i < n; ++i) {
        if (std::isnan(part.spearman(i, j))) continue;
        weights(i, j) += pairs;
        sum.spearman(i, j) += pairs * part.spearman(i, j);
        sum.kendall(i, j) += pairs * part.kendall(i, j);
      }
    }
  }
  return {sum.spearman.cwiseQuotient(weights), sum.kendall.cwiseQuotient(weights)};
}

}  // namespace lobe
