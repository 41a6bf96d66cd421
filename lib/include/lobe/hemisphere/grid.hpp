#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lobe/core/directions.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// Kinds of grids. Values of a table belong to nodes; on grids of cells they are averages over cells.
enum class GridKind {
  gauss,         ///< n_theta Gauss-Legendre nodes in cos(theta) x n_phi equispaced azimuths; spectral for smooth f
  uniform,       ///< n_theta mid-points in theta x n_phi azimuths
  cells,         ///< n_theta x n_phi cells of equal projected solid angle
  shirley_chiu,  ///< side x side cells of equal projected solid angle, squares mapped to the disc (Shirley, Chiu 1997)
  klems          ///< 145, 77, 73 or 41 patches in rings (Klems 1994, the bases of WINDOW and Radiance)
};

/// Nodes with equal polar angle, at azimuths phi_0 + 2 pi j / count.
struct Ring {
  double theta = 0;            ///< polar angle of its nodes, radians
  double theta_low = 0;        ///< lower limit of the ring's cells
  double theta_high = 0;       ///< upper limit (gauss grids have no cells: limits that enclose the ring's weight)
  double weight = 0;           ///< projected solid angle of each node, sr
  std::size_t first_node = 0;  ///< index of its first node; the others follow
  std::size_t count = 0;       ///< number of its nodes
};

/// A discretised hemisphere: nodes X_j with weights w_j, so that sum_j w_j g(X_j) is the integral of g dmu, dmu =
/// cos(theta) d omega; the weights sum to pi. Every grid maps onto itself under phi -> phi + pi. An immutable value.
class HemisphereGrid {
 public:
  /// Makes a grid of Gauss-Legendre nodes in cos(theta) with equispaced azimuths.
  /// \param n_theta at least 1
  /// \param n_phi even, at least 2
  /// \throws ArgumentError otherwise (as all of these functions)
  [[nodiscard]] static HemisphereGrid gauss(std::size_t n_theta, std::size_t n_phi);
  /// Makes a grid of mid-points in theta; parameters and exceptions as for gauss().
  [[nodiscard]] static HemisphereGrid uniform(std::size_t n_theta, std::size_t n_phi);
  /// Makes a grid of cells with equal projected solid angle; parameters and exceptions as for gauss().
  [[nodiscard]] static HemisphereGrid cells(std::size_t n_theta, std::size_t n_phi);
  /// Makes a grid of squares mapped to the disc, with equal projected solid angle.
  /// \param side a power of two, at least 2
  [[nodiscard]] static HemisphereGrid shirley_chiu(std::size_t side);
  /// Makes a grid of the patches of a Klems basis.
  /// \param patches 145 (full basis), 77 (half, of WINDOW), 73 (half, of Radiance) or 41 (quarter)
  [[nodiscard]] static HemisphereGrid klems(std::size_t patches);

  /// Default grids for tabulation: gauss:64x128, and gauss:24x48 for reflectances that see azimuths.
  [[nodiscard]] static HemisphereGrid default_grid(bool is_isotropic = true);

  /// Reads "gauss:64x128" (or "64x128"), "uniform:64x128", "cells:64x128", "shirley-chiu:32", "klems:145".
  /// \throws ArgumentError for anything else
  [[nodiscard]] static HemisphereGrid parse(std::string_view text);
  /// Name of the grid, as parse() reads it.
  [[nodiscard]] std::string name() const;

  /// Kind of the grid.
  [[nodiscard]] GridKind kind() const { return kind_; }
  /// Whether every ring has the same azimuths, starting at 0, as isotropic tables need.
  [[nodiscard]] bool is_product() const;
  /// Whether table values are averages over the nodes' cells rather than values at the nodes.
  [[nodiscard]] bool has_cells() const { return kind_ != GridKind::gauss && kind_ != GridKind::uniform; }

  /// Number of nodes.
  [[nodiscard]] std::size_t nodes() const { return nodes_.size(); }
  /// Directions of all nodes, ring by ring.
  [[nodiscard]] std::span<const Direction> directions() const { return nodes_; }
  /// Projected solid angles of all nodes, sr.
  [[nodiscard]] std::span<const double> weights() const { return weights_; }
  /// Index of the node at phi + pi.
  [[nodiscard]] std::size_t opposite(std::size_t node) const;

  /// Index of the node whose cell contains a direction; on grids without cells, of the node nearest in azimuth on the
  /// ring that encloses theta.
  [[nodiscard]] std::size_t node_at(Direction direction) const;

  /// Rings from the normal to the horizon. On shirley_chiu grids a ring consists of the cells of a concentric square,
  /// whose centres lie on a circle; theta_low and theta_high are the circles onto which the map takes the sides of the
  /// square.
  [[nodiscard]] std::span<const Ring> rings() const { return rings_; }
  /// Index of the ring that a node is on.
  [[nodiscard]] std::size_t ring_of(std::size_t node) const { return ring_of_[node]; }

  /// Number of rings of a product grid.
  [[nodiscard]] std::size_t n_theta() const { return rings_.size(); }
  /// Number of azimuths of a product grid.
  [[nodiscard]] std::size_t n_phi() const { return rings_.front().count; }
  /// Number of azimuths from 0 to pi on a product grid, both ends included, as an even function needs.
  [[nodiscard]] std::size_t half_azimuths() const { return n_phi() / 2 + 1; }

  /// Directions that represent a node's cell with equal weights: points x points of them, stratified in sin^2(theta)
  /// and phi (or in the square). On grids without cells it is the node itself, whatever `points` is.
  [[nodiscard]] std::vector<Direction> cell_points(std::size_t node, std::size_t points) const;

  /// Makes the grid with twice the resolution in both coordinates, whose cells divide the cells of this one.
  [[nodiscard]] HemisphereGrid refined() const;

  /// Whether two grids divide the hemisphere in the same way.
  [[nodiscard]] bool operator==(const HemisphereGrid& other) const;

 private:
  HemisphereGrid() = default;
  void add_ring(double theta, double low, double high, double weight, std::size_t count, double phi_0);
  [[nodiscard]] static HemisphereGrid from_bands(std::size_t patches, std::span<const double> limits_deg,
                                                 std::span<const std::size_t> counts, std::size_t division);

  GridKind kind_ = GridKind::gauss;
  std::size_t side_ = 0;      ///< shirley_chiu: cells per side; klems: patches
  std::size_t division_ = 1;  ///< klems: parts that each patch was divided into, per coordinate
  std::vector<Direction> nodes_;
  std::vector<double> weights_;
  std::vector<Ring> rings_;
  std::vector<std::size_t> ring_of_;
};

}  // namespace lobe
