#include "model/family/diffraction.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "model/constants.hpp"

namespace lobe {

using std::numbers::pi;

Parameter surface_height() {
  return {"sigma", "1", 1e-3, 0.5, std::nullopt, "rms height of the surface over the wavelength"};
}

Parameter surface_correlation() {
  return {"tau", "1", 0.1, 1e3, std::nullopt, "autocorrelation length of the surface over the wavelength"};
}

ProposalPart diffraction_patch(const UnitVector& centre, double sigma_over, double tau_over) {
  const auto make = [&] {
    const double phase = 16 * pi * pi * sigma_over * sigma_over;
    const int terms = roughness_terms(phase);
    std::vector<double> factors;
    for (int m = 1; m <= terms; ++m) {
      factors.push_back(std::exp(m * std::log(phase) - phase - std::lgamma(m + 1.0)) / m);
    }
    const double lobe = pi * tau_over;
    const auto profile = [&](double distance) {
      double sum = 0;
      for (std::size_t k = 0; k < factors.size(); ++k) {
        sum += factors[k] * std::exp(-lobe * lobe * distance * distance / static_cast<double>(k + 1));
      }
      return sum;
    };
    return draw::mixture_table(profile, 1 / lobe);
  };
  return draw::patch_mixture(centre, draw::known_table(std::array{sigma_over, tau_over}, make));
}

}  // namespace lobe
