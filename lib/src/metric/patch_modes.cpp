#include "metric/patch_modes.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/parallel.hpp"
#include "device/accumulate_differences.hpp"
#include "device/accumulate_gram.hpp"
#include "device/buffers.hpp"
#include "device/error.hpp"
#include "device/implementation.hpp"
#include "device/tabulate_patch_light.hpp"
#include "energy/albedo_integrator.hpp"
#include "hemisphere/geometry.hpp"
#include "hemisphere/patch_operator.hpp"
#include "hemisphere/patch_response.hpp"
#include "hemisphere/refinement.hpp"
#include "hemisphere/row_tables.hpp"
#include "lobe/core/error.hpp"
#include "model/rule_groups.hpp"

namespace lobe {
namespace {

using std::numbers::pi;

/// Degree of the polynomials, and Gauss nodes between the radii of a density.
struct Degree {
  int degree;
  int radii;
};
constexpr std::array<Degree, 7> kDegrees{{{24, 3}, {36, 4}, {54, 5}, {80, 6}, {120, 7}, {180, 8}, {270, 8}}};

/// Gauss nodes per panel and axis of X, beside those for the degree. Rules of L have levels of their own, as many.
constexpr std::array<int, 9> kNodes{5, 6, 7, 8, 9, 10, 12, 14, 16};
static_assert(kNodes.size() == kNodesPerPanel.size());
/// The same for loose tolerances, where rules of L have the levels of kLooseNodesPerPanel.
constexpr std::array<int, 9> kLooseNodes{4, 5, 6, 7, 8, 10, 12, 14, 16};
static_assert(kLooseNodes.size() == kLooseNodesPerPanel.size());
constexpr double kLoosePatchTolerance = 1e-3;

constexpr std::size_t kLongestRing = 2048;  // nodes; the evaluator takes whole rings

Eigen::Index index(std::size_t i) {
  return static_cast<Eigen::Index>(i);
}

/// S with S S^T = W for W >= 0 of any rank, by eigenvalues: factors with pivots lose what they subtract where the rank
/// is small, as for discs larger than the unit disc.
/// \param rounding eigenvalues below are left out
Eigen::MatrixXd square_root(const Eigen::MatrixXd& w, double rounding) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(w);
  const Eigen::VectorXd& rising = solver.eigenvalues();
  const auto rank = std::max<Eigen::Index>(1, (rising.array() > rounding).count());
  const Eigen::VectorXd sizes = rising.tail(rank).cwiseMax(0).cwiseSqrt();
  return solver.eigenvectors().rightCols(rank) * sizes.asDiagonal();
}

static_assert(SegmentTable::kTile % kTableLanes == 0);

/// The map from the nodes of a ring to orders: integrals of l_j cos(m psi) for their Lagrange polynomials l_j.
/// \param stride of the table
void write_around(const PatchRing& ring, std::size_t stride, double* table) {
  RowMajorMatrix cosines;
  for (const ProductPanel& panel : ring.panels) {
    const auto& fine = panel.fine->nodes;
    const auto psi = [&](std::size_t k) { return panel_point(panel.low, panel.high, fine[k]).at; };
    double* const rows = table + panel.first * stride;
    if (panel.is_gauss()) {
      for (std::size_t k = 0; k < fine.size(); ++k) {
        write_cosines(psi(k), (*panel.weights)(index(k), index(k)), stride, rows + k * stride);
      }
      continue;
    }
    cosines.resize(index(fine.size()), index(stride));
    for (std::size_t k = 0; k < fine.size(); ++k) {
      write_cosines(psi(k), 1, stride, cosines.row(index(k)).data());
    }
    combine_rows(*panel.weights, cosines, rows);
  }
}

void write_table(SegmentTable& table, std::size_t segment, const Eigen::MatrixXd& values) {
  const auto stride = index(SegmentTable::padded(static_cast<std::size_t>(values.cols())));
  Eigen::Map<RowMajorMatrix>(table.table(segment), values.rows(), stride).leftCols(values.cols()) = values;
}

bool has_mirror_and_retro(const LobeSet& lobes) {
  const auto has = [&](DeltaKind kind) { return std::ranges::count(lobes.deltas, kind, &DeltaLobe::kind) > 0; };
  return has(DeltaKind::mirror) && has(DeltaKind::retro);
}

}  // namespace

PatchModes::PatchModes(const Device& device, const LobeSet& lobes, const Lighting& lighting, double tolerance,
                       WorkDone& work)
    : PatchModes(device, lobes, lighting, tolerance >= kLoosePatchTolerance && !lobes.has_fractional_edge, work,
                 PatchRule(given_extent(lobes, Given::viewer), lighting.radii(), has_mirror_and_retro(lobes)),
                 std::make_shared<Lights>(kDegrees.size())) {}

PatchModes::PatchModes(const Device& device, const LobeSet& lobes, const Lighting& lighting, bool is_loose,
                       WorkDone& work, PatchRule rule, std::shared_ptr<Lights> lights)
    : lobes_(lobes),
      lighting_(lighting),
      is_loose_(is_loose),
      device_(device),
      rule_(std::move(rule)),
      map_(device),
      work_(work),
      lobe_rows_(lobes.lobes()),
      delta_shares_(device, lobes.deltas),
      lights_(std::move(lights)) {
  const std::size_t width = device.implementation().pack_width;
  for (const RuleGroup& chosen : rule_groups(lobes)) {
    std::vector<LobeBatch> batches;
    for (const std::size_t b : chosen.batches) batches.push_back(lobes.batches[b]);
    LobeEvaluator evaluator(device, batches, Precision::double_precision,
                            std::max(kLongestRing, LobeEvaluator::suggested_capacity(chosen.lobes.size())));
    const auto& rows = evaluator.rows();
    for (std::size_t k = 0; k < rows.size(); ++k) {
      lobe_rows_[static_cast<std::size_t>(chosen.lobes[k])] = delta_pack_ * width + rows[k];
    }
    const std::size_t packs = rows.back() / width + 1;  // the evaluator's last ones may be empty
    NodeBlock block(evaluator.node_stride());
    PackedRows orders{{}, 0, packs, width};
    groups_.push_back({chosen.lobes, rule_.of(extent_of_group(lobes, chosen.number, Given::viewer)),
                       std::move(evaluator), std::move(block), delta_pack_, std::move(orders)});
    delta_pack_ += packs;
  }
  for (std::size_t k = 0; k < lobes.deltas.size(); ++k) {
    lobe_rows_[lobes.smooth_lobes() + k] = delta_pack_ * width + k;
  }
  const std::size_t delta_packs = (lobes.deltas.size() + width - 1) / width;
  modes_ = {{}, 0, delta_pack_ + delta_packs, width};
  rows_ = modes_;
  rows_.packs = (rows_.packs + 2) / 3 * 3;  // as Gram matrices read them
  rows_below_ = rows_;
}

std::size_t PatchModes::degrees() {
  return kDegrees.size();
}

std::size_t PatchModes::rules() {
  return kNodes.size();
}

int PatchModes::nodes_of_x(std::size_t rule) const {
  return is_loose_ ? kLooseNodes[rule] : kNodes[rule];
}

std::vector<IncidentNode> PatchModes::incident_nodes(std::size_t slab, std::size_t rule) const {
  return rule_.incident_nodes(slab, is_loose_ ? kLooseNodesPerPanel[rule] : kNodesPerPanel[rule]);
}

PatchModes::Light& PatchModes::light(std::size_t degree) {
  auto& known = (*lights_)[degree];
  if (known) return *known;
  const DiscPolynomials polynomials(kDegrees[degree].degree);
  Light made{polynomials, patch_light_matrices(polynomials, light_discs(lighting_.shares(kDegrees[degree].radii))),
             {},          DiscNodes(kDegrees[degree].degree),
             {},          std::nullopt};
  made.square_roots.resize(made.matrices.size());
  const double rounding = 1e-15 * made.matrices[0].diagonal().maxCoeff();
  parallel_for(made.matrices.size(),
               [&](std::size_t m) { made.square_roots[m] = square_root(made.matrices[m], rounding); });
  made.roots = make_roots(made, made.nodes);
  known = std::move(made);
  return *known;
}

const PatchModes::Roots& PatchModes::roots_below(std::size_t degree) {
  Light& own = light(degree);
  if (!own.roots_below) own.roots_below = make_roots(light(degree - 1), own.nodes);
  return *own.roots_below;
}

PatchModes::Roots PatchModes::make_roots(const Light& light, const DiscNodes& nodes) const {
  Roots made;
  for (std::size_t m = 0; m < light.square_roots.size(); ++m) {
    const int order = static_cast<int>(m);
    const auto rank = static_cast<std::size_t>(light.square_roots[m].cols());
    const Eigen::ArrayXd radii = nodes.radii().head(nodes.count(order));
    const Eigen::MatrixXd values = light.polynomials.radial(order, radii, radii.pow(order)) * light.square_roots[m];
    write_table(made.table,
                made.table.add(static_cast<std::size_t>(nodes.first(order)), 1, static_cast<std::size_t>(radii.size()),
                               made.columns, rank),
                values);
    made.columns += rank;
  }
  made.placed = map_.place(made.table);
  return made;
}

void PatchModes::grow(PackedRows& rows, std::size_t columns) const {
  rows.stride = columns;
  const std::size_t count = rows.packs * rows.width * columns;
  if (count == 0) return;
  checked("cannot prepare patch lights", [&] {
    if (rows.values() != nullptr && rows.values.getInfo<CL_MEM_SIZE>() >= count * sizeof(double)) return;
    rows.values = make_workspace(device_, count * sizeof(double));
    clear(device_, rows.values, count);  // so that the padding is finite
  });
}

void PatchModes::evaluate_orders(Group& group, std::span<const PatchRing> rings, const DiscPolynomials& polynomials) {
  const auto columns = static_cast<std::size_t>(polynomials.orders());
  NodeBlock& block = group.block;
  grow(group.orders, rings.size() * columns);
  for (std::size_t first = 0; first < rings.size();) {
    SegmentTable& around = around_[around_turn_];
    around_turn_ = 1 - around_turn_;
    block.clear();
    around.clear();
    std::size_t end = first;
    while (end < rings.size() && block.size() + rings[end].nodes.size() <= block.capacity()) {
      const int orders = orders_at(polynomials.degree(), std::cos(rings[end].elevation));
      around.add(block.size(), 1, rings[end].nodes.size(), end * columns, static_cast<std::size_t>(orders));
      block.extend(rings[end].nodes.size());
      ++end;
    }
    if (end == first) {
      throw NumericError("patch lights: a ring of directions has " + std::to_string(rings[first].nodes.size()) +
                         " nodes; expected at most " + std::to_string(block.capacity()) +
                         ", as for fewer patches of different radii in one material");
    }
    parallel_for(end - first, [&](std::size_t k) {
      const PatchRing& ring = rings[first + k];
      const MapSegment& segment = around.segments()[k];
      for (std::size_t j = 0; j < ring.nodes.size(); ++j) {
        place_node(block, segment.source + j, ring.pair, ring.nodes[j].psi, ring.nodes[j].factor);
      }
      complete_nodes(block, segment.source, ring.nodes.size());
      write_around(ring, segment.stride, around.table(k));
    });
    if (lobes_.both_orders) block.exchange_directions();
    work_.seconds_nodes += watch_.lap();
    group.evaluator.evaluate(block);  // waits until the device has done what it was given before
    map_.apply(group.evaluator.values(), group.orders, group.orders.packs, map_.place(around));
    work_.seconds_values += watch_.lap();
    work_.nodes += block.size();
    work_.evaluations += block.size() * group.lobes.size();
    first = end;
  }
}

void PatchModes::write_along(const Group& group, const PatchNodes& placed, double weight, const Light& lit) {
  const auto& polynomials = lit.polynomials;
  const auto& rings = placed.rings;
  const auto count = static_cast<std::size_t>(lit.nodes.radii().size());
  // Those with the most orders come first.
  std::vector<int> orders(rings.size());
  std::ranges::transform(rings, orders.begin(), [&](const PatchRing& ring) {
    return orders_at(polynomials.degree(), std::cos(ring.elevation));
  });
  along_.clear();
  for (int m = 0; m < polynomials.orders(); ++m) {
    const auto in = static_cast<std::size_t>(
        std::ranges::partition_point(orders, [&](int of_ring) { return of_ring > m; }) - orders.begin());
    const auto step = static_cast<std::size_t>(polynomials.orders());
    const std::size_t target = group.first_pack * modes_.stride + static_cast<std::size_t>(lit.nodes.first(m));
    const auto columns = static_cast<std::size_t>(lit.nodes.count(m));
    if (m < 2) {
      along_.add(static_cast<std::size_t>(m), step, rings.size(), target, count);
    } else {
      along_.add_as(static_cast<std::size_t>(m % 2), static_cast<std::size_t>(m), step, in, target, columns);
    }
  }
  parallel_for(2, [&](std::size_t parity) {
    const std::size_t stride = along_.segments()[parity].stride;
    double* const table = along_.table(parity);
    RowMajorMatrix at_fine;
    for (const ProductPanel& panel : placed.panels) {
      Eigen::ArrayXd radii(index(panel.fine->nodes.size()));
      for (Eigen::Index k = 0; k < radii.size(); ++k) {
        radii(k) = std::cos(panel_point(panel.low, panel.high, panel.fine->nodes[static_cast<std::size_t>(k)]).at);
      }
      at_fine.setZero(radii.size(), index(stride));
      at_fine.leftCols(index(count)) = std::sqrt(weight) * lit.nodes.interpolation(radii, parity == 1);
      if (panel.is_gauss()) {
        Eigen::Map<RowMajorMatrix>(table + panel.first * stride, radii.size(), index(stride)) =
            panel.weights->diagonal().asDiagonal() * at_fine;
      } else {
        combine_rows(*panel.weights, at_fine, table + panel.first * stride);
      }
    }
  });
}

Eigen::MatrixXd PatchModes::delta_shares(std::span<const IncidentNode> incident) {
  std::vector<double> elevations;
  for (const IncidentNode& node : incident) elevations.push_back(node.elevation);
  return delta_shares_.at(elevations);
}

/// A delta part is interpolated at the nodes from its direction.
void PatchModes::write_deltas(const IncidentNode& incident, const Eigen::VectorXd& shares, const Light& lit) {
  if (lobes_.deltas.empty()) return;
  const std::size_t width = modes_.width;
  const std::size_t packs = (lobes_.deltas.size() + width - 1) / width;
  const auto columns = static_cast<std::size_t>(lit.nodes.size());
  std::vector<double> values(packs * columns * width, 0.0);
  const Eigen::ArrayXd at = Eigen::ArrayXd::Constant(1, std::cos(incident.elevation));
  const std::array<Eigen::MatrixXd, 2> at_nodes{lit.nodes.interpolation(at, false), lit.nodes.interpolation(at, true)};
  for (int m = 0; m < lit.polynomials.orders(); ++m) {
    const auto& weights = at_nodes[static_cast<std::size_t>(m % 2)];
    for (std::size_t k = 0; k < lobes_.deltas.size(); ++k) {
      const double sign = lobes_.deltas[k].kind == DeltaKind::retro && m % 2 == 1 ? -1 : 1;  // cos(m pi)
      const double size = sign * shares(index(k)) * std::sqrt(incident.weight);
      for (int j = 0; j < lit.nodes.count(m); ++j) {
        const auto column = static_cast<std::size_t>(lit.nodes.first(m) + j);
        values[(k / width * columns + column) * width + k % width] = size * weights(0, j);
      }
    }
  }
  checked("cannot place delta parts", [&] {
    device_.implementation().queue.enqueueWriteBuffer(modes_.values, CL_TRUE,
                                                      delta_pack_ * columns * width * sizeof(double),
                                                      values.size() * sizeof(double), values.data());
  });
}

template <typename Use>
void PatchModes::visit(std::size_t slab, ModeLevel level, const Use& use) {
  const FinishOnFailure finish_tables(device_);
  watch_.lap();
  Light& lit = light(level.degree);
  const auto& polynomials = lit.polynomials;
  grow(modes_, static_cast<std::size_t>(lit.nodes.size()));
  work_.seconds_host += watch_.lap();
  const auto nodes = incident_nodes(slab, level.rule);
  const Eigen::MatrixXd shares = delta_shares(nodes);
  for (std::size_t at = 0; at < nodes.size(); ++at) {
    const IncidentNode& incident = nodes[at];
    for (Group& group : groups_) {
      const auto placed = group.rule.place(incident.elevation, nodes_of_x(level.rule), polynomials.degree());
      evaluate_orders(group, placed.rings, polynomials);
      write_along(group, placed, incident.weight, lit);
      map_.apply(group.orders, modes_, group.orders.packs, map_.place(along_));
      work_.seconds_nodes += watch_.lap();
    }
    write_deltas(incident, shares.col(index(at)), lit);
    use();
    work_.seconds_values += watch_.lap();
  }
  finish(device_);
  work_.seconds_gram += watch_.lap();
}

Eigen::MatrixXd PatchModes::products(std::size_t slab, ModeLevel level) {
  const FinishOnFailure finish_roots(device_);
  const Roots& roots = light(level.degree).roots;
  grow(rows_, roots.columns);
  GramAccumulator gram(device_, rows_, 0, rows_.rows());
  visit(slab, level, [&] {
    map_.apply(modes_, rows_, modes_.packs, roots.placed);
    gram.add(rows_.stride);
  });
  return products_of(gram, slab, level);
}

std::array<Eigen::MatrixXd, 2> PatchModes::products_of_two_degrees(std::size_t slab, ModeLevel level) {
  const FinishOnFailure finish_roots(device_);
  const Roots& roots = light(level.degree).roots;
  const Roots& below = roots_below(level.degree);
  grow(rows_, roots.columns);
  grow(rows_below_, below.columns);
  GramAccumulator gram(device_, rows_, 0, rows_.rows());
  GramAccumulator gram_below(device_, rows_below_, 0, rows_below_.rows());
  visit(slab, level, [&] {
    map_.apply(modes_, rows_, modes_.packs, roots.placed);
    gram.add(rows_.stride);
    map_.apply(modes_, rows_below_, modes_.packs, below.placed);
    gram_below.add(rows_below_.stride);
  });
  return {products_of(gram_below, slab, {level.degree - 1, level.rule}), products_of(gram, slab, level)};
}

Eigen::MatrixXd PatchModes::products_of(GramAccumulator& gram, std::size_t slab, ModeLevel level) {
  const auto sums = gram.take();
  const auto n = index(lobes_.lobes());
  Eigen::MatrixXd products(n, n);
  for (Eigen::Index j = 0; j < n; ++j) {
    for (Eigen::Index i = 0; i <= j; ++i) {
      const std::size_t a = lobe_rows_[static_cast<std::size_t>(i)];
      const std::size_t b = lobe_rows_[static_cast<std::size_t>(j)];
      products(i, j) = products(j, i) = sums(index(std::min(a, b)), index(std::max(a, b)));
    }
  }
  const auto deltas = index(lobes_.deltas.size());
  if (deltas > 0) products.bottomRightCorner(deltas, deltas) += missing_from_deltas(slab, level);
  return products;
}

Eigen::VectorXd PatchModes::squares(std::size_t slab, ModeLevel level,
                                    const Eigen::SparseMatrix<double, Eigen::RowMajor>& combinations) {
  std::vector<Combination> terms(static_cast<std::size_t>(combinations.rows()));
  for (Eigen::Index e = 0; e < combinations.rows(); ++e) {
    for (Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator term(combinations, e); term; ++term) {
      terms[static_cast<std::size_t>(e)].terms.emplace_back(lobe_rows_[static_cast<std::size_t>(term.col())],
                                                            term.value());
    }
  }
  const FinishOnFailure finish_roots(device_);
  const Roots& roots = light(level.degree).roots;
  grow(rows_, roots.columns);
  DifferenceAccumulator accumulator(device_, rows_, terms);
  visit(slab, level, [&] {
    map_.apply(modes_, rows_, modes_.packs, roots.placed);
    accumulator.add(rows_.stride);
  });
  const auto sums = accumulator.take();
  Eigen::VectorXd squares = Eigen::Map<const Eigen::VectorXd>(sums.data(), index(sums.size()));
  const auto deltas = index(lobes_.deltas.size());
  if (deltas > 0) {
    const Eigen::MatrixXd share = combinations.rightCols(deltas);
    squares += (share * missing_from_deltas(slab, level)).cwiseProduct(share).rowwise().sum();
  }
  return squares;
}

Eigen::MatrixXd PatchModes::missing_from_deltas(std::size_t slab, ModeLevel level) {
  const Light& lit = light(level.degree);
  const auto discs = light_discs(lighting_.shares(kDegrees[level.degree].radii));
  const auto& deltas = lobes_.deltas;
  const auto n = index(deltas.size());
  Eigen::MatrixXd missing = Eigen::MatrixXd::Zero(n, n);
  PatchLight opposite(device_, discs);
  const auto nodes = incident_nodes(slab, level.rule);
  const Eigen::MatrixXd shares = delta_shares(nodes);
  for (std::size_t at_node = 0; at_node < nodes.size(); ++at_node) {
    const IncidentNode& incident = nodes[at_node];
    const double radius = std::cos(incident.elevation);
    double same = 0;
    for (const auto& [disc, factor] : discs) same += factor * lens_area(radius, disc);
    DiscPoints mirror;
    mirror.push(radius, 0);
    DiscPoints retro;
    retro.push(radius, pi);
    opposite.place(mirror, retro);
    std::vector<double> across(opposite.stride());
    opposite.tabulate(0, 1, across);
    const Eigen::ArrayXd at = Eigen::ArrayXd::Constant(1, radius);
    double same_modes = 0;
    double across_modes = 0;
    for (int m = 0; m < lit.polynomials.orders(); ++m) {
      const Eigen::RowVectorXd values = lit.polynomials.radial(m, at, at.pow(m));
      const double part = values * lit.matrices[static_cast<std::size_t>(m)] * values.transpose();
      same_modes += part;
      across_modes += m % 2 == 1 ? -part : part;
    }
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index j = 0; j < n; ++j) {
        const bool is_same = deltas[static_cast<std::size_t>(i)].kind == deltas[static_cast<std::size_t>(j)].kind;
        const double share = shares(i, index(at_node)) * shares(j, index(at_node));
        missing(i, j) += incident.weight * share * (is_same ? same - same_modes : across[0] - across_modes);
      }
    }
  }
  return missing;
}

}  // namespace lobe
