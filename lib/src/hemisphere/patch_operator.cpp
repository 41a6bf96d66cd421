#include "hemisphere/patch_operator.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/parallel.hpp"
#include "hemisphere/disc_nodes.hpp"
#include "hemisphere/gauss.hpp"
#include "hemisphere/patch_response.hpp"

namespace lobe {
namespace {

using std::numbers::pi;
using RowMajorMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

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

/// Integrals over the disc of radius R about a point at a distance p > 0, cut by the unit disc. By the divergence
/// theorem, with fields that have no flux through the unit circle: F = R(r) sin(m psi)/m r psi^ for m > 0, and for m =
/// 0 F = x / r^2 times the integral of R_0k(s) s ds, which vanishes at r = 1.
class DiscIntegrals {
 public:
  DiscIntegrals(const DiscPolynomials& polynomials, const DiscNodes& nodes, double radius)
      : polynomials_(polynomials), nodes_(nodes), radius_(radius) {}

  /// \param round of the polynomials of order 0, overwritten
  /// \param others weights of a radial part's values at the nodes, order by order; those of order 0 are left alone
  void operator()(double p, Eigen::Ref<Eigen::RowVectorXd> round, Eigen::Ref<RowMajorMatrix> others) const {
    round.setZero();
    others.setZero();
    round(0) = disc_polynomial_factor(0, 0) * lens_area(p, radius_);
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
    add_round(radii, outer_flux, round);
    // Even and odd orders are interpolated apart.
    const std::array<Eigen::Index, 2> sizes{polynomials_.orders() / 2 + polynomials_.orders() % 2,
                                            polynomials_.orders() / 2};
    std::array<RowMajorMatrix, 2> weights{RowMajorMatrix(sizes[0], count), RowMajorMatrix(sizes[1], count)};
    Eigen::ArrayXd sine = Eigen::ArrayXd::Zero(count);
    Eigen::ArrayXd earlier = -sines;
    for (Eigen::Index m = 0; m < polynomials_.orders(); ++m) {
      weights[static_cast<std::size_t>(m % 2)].row(m / 2) =
          (sine * flux / std::max<double>(1, static_cast<double>(m))).matrix();
      const Eigen::ArrayXd next = 2 * cosines * sine - earlier;
      earlier = sine;
      sine = next;
    }
    for (const std::size_t parity : {0U, 1U}) {
      const RowMajorMatrix at_nodes = weights[parity] * nodes_.interpolation(radii, parity == 1);
      for (Eigen::Index k = 0; k < at_nodes.rows(); ++k)
        others.row(2 * k + static_cast<Eigen::Index>(parity)) = at_nodes.row(k);
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
  const DiscNodes& nodes_;
  double radius_;
};

}  // namespace

std::vector<Eigen::MatrixXd> patch_light_matrices(const DiscPolynomials& polynomials,
                                                  std::span<const LightDisc> discs) {
  std::vector<Eigen::MatrixXd> matrices;
  for (int m = 0; m < polynomials.orders(); ++m) {
    matrices.push_back(Eigen::MatrixXd::Zero(polynomials.count(m), polynomials.count(m)));
  }
  const DiscNodes nodes(polynomials.degree());
  for (const LightDisc& disc : discs) {
    const auto centres = centre_nodes(polynomials.degree(), disc.radius);
    const auto node_count = nodes.radii().size();
    const DiscIntegrals of_disc(polynomials, nodes, disc.radius);
    // So many centres at a time, for the sake of memory.
    constexpr std::size_t kCentres = 64;
    for (std::size_t first = 0; first < centres.size(); first += kCentres) {
      const std::size_t count = std::min(kCentres, centres.size() - first);
      RowMajorMatrix round(static_cast<Eigen::Index>(count), polynomials.count(0));
      RowMajorMatrix others(static_cast<Eigen::Index>(count), polynomials.orders() * node_count);
      parallel_for(count, [&](std::size_t i) {
        const auto at = static_cast<Eigen::Index>(i);
        const CentreNode& centre = centres[first + i];
        Eigen::RowVectorXd of_round(polynomials.count(0));
        RowMajorMatrix of_others(polynomials.orders(), node_count);
        of_disc(centre.at, of_round, of_others);
        // Over the azimuth of P, cos^2 of the order.
        const double scale = std::sqrt(disc.factor * centre.weight * pi);
        round.row(at) = std::numbers::sqrt2 * scale * of_round;
        others.row(at) = scale * Eigen::Map<const Eigen::RowVectorXd>(of_others.data(), of_others.size());
      });
      parallel_for(matrices.size(), [&](std::size_t m) {
        const auto order = static_cast<int>(m);
        if (order == 0) {
          matrices[m].noalias() += round.transpose() * round;
          return;
        }
        const Eigen::Index seen = nodes.count(order);
        const Eigen::ArrayXd radii = nodes.radii().head(seen);
        const Eigen::MatrixXd rows =
            others.middleCols(order * node_count, seen) * polynomials.radial(order, radii, radii.pow(order));
        matrices[m].noalias() += rows.transpose() * rows;
      });
    }
  }
  return matrices;
}

}  // namespace lobe
