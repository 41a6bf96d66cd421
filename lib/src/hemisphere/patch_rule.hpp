#pragma once

#include <Eigen/Core>
#include <limits>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "hemisphere/albedo_rule.hpp"
#include "hemisphere/geometry.hpp"
#include "hemisphere/mirror_panels.hpp"

namespace lobe {

/// A rule for integrals over a panel of products of a smooth function, known at a few Gauss nodes, and a polynomial
/// that oscillates faster: the sum over j, k of f(node j) weights(j, k) g(fine node k). The smooth function is
/// interpolated; with as many nodes as fine ones this is the Gauss rule.
struct ProductPanel {
  PanelEdge low, high;
  std::size_t first;               ///< number of its first node among those of all panels
  const Eigen::MatrixXd* weights;  ///< nodes x fine nodes, of a panel of length 1; good as long as the PatchRule
  const GaussRule* fine;           ///< nodes of the polynomial

  /// All nodes are fine ones, and weights are diagonal.
  [[nodiscard]] bool is_gauss() const { return weights->rows() == weights->cols(); }
};

/// A direction X for one L on a ring: its azimuth psi in [0, pi] from the mirror side (radians), and its factor.
struct PatchNode {
  double psi, factor;
};

/// Directions X of one elevation above the horizon (radians), by panels of psi.
struct PatchRing {
  double elevation;
  ElevationPair pair;  ///< with that of L
  std::vector<PatchNode> nodes;
  std::vector<ProductPanel> panels;
};

/// Directions X for one L: rings of rising elevations, by panels.
struct PatchNodes {
  std::vector<PatchRing> rings;
  std::vector<ProductPanel> panels;
};

/// Quadrature of f1(L, X) W(X, Y) f2(L, Y) over L, X and Y for isotropic reflectances and the lighting W of patch
/// lights: what AlbedoRule is for the integral of a1 a2, with limits also where the discs of W touch the horizon.
class PatchRule {
 public:
  /// \param extent of the reflectances;
  /// \param light_radii of the patch lights, each in (0, 2]
  /// \param has_mirror_and_retro there are delta parts of both kinds: W between L and its mirror image counts, which is
  ///   not smooth in L where the discs of W about both part
  PatchRule(LobeExtent extent, const std::vector<double>& light_radii, bool has_mirror_and_retro);

  /// The rule for some of the lobes: as this one over L, by their extent over X.
  [[nodiscard]] PatchRule of(LobeExtent extent) const {
    PatchRule part = *this;
    part.extent_ = std::move(extent);
    part.extent_.common = CommonKinks::all();
    return part;
  }

  [[nodiscard]] std::size_t slabs() const { return outer_.slabs(); }
  /// Nodes in the elevation of L, as AlbedoRule::incident_nodes_of.
  [[nodiscard]] std::vector<IncidentNode> incident_nodes(std::size_t slab, int nodes_per_panel) const {
    return outer_.incident_nodes_of(slab, nodes_per_panel);
  }

  /// Directions X for one L: the sum over nodes of factor f(L, X), the weights of both panels and g at their fine nodes
  /// is the integral of f(L, X) g(X) dmu(X) for g even in the azimuth.
  /// \param count Gauss nodes per panel and axis
  /// \param degree of g, a polynomial of the base plane: as many fine nodes more as resolve it
  [[nodiscard]] PatchNodes place(double elevation, int count, int degree) {
    return place(elevation, count, degree, kMoreKnown);
  }

  /// Rings for functions that are not interpolated: as place(), with nodes as fine as those of the polynomials. The sum
  /// over nodes of factor f(L, X) g(X) is the integral.
  [[nodiscard]] std::vector<PatchRing> gauss_rings(double elevation, int count, int degree);

 private:
  /// Nodes that a lobe has in a panel beyond those of the level, of those that the polynomials have: an interpolation
  /// is less accurate than a quadrature with as many nodes.
  static constexpr int kMoreKnown = 6;
  static constexpr int kAllKnown = std::numeric_limits<int>::max();

  struct Rule {
    GaussRule fine;
    GaussRule nodes;
    Eigen::MatrixXd weights;
  };

  /// \param known nodes beyond those of the level at which the function is taken, at most
  [[nodiscard]] PatchNodes place(double elevation, int count, int degree, int known);
  /// The rule of a panel; it must be there.
  [[nodiscard]] const Rule& rule_of(const PanelEdge& low, const PanelEdge& high, int count, double degree,
                                    int known) const;

  LobeExtent extent_;
  std::vector<PanelEdge> light_edges_;
  AlbedoRule outer_;
  using Rules = std::map<std::pair<int, int>, Rule>;
  std::shared_ptr<Rules> rules_ = std::make_shared<Rules>();  ///< by their numbers of nodes, and of fine ones
};

}  // namespace lobe
