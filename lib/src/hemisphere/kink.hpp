#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "hemisphere/gauss.hpp"

namespace lobe {

/// A pair of directions above the base plane, as kinks see it.
struct KinkPair {
  double cos_i = 0, cos_o = 0;  ///< N.L, N.V
  double cos_between = 0;       ///< L.V
  /// L and V along the base plane, for anisotropic kinks only.
  double in_x = 0, in_y = 0, out_x = 0, out_y = 0;
};

/// A place where a reflectance is not smooth: the zeros of a function of both directions that changes sign there.
struct Kink {
  using Numbers = std::array<double, 6>;

  /// Finite for all pairs; only its sign counts.
  /// \param numbers those of the kink
  double (*at)(const Numbers& numbers, const KinkPair& pair) = nullptr;
  Numbers numbers{};
  /// Power of the distance with which the reflectance differs beside it: 1 for a jump of the derivative.
  double order = 1;
  bool is_anisotropic = false;  ///< sees components along the base plane
  /// Takes the place of `at` where it is set: kinks of formulas. `text` tells such kinks apart.
  std::function<double(const KinkPair&)> by = {};
  std::string text = {};
  /// Belongs to an anisotropic lobe, of which it need not see components.
  bool is_of_anisotropic = false;

  [[nodiscard]] double operator()(const KinkPair& pair) const { return by ? by(pair) : at(numbers, pair); }
  [[nodiscard]] bool is_jump() const { return order == 0; }
  /// Whether rules in half-vectors, which anisotropic lobes take, look for it.
  [[nodiscard]] bool is_on_rays() const { return is_anisotropic || is_of_anisotropic; }
  /// Whether the function that begins there is not a polynomial.
  [[nodiscard]] bool has_root() const { return order != static_cast<int>(order); }

  /// The less smooth ones first.
  bool operator<(const Kink& other) const;
};

/// The kink of f(V, L).
[[nodiscard]] Kink exchanged(const Kink& kink);

/// Kinks that several models have, of a closed form that rules of quadrature know.
struct CommonKinks {
  bool attenuation = false;    ///< G (2.10) becomes 1
  bool mirror_cosine = false;  ///< R.V = 0, where (R.V)^n begins

  [[nodiscard]] static CommonKinks all() { return {.attenuation = true, .mirror_cosine = true}; }
  /// Those of either.
  [[nodiscard]] CommonKinks operator|(const CommonKinks& other) const {
    return {attenuation || other.attenuation, mirror_cosine || other.mirror_cosine};
  }
};

/// From this order on quadrature does as well without a limit.
inline constexpr double kSmoothOrder = 4;

/// L.V = s N.L N.V.
/// \param share s
[[nodiscard]] Kink product_kink(double share, double order);
/// L.H = cosine.
[[nodiscard]] Kink difference_kink(double cosine, double order);
/// |V_P - L'_P| = radius, in the base plane (Neumann 2001, eq. 4.1).
[[nodiscard]] Kink distance_kink(double radius, double order);
/// L, V and N in one plane.
[[nodiscard]] Kink plane_kink(double order);
/// N.L = cosine and N.V = cosine.
[[nodiscard]] std::vector<Kink> cosine_kinks(double cosine, double order);

/// Where Fresnel's equations for the cosine L.H have their critical angle: of refractive indices below 1 without
/// absorption to speak of.
[[nodiscard]] std::vector<Kink> critical_kinks(double ior, double extinction);

/// Zeros of a function between limits, each of which is found where it is the only one between two of `steps` equal
/// parts of a panel, to an ulp or so of the longest panel.
template <typename Function>
void append_zeros(const Function& f, std::span<const PanelEdge> limits, int steps, bool root,
                  std::vector<PanelEdge>& found) {
  constexpr int kMost = 60;
  double low = limits.front().at;
  double value = f(low);
  for (std::size_t i = 1; i < limits.size(); ++i) {
    const double from = limits[i - 1].at;
    const double length = limits[i].at - from;
    for (int k = 1; k <= steps; ++k) {
      const double high = k == steps ? limits[i].at : from + length * k / steps;
      const double next = f(high);
      if (value * next < 0) {
        // Regula falsi with halved values at an end that stays (Illinois), bisection where that is slow.
        double a = low;
        double b = high;
        double f_a = value;
        double f_b = next;
        int side = 0;
        for (int turn = 0; turn < kMost && b - a > 1e-15 * (1 + b); ++turn) {
          const double guess = turn % 4 == 3 ? (a + b) / 2 : (a * f_b - b * f_a) / (f_b - f_a);
          const double at = guess > a && guess < b ? guess : (a + b) / 2;
          const double f_at = f(at);
          if (f_at == 0) {
            a = b = at;
          } else if ((f_at < 0) == (value < 0)) {
            if (side == 1) f_b /= 2;
            a = at;
            f_a = f_at;
            side = 1;
          } else {
            if (side == -1) f_a /= 2;
            b = at;
            f_b = f_at;
            side = -1;
          }
        }
        found.push_back({(a + b) / 2, root});
      }
      if (next != 0) {
        low = high;
        value = next;
      }
    }
  }
}

}  // namespace lobe
