// Products of functions under patch lights: for each direction of the viewer the function is projected on the
// polynomials of the base plane, in which W, that acts on the light, is known.
#include <Eigen/Eigenvalues>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/parallel.hpp"
#include "core/stopwatch.hpp"
#include "hemisphere/disc_polynomials.hpp"
#include "hemisphere/patch_operator.hpp"
#include "hemisphere/patch_rule.hpp"
#include "hemisphere/refinement.hpp"
#include "lobe/core/error.hpp"
#include "metric/function_products.hpp"
#include "metric/function_sums.hpp"
#include "metric/function_values.hpp"

namespace lobe {
namespace {

using Eigen::Index;
using std::numbers::pi;

/// How finely a slab is integrated: level of the nodes of L, Gauss nodes per panel and axis of X beside those for the
/// degree, degree of the polynomials, and Gauss nodes between the radii of a density.
struct PatchLevel {
  int incident;
  int count;
  int degree;
  int radii;
};
// What is cut off of W falls at least with the first power of the degree, which doubles, so that beyond the last level
// it is at most the last difference.
constexpr std::array<PatchLevel, 4> kPatchLevels{{{0, 3, 16, 3}, {0, 4, 32, 4}, {1, 6, 64, 5}, {3, 8, 128, 7}}};

Index as_index(std::size_t i) {
  return static_cast<Index>(i);
}

/// W = S S^T in the polynomials of a degree, by order.
struct LightRoots {
  DiscPolynomials polynomials;
  std::vector<Eigen::MatrixXd> roots;  ///< S^T
  Index rows = 0;                      ///< of all roots, for cosines and for sines

  LightRoots(const Lighting& lighting, const PatchLevel& level) : polynomials(level.degree) {
    const auto matrices = patch_light_matrices(polynomials, light_discs(lighting.shares(level.radii)));
    roots.resize(matrices.size());
    parallel_for(matrices.size(), [&](std::size_t m) {
      const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> parts(matrices[m]);
      roots[m] = parts.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal() * parts.eigenvectors().transpose();
    });
    for (const auto& root : roots) rows += 2 * root.rows();
  }
};

/// A ring's azimuths: cos(m psi) and sin(m psi), times the node's factor, by order and node.
struct RingTables {
  Eigen::MatrixXd cosines, sines;

  RingTables(const PatchRing& ring, int orders)
      : cosines(orders, as_index(ring.nodes.size())), sines(orders, as_index(ring.nodes.size())) {
    for (std::size_t j = 0; j < ring.nodes.size(); ++j) {
      const auto& [psi, factor] = ring.nodes[j];
      const double slope = 2 * std::cos(psi);
      double cosine = factor;
      double sine = 0;
      double cosine_before = cosine * slope / 2;
      double sine_before = -cosine * std::sin(psi);
      for (int m = 0; m < orders; ++m) {
        cosines(m, as_index(j)) = cosine;
        sines(m, as_index(j)) = sine;
        cosine_before = std::exchange(cosine, slope * cosine - cosine_before);
        sine_before = std::exchange(sine, slope * sine - sine_before);
      }
    }
  }
};

class PatchIntegrator {
 public:
  PatchIntegrator(std::span<const BrdfFunction> functions, std::size_t channels, const Lighting& lighting,
                  const FunctionMetricOptions& options, WorkDone& work)
      : functions_(functions),
        channels_(channels),
        lighting_(lighting),
        options_(options),
        work_(work),
        rule_(LobeExtent{.width = options.lobe_width, .patch_radii = {}, .retro_patch_radii = {}}, lighting.radii(),
              false),
        lights_(kPatchLevels.size()) {}

  [[nodiscard]] std::size_t slabs() const { return rule_.slabs(); }

  [[nodiscard]] FunctionSums slab(std::size_t slab, std::size_t at) {
    const PatchLevel& level = kPatchLevels[at];
    if (!lights_[at]) lights_[at].emplace(lighting_, level);
    FunctionSums sums(channels_, functions_.size());
    const auto nodes = rule_.incident_nodes(slab, kNodesPerPanel[static_cast<std::size_t>(level.incident)]);
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      add(nodes[k], turn_of(placed_++, static_cast<int>(at)), level, *lights_[at], sums);
      if (options_.progress && !options_.progress(lighting_.name(), 0)) throw Cancelled("cancelled");
    }
    return sums;
  }

 private:
  /// The directions of light on all rings beside one of the viewer.
  struct Surroundings {
    const IncidentNode& viewer;
    double turn;  ///< where the azimuths begin, as a share of their step
    const std::vector<PatchRing>& rings;
    const std::vector<RingTables>& tables;
    std::vector<std::size_t> firsts;  ///< of each ring, among the nodes of all
    std::size_t nodes = 0;
  };

  void add(const IncidentNode& viewer, double turn, const PatchLevel& level, const LightRoots& light,
           FunctionSums& sums) {
    Stopwatch watch;
    const auto rings = rule_.gauss_rings(viewer.elevation, level.count, level.degree);
    std::vector<std::unique_ptr<RingTables>> made(rings.size());
    parallel_for(rings.size(),
                 [&](std::size_t r) { made[r] = std::make_unique<RingTables>(rings[r], light.polynomials.orders()); });
    std::vector<RingTables> tables;
    for (auto& table : made) tables.push_back(std::move(*table));
    Surroundings around{viewer, turn, rings, tables, {}, 0};
    Eigen::ArrayXd radii(as_index(rings.size()));
    for (std::size_t r = 0; r < rings.size(); ++r) {
      around.firsts.push_back(around.nodes);
      around.nodes += rings[r].nodes.size();
      radii(as_index(r)) = std::cos(rings[r].elevation);
    }
    // S^T R^T by order, from rings to rows.
    std::vector<Eigen::MatrixXd> along(light.roots.size());
    parallel_for(along.size(), [&](std::size_t m) {
      const auto order = static_cast<int>(m);
      along[m] = light.roots[m] * light.polynomials.radial(order, radii, radii.pow(order)).transpose();
    });
    work_.seconds_nodes += watch.lap();
    const double root = std::sqrt(viewer.weight);
    std::vector<FunctionColumns> columns(channels_, FunctionColumns(functions_, light.rows));
    for (std::size_t f = 0; f < functions_.size(); ++f) {
      const auto [value, error] = modes(functions_[f], around, along, light.rows);
      const Index azimuths = functions_[f].is_isotropic ? 1 : as_index(kFunctionAzimuths);
      const Index own = value.cols() / azimuths;
      for (std::size_t c = 0; c < channels_; ++c) {
        const Index first = (own == 1 ? 0 : as_index(c)) * azimuths;
        columns[c].set(f, root * value.middleCols(first, azimuths), root * error.middleCols(first, azimuths));
      }
    }
    for (std::size_t c = 0; c < channels_; ++c) columns[c].add_to(sums.gram[c], sums.square_error[c]);
    work_.seconds_gram += watch.lap();
  }

  /// Values of the function, or what they may be off, projected.
  struct Modes {
    Eigen::MatrixXd value, error;  ///< rows of S x (channel, azimuth)
  };

  [[nodiscard]] Modes modes(const BrdfFunction& function, const Surroundings& around,
                            const std::vector<Eigen::MatrixXd>& along, Index rows) {
    const bool is_even = function.is_isotropic && function.is_bilateral;
    const std::size_t sides = is_even ? 1 : 2;
    const std::size_t azimuths = function.is_isotropic ? 1 : kFunctionAzimuths;
    std::vector<Directions> pairs;
    pairs.reserve(around.nodes * sides * azimuths);
    const double theta = pi / 2 - around.viewer.elevation;
    for (const PatchRing& ring : around.rings) {
      const double theta_x = pi / 2 - ring.elevation;
      for (std::size_t a = 0; a < azimuths; ++a) {
        const double azimuth = 2 * pi * (static_cast<double>(a) + around.turn) / static_cast<double>(azimuths);
        for (std::size_t side = 0; side < sides; ++side) {
          for (const PatchNode& node : ring.nodes) {
            const double delta = side == 0 ? pi - node.psi : node.psi - pi;
            pairs.push_back({theta_x, theta, -delta, azimuth + delta});
          }
        }
      }
    }
    const BrdfValues samples = values_at(function, pairs);
    work_.nodes += pairs.size();
    work_.evaluations += pairs.size();
    Modes found;
    found.value = projected(samples.value, sides, azimuths, around, along, rows);
    found.error = (samples.error.array() == 0).all() ? Eigen::MatrixXd::Zero(found.value.rows(), found.value.cols())
                                                     : projected(samples.error, sides, azimuths, around, along, rows);
    return found;
  }

  /// \param samples (ring, azimuth, side, node) x channels
  static Eigen::MatrixXd projected(const Eigen::MatrixXd& samples, std::size_t sides, std::size_t azimuths,
                                   const Surroundings& around, const std::vector<Eigen::MatrixXd>& along, Index rows) {
    const Index columns = samples.cols() * as_index(azimuths);
    const Index rings = as_index(around.rings.size());
    std::vector<Eigen::MatrixXd> cosines(along.size(), Eigen::MatrixXd(rings, columns));
    std::vector<Eigen::MatrixXd> sines(sides == 2 ? along.size() : 0, Eigen::MatrixXd(rings, columns));
    parallel_for(around.rings.size(), [&](std::size_t r) {
      const Index nodes = as_index(around.rings[r].nodes.size());
      const Index first = as_index(around.firsts[r] * sides * azimuths);
      Eigen::MatrixXd even(nodes, columns);
      Eigen::MatrixXd odd(sides == 2 ? nodes : 0, columns);
      for (Index c = 0; c < samples.cols(); ++c) {
        for (Index a = 0; a < as_index(azimuths); ++a) {
          const Index column = c * as_index(azimuths) + a;
          const auto one = samples.col(c).segment(first + a * as_index(sides) * nodes, nodes);
          if (sides == 1) {
            even.col(column) = one;
            continue;
          }
          const auto other = samples.col(c).segment(first + (a * as_index(sides) + 1) * nodes, nodes);
          even.col(column) = 0.5 * (one + other);
          odd.col(column) = 0.5 * (one - other);
        }
      }
      const Eigen::MatrixXd of_cosines = around.tables[r].cosines * even;
      for (std::size_t m = 0; m < along.size(); ++m) cosines[m].row(as_index(r)) = of_cosines.row(as_index(m));
      if (sides == 1) return;
      const Eigen::MatrixXd of_sines = around.tables[r].sines * odd;
      for (std::size_t m = 0; m < along.size(); ++m) sines[m].row(as_index(r)) = of_sines.row(as_index(m));
    });
    Eigen::MatrixXd found = Eigen::MatrixXd::Zero(rows, columns);
    std::vector<Index> begins;
    Index begin = 0;
    for (const auto& part : along) {
      begins.push_back(begin);
      begin += 2 * part.rows();
    }
    parallel_for(along.size(), [&](std::size_t m) {
      found.middleRows(begins[m], along[m].rows()).noalias() = along[m] * cosines[m];
      if (sides == 1) return;
      found.middleRows(begins[m] + along[m].rows(), along[m].rows()).noalias() = along[m] * sines[m];
    });
    return found;
  }

  std::span<const BrdfFunction> functions_;
  std::size_t channels_;
  const Lighting& lighting_;
  const FunctionMetricOptions& options_;
  WorkDone& work_;
  PatchRule rule_;
  std::vector<std::optional<LightRoots>> lights_;
  std::size_t placed_ = 0;
};

}  // namespace

std::vector<ChannelProducts> integrate_function_patches(std::span<const BrdfFunction> functions, std::size_t channels,
                                                        const Lighting& lighting, const FunctionMetricOptions& options,
                                                        WorkDone& work) {
  PatchIntegrator integrator(functions, channels, lighting, options, work);
  const auto slabs = refined_slabs(integrator.slabs(), kPatchLevels.size(), options.tolerance,
                                   [&](std::size_t slab, std::size_t level) { return integrator.slab(slab, level); });
  std::vector<ChannelProducts> finished;
  for (std::size_t c = 0; c < channels; ++c) finished.push_back(finished_products(slabs, functions.size(), c));
  return finished;
}

}  // namespace lobe
