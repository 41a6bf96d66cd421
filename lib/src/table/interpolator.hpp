#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "lobe/core/estimate.hpp"
#include "lobe/table/table.hpp"

namespace lobe {

/// Smooth part of a table between its nodes. On product grids by local polynomials of degree 5 in both theta and in
/// azimuth, continued through the normal (a function of -theta is one of theta at phi + pi). The error is twice the
/// sum over coordinates of the largest change against a polynomial of lower degree (3 on the middle nodes, 4 on the
/// left and on the right ones: one of them may agree by accident) or along theta a share of the fourth differences that
/// do not fall as those of smooth values do, plus the change against a continuation from one side where the normal is
/// near (a cone there is smooth on neither), plus the error of the values used. Averages over cells are no values at
/// directions: there six times what averaging changes by the second differences is added, and the first ones times the
/// way from the node to the cell's mean theta. On other grids the value is that of the cells which contain the
/// directions, and the error has half of the change to the neighbouring cells in each coordinate.
class Interpolator {
 public:
  /// \param table must outlive this
  explicit Interpolator(const BrdfTable& table);

  [[nodiscard]] Estimate at(std::size_t channel, Direction in, Direction out) const;

  /// On grids of cells without equal azimuths per ring: half of the change to the neighbouring cells in each
  /// coordinate.
  [[nodiscard]] double cell_change(std::size_t channel, std::size_t row, std::size_t column) const;

  /// A function of the rows alone (delta parts), at a direction; the error is that of the interpolation, as of at().
  [[nodiscard]] Estimate row_part(const std::vector<double>& parts, std::size_t channel, Direction in) const;

 private:
  static constexpr std::size_t kNodes = 6;
  static constexpr std::size_t kRules = 4;  ///< degree 5, then those of lower degree on the same nodes

  /// Positions and coefficients of local polynomials in one coordinate.
  struct Stencil {
    std::size_t size = 0;
    std::array<long, kNodes> index{};
    std::array<std::array<double, kNodes>, kRules> rules{};
    bool spans_normal = false;
  };

  [[nodiscard]] Stencil theta_stencil(double theta) const;
  /// Stencil of degree 3 on the rings nearest to the normal, without continuation to -theta.
  [[nodiscard]] Stencil one_sided_stencil(double theta) const;
  [[nodiscard]] Stencil azimuth_stencil(double phi) const;
  /// The value, and what it changes by when one coordinate after the other takes a lower degree.
  [[nodiscard]] Estimate sum(std::size_t channel, const Stencil& theta_in, const Stencil& theta_out, double phi_in,
                             double phi_out) const;
  [[nodiscard]] Estimate isotropic_sum(std::size_t channel, const Stencil& theta_in, const Stencil& theta_out,
                                       double delta_phi) const;
  [[nodiscard]] Estimate general_sum(std::size_t channel, const Stencil& theta_in, const Stencil& theta_out,
                                     double phi_in, double phi_out) const;
  [[nodiscard]] Estimate product_at(std::size_t channel, Direction in, Direction out) const;
  [[nodiscard]] Estimate cell_at(std::size_t channel, Direction in, Direction out) const;
  /// Sum over coordinates of what averaging over a cell changes.
  [[nodiscard]] double averaging_error(std::size_t channel, Direction in, Direction out) const;
  [[nodiscard]] double node_error(std::size_t channel, const Stencil& in, const Stencil& out) const;

  static void fill_rules(Stencil& stencil, std::span<const double> nodes, double x);

  const BrdfTable& table_;
  std::vector<double> thetas_;  ///< of the rings, continued to -theta: 2 n_theta, rising
};

}  // namespace lobe
