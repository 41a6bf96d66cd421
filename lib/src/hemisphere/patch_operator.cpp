#include "hemisphere/patch_operator.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/parallel.hpp"
#include "hemisphere/gauss.hpp"
#include "hemisphere/patch_response.hpp"

namespace lobe {
namespace {

using std::numbers::pi;

/// Gauss nodes for polynomials of a degree over a share of what they may oscillate. The margins and shares of this file
/// are those with which more nodes change no entry by more than rounding, for radii from 0.02 to 1.8 and degrees to
/// 270.
int gauss_count(int degree, double share) {
  constexpr int kMargin = 16;
  return kMargin + static_cast<int>(std::ceil(share * degree));
}

struct CentreNode {
  double at;      ///< distance of P from the origin
  double weight;  ///< weight in the integral over P, without the azimuth
};

/// Distances of P. Integrals over discs are polynomials of P as long as the disc lies in the unit disc, with
/// oscillations of how far it reaches; from where it touches the horizon they begin like a power 3/2 and oscillate with
/// the azimuth of the two intersections.
std::vector<CentreNode> centre_nodes(int degree, double radius) {
  std::vector<CentreNode> nodes;
  const auto add_panel = [&](const PanelEdge& low, const PanelEdge& high, double oscillation) {
    if (!(high.at - low.at > 1e-14)) return;
    const GaussRule gauss = gauss_rule(gauss_count(degree, oscillation / (pi / 2)));
    for (std::size_t k = 0; k < gauss.nodes.size(); ++k) {
      const PanelPoint p = panel_point(low, high, gauss.nodes[k]);
      nodes.push_back({p.at, gauss.weights[k] * p.stretch * p.at});
    }
  };
  const double touching = std::abs(1 - radius);
  add_panel({0}, {touching}, radius < 1 ? 0.75 * std::acos(radius) : 0);
  add_panel({touching, true}, {1}, 1.4 * (radius < 1 ? std::asin(radius) : pi - 2 * std::asin(radius / 2)));
  return nodes;
}

/// Integrals of all polynomials over the disc of radius R about a point at a distance p > 0, cut by the unit disc. By
/// the divergence theorem, with fields that have no flux through the unit circle: F = R_mk(r) sin(m psi)/m r psi^ for
/// m > 0, and for m = 0 F = x / r^2 times the integral of R_0k(s) s ds, which vanishes at r = 1.
class DiscIntegrals {
 public:
  DiscIntegrals(const DiscPolynomials& polynomials, double radius) : polynomials_(polynomials), radius_(radius) {}

  /// \param values one for each polynomial, overwritten
  void operator()(double p, Eigen::Ref<Eigen::RowVectorXd> values) const {
    values.setZero();
    values(0) = disc_polynomial_factor(0, 0) * lens_area(p, radius_);
    // Half the arc inside the unit disc, by its angle t from the direction of P.
    const double begin = std::acos(std::clamp((1 - p * p - radius_ * radius_) / (2 * p * radius_), -1.0, 1.0));
    if (!(begin < pi)) return;
    const GaussRule gauss = gauss_rule(gauss_count(polynomials_.degree(), std::min(0.5 * oscillation(p, begin), 0.8)));
    const auto count = static_cast<Eigen::Index>(gauss.nodes.size());
    Eigen::ArrayXd radii(count);
    Eigen::ArrayXd cosines(count);
    Eigen::ArrayXd sines(count);
    Eigen::ArrayXd flux(count);        // of x^perp, times the length
    Eigen::ArrayXd outer_flux(count);  // of x
    for (Eigen::Index q = 0; q < count; ++q) {
      const double t = begin + (pi - begin) * gauss.nodes[static_cast<std::size_t>(q)];
      const double x = p + radius_ * std::cos(t);
      const double y = radius_ * std::sin(t);
      const double length = 2 * radius_ * (pi - begin) * gauss.weights[static_cast<std::size_t>(q)];
      radii(q) = std::min(std::hypot(x, y), 1.0);
      cosines(q) = radii(q) > 0 ? x / radii(q) : 1;
      sines(q) = radii(q) > 0 ? y / radii(q) : 0;
      flux(q) = length * p * std::sin(t);
      outer_flux(q) = length * (p * std::cos(t) + radius_);
    }
    add_round(radii, outer_flux, values);
    Eigen::ArrayXd powers = radii;
    Eigen::ArrayXd sine = sines;
    Eigen::ArrayXd earlier = Eigen::ArrayXd::Zero(count);
    for (int m = 1; m < polynomials_.orders(); ++m) {
      const Eigen::VectorXd weights = sine / m * flux;
      values.segment(polynomials_.first(m), polynomials_.count(m)) =
          weights.transpose() * polynomials_.radial(m, radii, powers);
      powers *= radii;
      const Eigen::ArrayXd next = 2 * cosines * sine - earlier;
      earlier = sine;
      sine = next;
    }
  }

 private:
  /// How far the arc reaches in asin r or, if farther, in the azimuth.
  [[nodiscard]] double oscillation(double p, double begin) const {
    const double elevation = std::acos(std::min(std::abs(p - radius_), 1.0)) - std::acos(std::min(p + radius_, 1.0));
    if (p > radius_) return std::max(elevation, std::asin(radius_ / p) * 2);
    const double azimuth = std::atan2(radius_ * std::sin(begin), p + radius_ * std::cos(begin));
    return std::max(elevation, pi - azimuth);
  }

  /// Order 0, k > 0: the integral of P_k(2 s^2 - 1) s ds is -r^2 (1 - r^2) P_k'(2 r^2 - 1) / (k (k + 1)).
  void add_round(const Eigen::ArrayXd& radii, const Eigen::ArrayXd& flux, Eigen::Ref<Eigen::RowVectorXd> values) const {
    const Eigen::MatrixXd legendre = polynomials_.radial(0, radii, Eigen::ArrayXd::Ones(radii.size()));
    Eigen::ArrayXd before = Eigen::ArrayXd::Zero(radii.size());  // P_{k-1}'
    Eigen::ArrayXd slope = Eigen::ArrayXd::Ones(radii.size());   // P_k'
    const Eigen::ArrayXd share = -(1 - radii) * (1 + radii) * flux;
    for (int k = 1; k < polynomials_.count(0); ++k) {
      const double factor = disc_polynomial_factor(0, k);
      values(k) = factor / (k * (k + 1.0)) * (share * slope).sum();
      const Eigen::ArrayXd next = before + (2 * k + 1) / factor * legendre.col(k).array();
      before = slope;
      slope = next;
    }
  }

  const DiscPolynomials& polynomials_;
  double radius_;
};

}  // namespace

std::vector<Eigen::MatrixXd> patch_light_matrices(const DiscPolynomials& polynomials,
                                                  std::span<const LightDisc> discs) {
  std::vector<Eigen::MatrixXd> matrices;
  for (int m = 0; m < polynomials.orders(); ++m) {
    matrices.push_back(Eigen::MatrixXd::Zero(polynomials.count(m), polynomials.count(m)));
  }
  for (const LightDisc& disc : discs) {
    const auto nodes = centre_nodes(polynomials.degree(), disc.radius);
    Eigen::MatrixXd integrals(polynomials.size(), static_cast<Eigen::Index>(nodes.size()));
    const DiscIntegrals of_disc(polynomials, disc.radius);
    parallel_for(nodes.size(), [&](std::size_t i) {
      Eigen::RowVectorXd row(polynomials.size());
      of_disc(nodes[i].at, row);
      // Over the azimuth of P, cos^2 of the order.
      row *= std::sqrt(disc.factor * nodes[i].weight * pi);
      row.head(polynomials.count(0)) *= std::numbers::sqrt2;
      integrals.col(static_cast<Eigen::Index>(i)) = row.transpose();
    });
    parallel_for(matrices.size(), [&](std::size_t m) {
      const auto order = static_cast<int>(m);
      const auto rows = integrals.middleRows(polynomials.first(order), polynomials.count(order));
      matrices[m].noalias() += rows * rows.transpose();
    });
  }
  return matrices;
}

}  // namespace lobe
