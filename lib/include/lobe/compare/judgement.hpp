#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace [[gnu::visibility("default")]] lobe {

/// A human judgement of how far an approximation looks from its material.
struct Judgement {
  std::string method;    ///< method of approximation, "WARD"
  std::string material;  ///< the approximated material, "alum-bronze"
  double distance = 0;   ///< judged distance; only ranks count
};

/// Reads judgements from a text table with the columns METHOD, BRDF and DISTANCE, in any order and case, among others.
/// Columns are separated by semicolons, commas or tabs, and fields may be quoted. The file PerceptualDistances.csv of
/// Lavoue, Bonneel, Farrugia and Soler 2021 is such a table.
/// \throws ArgumentError "line N: ..." for other texts, and for pairs that are judged twice
[[nodiscard]] std::vector<Judgement> parse_judgements(std::string_view text);

/// A number, and the interval that holds it with the requested probability.
struct Interval {
  double value = 0;  ///< value over all pairs
  double low = 0;    ///< lower end; NaN if no sample had a correlation
  double high = 0;   ///< upper end
};

/// Rank correlations between computed and judged distances.
struct JudgementCorrelation {
  Interval spearman;  ///< Spearman's rho
  Interval kendall;   ///< Kendall's tau-b
};

/// Options for the intervals of rank correlations: percentiles over samples drawn with replacement (bootstrap, Efron
/// and Tibshirani 1993, section 13.3).
struct BootstrapOptions {
  std::size_t samples = 1000;  ///< number of samples
  double coverage = 0.95;      ///< probability that the intervals hold
  std::uint64_t seed = 1;      ///< the same seed draws the same samples
};

/// Correlation of two series, with its intervals. Pairs in one group are drawn together, because judgements of one
/// material are not independent of each other.
/// \param group group of each pair; empty: each pair is drawn by itself
/// \throws ArgumentError for series of different lengths or fewer than 3 pairs, fewer than 20 samples, and a coverage
///   that is not above 0 and below 1; NumericError for values that are NaN
[[nodiscard]] JudgementCorrelation judgement_correlation(std::span<const double> computed,
                                                         std::span<const double> judged,
                                                         std::span<const std::string> group = {},
                                                         const BootstrapOptions& options = {});

}  // namespace lobe
