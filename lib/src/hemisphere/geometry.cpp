#include "hemisphere/geometry.hpp"

#include <cmath>
#include <numbers>

#include "hemisphere/node_place.hpp"

namespace lobe {
namespace {

/// \param cos_difference cos_i - cos_o
ElevationPair pair_of(double cos_i, double cos_o, double sin_i, double sin_o, double cos_difference) {
  // sin^2 + cos^2 = 1 gives the difference of the sines; that of the angles' mean is rounded too much at grazing
  // angles.
  const double sines = sin_i + sin_o;
  const double sin_difference = sines > 0 ? -cos_difference * (cos_i + cos_o) / sines : 0;
  return {cos_i, cos_o, sin_i, sin_o, cos_difference, sin_difference};
}

/// \param mirror_half_sine sin(psi/2) = cos(delta_phi/2)
NodeBlock::Node make_node(const ElevationPair& pair, double mirror_half_sine, double factor) {
  const double along = pair.cos_i + pair.cos_o;
  const double across2 =
      pair.sin_difference * pair.sin_difference + 4 * pair.sin_i * pair.sin_o * mirror_half_sine * mirror_half_sine;
  const double cos_d = std::sqrt(across2 + along * along) / 2;
  const double tan2_h = across2 / (along * along);
  const double deficit = (pair.cos_difference * pair.cos_difference + across2) / 2;
  return {
      pair.cos_i, pair.cos_o, along / (2 * cos_d), cos_d, tan2_h, -0.5 * std::log1p(tan2_h), log_mirror_cosine(deficit),
      factor};
}

/// \param half_sine sin(psi/2)
/// \param half_cosine cos(psi/2)
NodeBlock::Tangents make_tangents(const ElevationPair& pair, double phi_in, double half_sine, double half_cosine) {
  // L + V in the frame of L.
  const double ahead = pair.sin_difference + 2 * pair.sin_o * half_sine * half_sine;
  const double aside = 2 * pair.sin_o * half_sine * half_cosine;
  const double along = pair.cos_i + pair.cos_o;
  const double cosine = std::cos(phi_in);
  const double sine = std::sin(phi_in);
  return {(ahead * cosine - aside * sine) / along, (ahead * sine + aside * cosine) / along, pair.sin_i * cosine,
          pair.sin_i * sine};
}

ElevationPair pair_of_directions(const Directions& d) {
  const double cos_difference =
      -2 * std::sin((d.theta_in + d.theta_out) / 2) * std::sin((d.theta_in - d.theta_out) / 2);
  return pair_of(std::cos(d.theta_in), std::cos(d.theta_out), std::sin(d.theta_in), std::sin(d.theta_out),
                 cos_difference);
}

}  // namespace

double log_mirror_cosine(double deficit) {
  return deficit < 1 ? std::log1p(-deficit) : kNoMirrorCosine;
}

ElevationPair elevation_pair(double elevation_i, double elevation_o) {
  const double cos_difference =
      2 * std::cos((elevation_i + elevation_o) / 2) * std::sin((elevation_i - elevation_o) / 2);
  return pair_of(std::sin(elevation_i), std::sin(elevation_o), std::cos(elevation_i), std::cos(elevation_o),
                 cos_difference);
}

NodeBlock::Node node_of_azimuth(const ElevationPair& pair, double psi, double factor) {
  return make_node(pair, std::sin(psi / 2), factor);
}

void place_node(NodeBlock& block, std::size_t column, const ElevationPair& pair, double psi, double factor) {
  NodeBlock::Node node{};
  node[NodeBlock::cos_i] = pair.cos_i;
  node[NodeBlock::cos_o] = pair.cos_o;
  node[NodeBlock::factor] = factor;
  node[place::kPsi] = psi;
  node[place::kSinDifference] = pair.sin_difference;
  node[place::kSines] = 4 * pair.sin_i * pair.sin_o;
  node[place::kCosDifference] = pair.cos_difference;
  block.set(column, node);
}

void place_node(NodeBlock& block, const ElevationPair& pair, double psi, double factor) {
  place_node(block, block.size(), pair, psi, factor);
  block.extend(1);
}

void place_directions(NodeBlock& block, const Directions& directions, double factor) {
  NodeBlock::Node node{};
  node[place::kThetaIn] = directions.theta_in;
  node[place::kThetaOut] = directions.theta_out;
  node[place::kDeltaPhi] = directions.delta_phi;
  node[NodeBlock::factor] = factor;
  if (!block.has_tangents()) return block.push(node);
  NodeBlock::Tangents tangents{};
  tangents[place::kPhiIn] = directions.phi_in;
  block.push(node, tangents);
}

NodeBlock::Node node_of_elevations(double elevation_i, double elevation_o, double psi, double factor) {
  return node_of_azimuth(elevation_pair(elevation_i, elevation_o), psi, factor);
}

NodeBlock::Tangents tangents_of_azimuth(const ElevationPair& pair, double phi_in, double psi) {
  return make_tangents(pair, phi_in, std::sin(psi / 2), std::cos(psi / 2));
}

NodeBlock::Node node_of_directions(const Directions& d) {
  return make_node(pair_of_directions(d), std::cos(d.delta_phi / 2), 1);
}

NodeBlock::Tangents tangents_of_directions(const Directions& d) {
  return make_tangents(pair_of_directions(d), d.phi_in, std::cos(d.delta_phi / 2), std::sin(d.delta_phi / 2));
}

TangentNode node_of_components(const Components& in, const Components& out, double factor) {
  const double along = in.cosine + out.cosine;
  const double slope_x = (in.x + out.x) / along;
  const double slope_y = (in.y + out.y) / along;
  const double tan2_h = slope_x * slope_x + slope_y * slope_y;
  const double log_cos_h = -0.5 * std::log1p(tan2_h);
  const double cos_h = std::exp(log_cos_h);
  const double fall = in.cosine - out.cosine;
  const double deficit = (fall * fall + along * along * tan2_h) / 2;
  return {{in.cosine, out.cosine, cos_h, along / (2 * cos_h), tan2_h, log_cos_h, log_mirror_cosine(deficit), factor},
          {slope_x, slope_y, in.x, in.y}};
}

}  // namespace lobe
