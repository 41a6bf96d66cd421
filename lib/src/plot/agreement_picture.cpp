#include "plot/agreement_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "lobe/core/error.hpp"
#include "plot/matrix_block.hpp"

namespace lobe {
namespace {

using std::back_inserter;

constexpr int kCell = 62;  // pixels
constexpr double kFont = 14;
constexpr int kTopMargin = 84;
constexpr int kRightMargin = 150;

/// Sizes in pixels.
struct AgreementLayout {
  int side = 0;  ///< side of the matrix
  int left = 0;
  int bottom = 0;

  [[nodiscard]] int width() const { return left + side + kRightMargin; }
  [[nodiscard]] int height() const { return bottom + side + kTopMargin; }
};

AgreementLayout arrange(std::span<const std::string> metrics) {
  std::size_t longest = 1;
  for (const auto& name : metrics) longest = std::max(longest, gnuplot::character_count(name));
  const int room = static_cast<int>(static_cast<double>(longest) * kCharacterWidth * kFont) + 24;
  // A short title needs some width even over a small matrix.
  return {std::max(kCell * static_cast<int>(metrics.size()), 4 * kCell), room, room};
}

/// Spearman below the diagonal, Kendall above.
double shown(const RankAgreement& agreement, Eigen::Index row, Eigen::Index column) {
  return column <= row ? agreement.spearman(row, column) : agreement.kendall(row, column);
}

/// Lower end of the colours: the smallest value, rounded down to a tenth.
double lowest(const RankAgreement& agreement) {
  double low = 0.9;
  for (Eigen::Index i = 0; i < agreement.spearman.rows(); ++i) {
    for (Eigen::Index j = 0; j < agreement.spearman.cols(); ++j) {
      const double value = shown(agreement, i, j);
      if (std::isfinite(value)) low = std::min(low, value);
    }
  }
  return std::floor(low * 10) / 10;
}

}  // namespace

gnuplot::Picture agreement_picture(const std::string& stem, std::string_view title,
                                   std::span<const std::string> metrics, const RankAgreement& agreement) {
  const auto n = static_cast<Eigen::Index>(metrics.size());
  if (n == 0 || agreement.spearman.rows() != n || agreement.kendall.rows() != n) {
    throw ArgumentError(fmt::format("{} names for {} metrics; expected one per metric", n, agreement.spearman.rows()));
  }
  const AgreementLayout layout = arrange(metrics);
  const double width = layout.width();
  const double height = layout.height();
  const double low = lowest(agreement);

  std::string script = gnuplot::preamble(stem, "Rank correlations between metrics", layout.width(), layout.height());
  script += matrix_frame({layout.left, layout.bottom, layout.side, layout.width(), layout.height()}, 16, title,
                         "below the diagonal Spearman's rho, above it Kendall's tau-b");
  const double points = kFont / kPixelsPerPoint;
  fmt::format_to(back_inserter(script),
                 "set xtics scale 0 rotate by 90 right font ',{0:.1f}' ()\nset ytics scale 0 font ',{0:.1f}' ()\n",
                 points);
  for (Eigen::Index k = 0; k < n; ++k) {
    fmt::format_to(back_inserter(script), "set xtics add ({0} {1})\nset ytics add ({0} {1})\n",
                   gnuplot::string_literal(metrics[static_cast<std::size_t>(k)]), k);
  }
  for (Eigen::Index row = 0; row < n; ++row) {
    for (Eigen::Index column = 0; column < n; ++column) {
      const double value = shown(agreement, row, column);
      if (row == column || !std::isfinite(value)) continue;
      // The palette's upper half is light.
      const bool is_light = value > low + 0.55 * (1 - low);
      fmt::format_to(back_inserter(script),
                     "set label '{:.2f}' at {},{} center front textcolor rgb '{}' font ',{:.1f}'\n", value, column, row,
                     is_light ? "#000000" : "#ffffff", points);
    }
  }
  script += gnuplot::viridis();
  const double bar_height = std::min(1.0, 420.0 / layout.side) * layout.side / height;
  fmt::format_to(back_inserter(script),
                 "set cbrange [{0:.6g}:1]\nset format cb '%.1f'\nset cblabel 'rank correlation' offset 1.5\n"
                 "set colorbox vertical user origin screen {1:.6f},{2:.6f} size screen {3:.6f},{4:.6f} noborder\n"
                 "set xrange [-0.5:{5}]\nset yrange [{5}:-0.5]\n"
                 "plot data_file matrix using 1:2:3 with image\n",
                 low, (layout.left + layout.side + 24) / width, (layout.bottom + layout.side) / height - bar_height,
                 20 / width, bar_height, static_cast<double>(n) - 0.5);

  return {std::move(script),
          matrix_block(std::string(title) + ": rank correlations", metrics,
                       Eigen::MatrixXd::NullaryExpr(n, n, [&](Eigen::Index row, Eigen::Index column) {
                         return shown(agreement, row, column);
                       }))};
}

}  // namespace lobe
