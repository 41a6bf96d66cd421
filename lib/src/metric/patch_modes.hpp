#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/stopwatch.hpp"
#include "device/accumulate_gram.hpp"
#include "device/evaluate_lobes.hpp"
#include "device/map_segments.hpp"
#include "device/node_block.hpp"
#include "device/packed_rows.hpp"
#include "hemisphere/disc_nodes.hpp"
#include "hemisphere/disc_polynomials.hpp"
#include "hemisphere/patch_rule.hpp"
#include "lobe/device/device.hpp"
#include "metric/products.hpp"
#include "model/delta_shares.hpp"

namespace lobe {

/// How finely a slab is integrated.
struct ModeLevel {
  std::size_t degree = 0;  ///< of the polynomials, below PatchModes::degrees()
  std::size_t rule = 0;    ///< nodes of L and X, below PatchModes::rules()
};

/// Products of lobes under patch lights by polynomials phi of the base plane: for each L the lobes are projected on
/// them, f_mk = integral of f(L, X) phi_mk(X) dX, and f . g is the sum of f_mk W_kl g_ml over m, k, l and L. (Among
/// lobes that are not reciprocal f(X, L) stands for f(L, X): X is the light, on which W acts.) W falls
/// with the third power of the degree, and what is cut off from a product has to be there in both lobes: a narrow lobe
/// needs a high degree beside other narrow lobes only.
class PatchModes {
 public:
  /// The lobes stay where they are, here and below.
  /// \param tolerance of products; loose ones begin with coarser rules, but for profiles that end as fractional powers
  PatchModes(const Device& device, const LobeSet& lobes, const Lighting& lighting, double tolerance, WorkDone& work);

  /// Some of the lobes at the same nodes.
  /// \param lobes of the same extent
  [[nodiscard]] PatchModes of(const LobeSet& lobes) const {
    return PatchModes(device_, lobes, lighting_, is_loose_, work_, rule_, lights_);
  }

  [[nodiscard]] std::size_t slabs() const { return rule_.slabs(); }
  [[nodiscard]] static std::size_t degrees();
  [[nodiscard]] static std::size_t rules();

  /// Products of lobes over one slab, lobes x lobes, symmetric.
  [[nodiscard]] Eigen::MatrixXd products(std::size_t slab, ModeLevel level);

  /// The same at the degree below and at this one, of which the former costs little: its polynomials are among these.
  /// \param level of a degree above 0
  [[nodiscard]] std::array<Eigen::MatrixXd, 2> products_of_two_degrees(std::size_t slab, ModeLevel level);

  /// Squared norms of combinations of lobes over one slab.
  /// \param combinations combinations x lobes
  [[nodiscard]] Eigen::VectorXd squares(std::size_t slab, ModeLevel level,
                                        const Eigen::SparseMatrix<double, Eigen::RowMajor>& combinations);

 private:
  /// From nodes to rows: S times the polynomials at the nodes.
  struct Roots {
    SegmentTable table;
    DeviceSegments placed;
    std::size_t columns = 0;  ///< of S
  };

  /// The polynomials of a degree and W = S S^T in them. Lobes are not projected on each of the polynomials, but on
  /// those that are 1 at one of the nodes and 0 at the others: these do not depend on L.
  struct Light {
    DiscPolynomials polynomials;
    std::vector<Eigen::MatrixXd> matrices;      ///< W, by order
    std::vector<Eigen::MatrixXd> square_roots;  ///< S
    DiscNodes nodes;
    Roots roots;
    std::optional<Roots> roots_below;  ///< of the degree below, from the nodes of this one; once they are wanted
  };
  using Lights = std::vector<std::optional<Light>>;

  /// Lobes that take one rule over X, sampled together.
  struct Group {
    std::vector<Eigen::Index> lobes;  ///< columns of the lobe set
    PatchRule rule;
    LobeEvaluator evaluator;
    NodeBlock block;
    std::size_t first_pack;  ///< in modes_
    PackedRows orders;       ///< integrals of f(L, X) cos(m psi) over psi: column ring * orders + m
  };

  PatchModes(const Device& device, const LobeSet& lobes, const Lighting& lighting, bool is_loose, WorkDone& work,
             PatchRule rule, std::shared_ptr<Lights> lights);

  /// Gauss nodes of X per panel and axis.
  [[nodiscard]] int nodes_of_x(std::size_t rule) const;
  [[nodiscard]] std::vector<IncidentNode> incident_nodes(std::size_t slab, std::size_t rule) const;
  Light& light(std::size_t degree);
  const Roots& roots_below(std::size_t degree);
  /// Those of a light's polynomials, from nodes of that degree or a higher one.
  [[nodiscard]] Roots make_roots(const Light& light, const DiscNodes& nodes) const;
  /// For each L of a slab f sqrt(weight) of all lobes at the nodes.
  /// \param use called when they are there
  template <typename Use>
  void visit(std::size_t slab, ModeLevel level, const Use& use);
  void evaluate_orders(Group& group, std::span<const PatchRing> rings, const DiscPolynomials& polynomials);
  /// The table that takes orders to nodes.
  void write_along(const Group& group, const PatchNodes& placed, double weight, const Light& lit);
  /// \param shares that the delta parts reflect from there
  void write_deltas(const IncidentNode& incident, const Eigen::VectorXd& shares, const Light& lit);
  /// That, deltas x nodes.
  [[nodiscard]] Eigen::MatrixXd delta_shares(std::span<const IncidentNode> incident);
  /// Part that the products of delta parts lack at a degree, deltas x deltas: their W is known.
  [[nodiscard]] Eigen::MatrixXd missing_from_deltas(std::size_t slab, ModeLevel level);
  void grow(PackedRows& rows, std::size_t columns) const;
  /// The products of lobes that have been summed up, and what those of delta parts lack.
  [[nodiscard]] Eigen::MatrixXd products_of(GramAccumulator& gram, std::size_t slab, ModeLevel level);

  const LobeSet& lobes_;
  const Lighting& lighting_;
  bool is_loose_;
  Device device_;
  PatchRule rule_;  ///< over L
  std::vector<Group> groups_;
  SegmentMap map_;
  WorkDone& work_;
  Stopwatch watch_;
  std::vector<std::size_t> lobe_rows_;  ///< packed row of each lobe; those of delta parts come last
  std::size_t delta_pack_ = 0;          ///< the first of delta parts
  PackedRows modes_;                    ///< f_m at the nodes, times sqrt(weight of L)
  PackedRows rows_, rows_below_;        ///< f S sqrt(weight of L), and that of the degree below
  /// From nodes to orders: the host writes one while the device reads the other. Of `along_` one is enough, as nodes of
  /// a group are evaluated before it is written again.
  std::array<SegmentTable, 2> around_;
  std::size_t around_turn_ = 0;
  SegmentTable along_;  ///< from orders to nodes
  DeltaShares delta_shares_;
  std::shared_ptr<Lights> lights_;  ///< by degree
};

}  // namespace lobe
