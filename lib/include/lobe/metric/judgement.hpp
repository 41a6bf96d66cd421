#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lobe {

/// How far from a material an approximation of it looks to people.
struct Judgement {
  std::string method;    ///< of approximation, "WARD"
  std::string material;  ///< what was approximated, "alum-bronze"
  double distance = 0;   ///< as judged; only ranks count
};

/// Reads judgements from a table of text with the columns METHOD, BRDF and DISTANCE, in any order and case and beside
/// others, separated by semicolons, commas or tabs; fields may stand in quotes. That is the file
/// PerceptualDistances.csv of Lavoue, Bonneel, Farrugia and Soler 2021.
/// \throws ArgumentError "line N: ..." for a text that is none; for pairs that are judged twice
[[nodiscard]] std::vector<Judgement> parse_judgements(std::string_view text);

/// A number, and the interval that holds it with the probability asked for.
struct Interval {
  double value = 0;  ///< of all pairs
  double low = 0;    ///< lower end; NaN where no sample had a correlation
  double high = 0;   ///< upper end
};

/// Rank correlations of computed with judged distances.
struct JudgementCorrelation {
  Interval spearman;  ///< Spearman's rho
  Interval kendall;   ///< Kendall's tau-b
};

/// How intervals of rank correlations are found: by percentiles over samples drawn with replacement (bootstrap, Efron
/// and Tibshirani 1993, section 13.3).
struct BootstrapOptions {
  std::size_t samples = 1000;  ///< drawn
  double coverage = 0.95;      ///< of the intervals
  std::uint64_t seed = 1;      ///< the same seed draws the same samples
};

/// Correlation of two series, with its intervals. Pairs of one group are drawn together: what is judged of one material
/// is not independent of what else is judged of it.
/// \param group of each pair; empty: each pair is drawn by itself
/// \throws ArgumentError for series of different lengths or fewer than 3 pairs, fewer than 20 samples, and a coverage
///   that is not above 0 and below 1; NumericError for values that are NaN
[[nodiscard]] JudgementCorrelation judgement_correlation(std::span<const double> computed,
                                                         std::span<const double> judged,
                                                         std::span<const std::string> group = {},
                                                         const BootstrapOptions& options = {});

}  // namespace lobe
