#pragma once

#include <span>
#include <string>
#include <string_view>

#include "lobe/compare/rank_correlation.hpp"
#include "plot/gnuplot.hpp"

namespace lobe {

/// Rank correlations between metrics as a matrix of colours with the values in the cells: Spearman's rho below the
/// diagonal, Kendall's tau-b above it. What is NaN stays empty.
/// \param stem stem of the picture's files
/// \param metrics their names, one per row of the matrices
/// \throws ArgumentError when names and matrices differ in number
[[nodiscard]] gnuplot::Picture agreement_picture(const std::string& stem, std::string_view title,
                                                 std::span<const std::string> metrics, const RankAgreement& agreement);

}  // namespace lobe
