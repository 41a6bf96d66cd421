#include "hemisphere/geometry.hpp"

#include <cmath>
#include <numbers>

namespace lobe {
namespace {

constexpr double kNothing = -1e30;  // exp(n * kNothing) is 0 for every exponent, also in single precision

/// \param mirror_half_sine sin(psi/2) = cos(delta_phi/2)
NodeBlock::Node make_node(const ElevationPair& pair, double mirror_half_sine, double factor) {
  const double along = pair.cos_i + pair.cos_o;
  // sin^2 + cos^2 = 1 gives the difference of the sines; that of the angles' mean is rounded too much at grazing
  // angles.
  const double sines = pair.sin_i + pair.sin_o;
  const double sin_difference = sines > 0 ? -pair.cos_difference * along / sines : 0;
  const double across2 =
      sin_difference * sin_difference + 4 * pair.sin_i * pair.sin_o * mirror_half_sine * mirror_half_sine;
  const double cos_d = std::sqrt(across2 + along * along) / 2;
  const double tan2_h = across2 / (along * along);
  const double deficit = (pair.cos_difference * pair.cos_difference + across2) / 2;
  return {
      pair.cos_i, pair.cos_o, along / (2 * cos_d), cos_d, tan2_h, -0.5 * std::log1p(tan2_h), log_mirror_cosine(deficit),
      factor};
}

}  // namespace

double log_mirror_cosine(double deficit) {
  return deficit < 1 ? std::log1p(-deficit) : kNothing;
}

ElevationPair elevation_pair(double elevation_i, double elevation_o) {
  const double cos_difference =
      2 * std::cos((elevation_i + elevation_o) / 2) * std::sin((elevation_i - elevation_o) / 2);
  return {std::sin(elevation_i), std::sin(elevation_o), std::cos(elevation_i), std::cos(elevation_o), cos_difference};
}

NodeBlock::Node node_of_azimuth(const ElevationPair& pair, double psi, double factor) {
  return make_node(pair, std::sin(psi / 2), factor);
}

NodeBlock::Node node_of_elevations(double elevation_i, double elevation_o, double psi, double factor) {
  return node_of_azimuth(elevation_pair(elevation_i, elevation_o), psi, factor);
}

NodeBlock::Node node_of_directions(const Directions& d) {
  const double cos_difference =
      -2 * std::sin((d.theta_in + d.theta_out) / 2) * std::sin((d.theta_in - d.theta_out) / 2);
  const ElevationPair pair{std::cos(d.theta_in), std::cos(d.theta_out), std::sin(d.theta_in), std::sin(d.theta_out),
                           cos_difference};
  return make_node(pair, std::cos(d.delta_phi / 2), 1);
}

}  // namespace lobe
