#include "hemisphere/geometry.hpp"

#include <cmath>
#include <numbers>

namespace lobe {
namespace {

constexpr double kNothing = -1e30;  // exp(n * kNothing) is 0 for every exponent, also in single precision

/// \param cos_difference N.L - N.V, from a form that does not cancel
/// \param mirror_half_sine sin(psi/2) = cos(delta_phi/2)
NodeBlock::Node make_node(double cos_i, double cos_o, double sin_i, double sin_o, double cos_difference,
                          double mirror_half_sine, double factor) {
  const double along = cos_i + cos_o;
  // sin^2 + cos^2 = 1 gives the difference of the sines; that of the angles' mean is rounded too much at grazing
  // angles.
  const double sines = sin_i + sin_o;
  const double sin_difference = sines > 0 ? -cos_difference * along / sines : 0;
  const double across2 = sin_difference * sin_difference + 4 * sin_i * sin_o * mirror_half_sine * mirror_half_sine;
  const double cos_d = std::sqrt(across2 + along * along) / 2;
  const double tan2_h = across2 / (along * along);
  const double deficit = (cos_difference * cos_difference + across2) / 2;
  return {cos_i, cos_o, along / (2 * cos_d), cos_d, tan2_h, -0.5 * std::log1p(tan2_h), log_mirror_cosine(deficit),
          factor};
}

}  // namespace

double log_mirror_cosine(double deficit) {
  return deficit < 1 ? std::log1p(-deficit) : kNothing;
}

NodeBlock::Node node_of_elevations(double elevation_i, double elevation_o, double psi, double factor) {
  const double cos_difference =
      2 * std::cos((elevation_i + elevation_o) / 2) * std::sin((elevation_i - elevation_o) / 2);
  return make_node(std::sin(elevation_i), std::sin(elevation_o), std::cos(elevation_i), std::cos(elevation_o),
                   cos_difference, std::sin(psi / 2), factor);
}

NodeBlock::Node node_of_directions(const Directions& d) {
  const double cos_difference =
      -2 * std::sin((d.theta_in + d.theta_out) / 2) * std::sin((d.theta_in - d.theta_out) / 2);
  return make_node(std::cos(d.theta_in), std::cos(d.theta_out), std::sin(d.theta_in), std::sin(d.theta_out),
                   cos_difference, std::cos(d.delta_phi / 2), 1);
}

}  // namespace lobe
