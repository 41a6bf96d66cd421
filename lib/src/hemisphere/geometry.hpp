#pragma once

#include <cstddef>
#include <vector>

#include "device/node_block.hpp"
#include "lobe/core/directions.hpp"

namespace lobe {

/// ln(R.V) where R.V <= 0: exp(n ln(R.V)) is 0 for every exponent, also in single precision.
inline constexpr double kNoMirrorCosine = -1e30;

/// ln(R.V) for deficit = 1 - R.V, as models take it.
[[nodiscard]] double log_mirror_cosine(double deficit);

/// Two elevations above the horizon as nodes need them: what many azimuths share.
struct ElevationPair {
  double cos_i, cos_o;    ///< of the angles from the normal
  double sin_i, sin_o;    ///< of the same angles
  double cos_difference;  ///< cos_i - cos_o without cancellation
  double sin_difference;  ///< sin_i - sin_o, likewise
};
[[nodiscard]] ElevationPair elevation_pair(double elevation_i, double elevation_o);

/// The node of a pair of elevations at an azimuth psi from the mirror side.
[[nodiscard]] NodeBlock::Node node_of_azimuth(const ElevationPair& pair, double psi, double factor);

/// Stores in a column of a block, or in the next one, what complete_nodes() needs to make the node that
/// node_of_azimuth() returns.
void place_node(NodeBlock& block, std::size_t column, const ElevationPair& pair, double psi, double factor);
void place_node(NodeBlock& block, const ElevationPair& pair, double psi, double factor);

/// Makes nodes of what place_node() has stored in `count` columns from `first`, several at a time where compiler and
/// processor can; once for each column, and before anything reads it. A node does not depend on those beside it.
void complete_nodes(NodeBlock& block, std::size_t first, std::size_t count);

/// The node of two directions given by their elevations above the horizon (pi/2 - theta; radians) and psi = pi -
/// delta_phi, the azimuth from the mirror side; keeps full relative accuracy at grazing angles and near the mirror
/// direction (reference/errata: tan^2 delta = m^2/(NL+NV)^2, R.V = 1 - ((NL-NV)^2 + m^2)/2 with m of eq. 4.1).
[[nodiscard]] NodeBlock::Node node_of_elevations(double elevation_i, double elevation_o, double psi, double factor);

/// Stores in the next column of a block what complete_directions() needs to make the node that node_of_directions()
/// returns, and its tangents where the block has some.
void place_directions(NodeBlock& block, const Directions& directions, double factor);

/// Makes nodes of what place_directions() has stored, as complete_nodes() does of what place_node() has.
void complete_directions(NodeBlock& block, std::size_t first, std::size_t count);

/// Makes a node for Directions, with factor 1.
[[nodiscard]] NodeBlock::Node node_of_directions(const Directions& directions);

/// Data that anisotropic models need besides, with L at the azimuth phi_in and V at phi_in + pi - psi: slopes of the
/// half-vector, accurate relative to their length, also near the mirror direction.
[[nodiscard]] NodeBlock::Tangents tangents_of_azimuth(const ElevationPair& pair, double phi_in, double psi);
[[nodiscard]] NodeBlock::Tangents tangents_of_directions(const Directions& directions);

/// A direction by its components along the normal and in the base plane.
struct Components {
  double cosine, x, y;
};

/// A pair of directions for anisotropic models; where L and V are nearly mirror images of each other the slopes of
/// their half-vector have an absolute error of an ulp.
struct TangentNode {
  NodeBlock::Node node;
  NodeBlock::Tangents tangents;
};
[[nodiscard]] TangentNode node_of_components(const Components& in, const Components& out, double factor);

}  // namespace lobe
