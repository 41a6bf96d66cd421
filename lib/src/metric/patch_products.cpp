// Products under patch lights: for each L the samples F of all lobes at directions X, and W between these, F W F^T.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "core/stopwatch.hpp"
#include "device/accumulators.hpp"
#include "device/matrix_product.hpp"
#include "device/patch_light.hpp"
#include "hemisphere/geometry.hpp"
#include "hemisphere/patch_response.hpp"
#include "hemisphere/patch_rule.hpp"
#include "metric/products.hpp"

namespace lobe {
namespace {

using std::numbers::pi;
using RowMajorMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr std::size_t kLargestLightBytes = std::size_t{32} << 20;  // of W at a time

/// Gauss nodes per panel and axis of X, between the radii of a density, and level of the rule of L.
struct PatchLevel {
  int nodes;
  int radii;
  int incident;
};
constexpr std::array<PatchLevel, 6> kPatchLevels{{{3, 2, 0}, {4, 3, 0}, {5, 4, 0}, {6, 5, 1}, {8, 6, 1}, {10, 8, 2}}};

/// W has a cone where X meets X, of which a rule with nodes a distance h apart makes an error of h^3. For lobes at
/// least this wide it is taken away: the sum over X' of W(X, X') f(X') is right for constant f. Narrower lobes have
/// nodes as dense as they are narrow, and would magnify the errors that W has far from X.
constexpr double kWideLobe = 0.05;

/// What is known of the lobes (or combinations of them) at the directions X of one L.
struct LobeRows {
  Eigen::MatrixXd samples;   ///< factor f(X), rows x X; delta parts at X of factor 0
  Eigen::MatrixXd wide;      ///< the same of the wide lobes only, without delta parts
  Eigen::MatrixXd delta;     ///< share of delta parts, rows x deltas
  Eigen::MatrixXd at_delta;  ///< f of the wide lobes in the directions of delta parts, rows x deltas
};

class PatchIntegrator {
 public:
  PatchIntegrator(const Device& device, const LobeSet& lobes, const Lighting& lighting, Work& work)
      : lobes_(lobes),
        lighting_(lighting),
        rule_({lobes.narrowest, lobes.patch_radii, false}, lighting.radii()),
        sampler_(device, lobes.batches, Precision::double_precision, Sampler::suggested_capacity(lobes.lobes())),
        block_(sampler_.node_stride()),
        work_(work) {
    for (const PatchLevel& level : kPatchLevels)
      lights_.emplace_back(device, light_discs(lighting.shares(level.radii)));
  }

  [[nodiscard]] std::size_t slabs() const { return rule_.slabs(); }

  /// Products of lobes over one slab, lobes x lobes, symmetric.
  Eigen::MatrixXd products(std::size_t slab, std::size_t level) {
    const auto n = static_cast<Eigen::Index>(lobes_.lobes());
    Eigen::MatrixXd half = Eigen::MatrixXd::Zero(n, n);
    visit(slab, level, [&](double weight, const LobeRows& rows) {
      for_each_block(rows, level, [&](Eigen::Index first, Eigen::Index count, const RowMajorMatrix& lit) {
        half.noalias() += weight * rows.samples.middleCols(first, count) * lit;
      });
      half.noalias() += 0.5 * weight * rows.wide * cone_.asDiagonal() * rows.wide.transpose();
      half.noalias() += weight * rows.delta * delta_cone_.asDiagonal() * rows.at_delta.transpose();
    });
    return half + half.transpose();
  }

  /// Squared norms of combinations of lobes over one slab. \param combinations combinations x lobes
  Eigen::VectorXd squares(std::size_t slab, std::size_t level,
                          const Eigen::SparseMatrix<double, Eigen::RowMajor>& combinations) {
    Eigen::VectorXd half = Eigen::VectorXd::Zero(combinations.rows());
    visit(slab, level, [&](double weight, const LobeRows& lobes) {
      const LobeRows rows{combinations * lobes.samples, combinations * lobes.wide, combinations * lobes.delta,
                          combinations * lobes.at_delta};
      for_each_block(rows, level, [&](Eigen::Index first, Eigen::Index count, const RowMajorMatrix& lit) {
        half += weight * rows.samples.middleCols(first, count).cwiseProduct(lit.transpose()).rowwise().sum();
      });
      half += 0.5 * weight * rows.wide.cwiseAbs2() * cone_;
      half += weight * rows.delta.cwiseProduct(rows.at_delta) * delta_cone_;
    });
    return 2 * half;
  }

 private:
  /// Calls back with the weight of each L of a slab and what is known of the lobes there.
  template <typename Use>
  void visit(std::size_t slab, std::size_t level, const Use& use) {
    watch_.lap();
    for (const IncidentNode& incident : rule_.incident_nodes(slab, kPatchLevels[level].incident)) {
      place(incident.elevation, kPatchLevels[level].nodes);
      work_.seconds_nodes += watch_.lap();
      const LobeRows rows = sample(lights_[level].stride_of(points_.size()));
      work_.seconds_samples += watch_.lap();
      prepare_cone(level);
      use(incident.weight, rows);
      work_.seconds_gram += watch_.lap();
    }
  }

  /// Directions X, at last those of the delta parts, as nodes and as points of the base plane.
  void place(double elevation, int count) {
    nodes_.clear();
    points_ = {};
    factors_.clear();
    for (const PatchNode& x : rule_.place(elevation, count)) {
      nodes_.push_back(x.node);
      points_.push(std::cos(x.elevation), x.psi);
      factors_.push_back(x.node[NodeBlock::factor]);
    }
    for (const DeltaKind kind : lobes_.deltas) {
      const double psi = kind == DeltaKind::mirror ? 0 : pi;
      nodes_.push_back(node_of_elevations(elevation, elevation, psi, 1));
      points_.push(std::cos(elevation), psi);
      factors_.push_back(0);
    }
    work_.nodes += nodes_.size();
  }

  LobeRows sample(std::size_t stride) {
    const auto n = static_cast<Eigen::Index>(lobes_.lobes());
    const auto smooth = static_cast<Eigen::Index>(lobes_.smooth_lobes());
    const auto deltas = n - smooth;
    const auto count = static_cast<Eigen::Index>(nodes_.size()) - deltas;
    LobeRows rows{
        Eigen::MatrixXd::Zero(n, static_cast<Eigen::Index>(stride)), {}, Eigen::MatrixXd::Zero(n, deltas), {}};
    for (std::size_t first = 0; first < nodes_.size(); first += block_.capacity()) {
      block_.clear();
      for (std::size_t k = first; k < nodes_.size() && !block_.full(); ++k) block_.push(nodes_[k]);
      sampler_.sample(block_);
      rows.samples.block(0, static_cast<Eigen::Index>(first), smooth, static_cast<Eigen::Index>(block_.size())) =
          read_samples(sampler_, block_.size());
    }
    work_.evaluations += nodes_.size() * lobes_.smooth_lobes();
    rows.at_delta = rows.samples.middleCols(count, deltas);
    rows.samples.rightCols(rows.samples.cols() - count).setZero();
    rows.wide = rows.samples;
    for (Eigen::Index lobe = 0; lobe < smooth; ++lobe) {
      if (lobes_.widths[static_cast<std::size_t>(lobe)] >= kWideLobe) continue;
      rows.wide.row(lobe).setZero();
      rows.at_delta.row(lobe).setZero();
    }
    for (Eigen::Index k = 0; k < deltas; ++k) rows.samples(smooth + k, count + k) = rows.delta(smooth + k, k) = 1;
    return rows;
  }

  /// What W misses of its response at every X; the sums over X' come with the blocks of W.
  void prepare_cone(std::size_t level) {
    const auto stride = static_cast<Eigen::Index>(lights_[level].stride_of(points_.size()));
    cone_ = Eigen::VectorXd::Zero(stride);
    delta_cone_ = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(lobes_.deltas.size()));
    const auto shares = lighting_.shares(kPatchLevels.back().radii);
    double last_radius = -1;
    double response = 0;
    for (std::size_t k = 0; k < points_.size(); ++k) {
      if (points_.radius[k] != last_radius) {  // many X share a ring
        last_radius = points_.radius[k];
        response = light_response(shares, last_radius);
      }
      cone_(static_cast<Eigen::Index>(k)) = response;
    }
  }

  /// Calls back with blocks of X, half of W there times the transposed rows: each pair of blocks of W occurs once.
  template <typename Use>
  void for_each_block(const LobeRows& rows, std::size_t level, const Use& use) {
    PatchLight& light = lights_[level];
    light.place(points_, points_);
    const std::size_t stride = light.stride();
    const std::size_t count = points_.size();
    const auto columns = static_cast<std::size_t>(rows.samples.rows());
    const std::size_t height = std::max<std::size_t>(8, kLargestLightBytes / (stride * sizeof(double)) / 8 * 8);
    const Eigen::Map<const Eigen::VectorXd> factors(factors_.data(), static_cast<Eigen::Index>(count));
    const std::vector<double> ones(stride, 1.0);
    for (std::size_t first = 0; first < count; first += height) {
      const std::size_t size = std::min(height, count - first);
      const std::size_t depth = stride - first;
      values_.resize(size * stride);
      light.tabulate(first, size, first, true, values_);
      // Blocks beyond the diagonal one stand for two.
      for (std::size_t k = 0; k < size; ++k) {
        double* const row = values_.data() + k * stride;
        const Eigen::Map<const Eigen::VectorXd> own(row + first, static_cast<Eigen::Index>(size));
        const auto later = static_cast<Eigen::Index>(count - first - size);
        const Eigen::Map<Eigen::VectorXd> other(row + first + size, later);
        const auto at = static_cast<Eigen::Index>(first);
        const auto here = static_cast<Eigen::Index>(first + k);
        cone_(here) -= own.dot(factors.segment(at, static_cast<Eigen::Index>(size))) + other.dot(factors.tail(later));
        cone_.segment(at + static_cast<Eigen::Index>(size), later) -= factors(here) * other;
        std::for_each(row + first, row + first + size, [](double& value) { value *= 0.5; });
      }
      RowMajorMatrix lit(static_cast<Eigen::Index>(size), static_cast<Eigen::Index>(columns));
      multiply(sampler_.device(), {values_.data() + first, size, depth, stride},
               {rows.samples.data() + first * columns, depth, columns, columns}, {ones.data(), depth},
               {lit.data(), size, columns, columns}, Precision::double_precision);
      use(static_cast<Eigen::Index>(first), static_cast<Eigen::Index>(size), lit);
    }
    const auto smooth = static_cast<Eigen::Index>(count - lobes_.deltas.size());
    delta_cone_ = cone_.segment(smooth, delta_cone_.size());
    for (Eigen::Index k = 0; k < smooth; ++k) cone_(k) /= factors(k);
    cone_.tail(cone_.size() - smooth).setZero();
  }

  const LobeSet& lobes_;
  const Lighting& lighting_;
  PatchRule rule_;
  Sampler sampler_;
  NodeBlock block_;
  std::vector<PatchLight> lights_;
  Work& work_;
  Stopwatch watch_;
  std::vector<NodeBlock::Node> nodes_;
  DiscPoints points_;
  std::vector<double> factors_;
  std::vector<double> values_;
  Eigen::VectorXd cone_;
  Eigen::VectorXd delta_cone_;
};

/// Differences of near-identical materials, as for point light.
void refine_close_pairs(PatchIntegrator& integrator, const std::vector<std::size_t>& levels, const LobeSet& lobes,
                        const Lighting& lighting, const MetricOptions& options, ProductSums& sums) {
  // Above this share the cancellation costs less than six digits of the distance.
  const auto pairs = find_close_pairs(sums, 1e-6);
  if (pairs.empty()) return;
  const auto rows = differences(lobes, pairs);
  Eigen::VectorXd value = Eigen::VectorXd::Zero(rows.rows());
  Eigen::VectorXd error = value;
  for (std::size_t slab = 0; slab < levels.size(); ++slab) {
    const Eigen::VectorXd fine = integrator.squares(slab, levels[slab], rows);
    error += (fine - integrator.squares(slab, levels[slab] - 1, rows)).cwiseAbs();
    value += fine;
    report_progress(options, lighting, 1);
  }
  replace_distances(sums, pairs, rows, value, error, product_rounding(Precision::double_precision) / 4);
}

}  // namespace

std::vector<LightDisc> light_discs(std::span<const PatchShare> shares) {
  std::vector<LightDisc> discs;
  for (const auto& [radius, weight] : shares) {
    discs.push_back({radius, weight * patch_constant(radius) * patch_constant(radius)});
  }
  return discs;
}

double light_response(std::span<const PatchShare> shares, double distance) {
  double response = 0;
  for (const auto& [radius, weight] : shares) response += weight * patch_response(distance, radius);
  return response;
}

void integrate_patch_products(const Device& device, const LobeSet& lobes, const Lighting& lighting,
                              const MetricOptions& options, ProductSums& sums, Work& work) {
  report_progress(options, lighting, 0);
  PatchIntegrator integrator(device, lobes, lighting, work);
  constexpr double kEarlierShare = 0.1;  // as ProductSums counts the difference before the last
  struct Slab {
    std::vector<Eigen::MatrixXd> products;  ///< at the last levels, coarse to fine
    std::size_t level = 0;
    double difference = 0;  ///< of the last two
  };
  std::vector<Slab> slabs(integrator.slabs());
  const auto n = static_cast<Eigen::Index>(lobes.lobes());
  Eigen::MatrixXd reference = Eigen::MatrixXd::Zero(n, n);
  for (std::size_t k = 0; k < slabs.size(); ++k) {
    slabs[k].products.push_back(integrator.products(k, 0));
    reference += slabs[k].products.back();
    report_progress(options, lighting, 0);
  }
  require_finite(reference, lobes, lighting);

  const auto refine = [&](std::size_t k) {
    Slab& slab = slabs[k];
    slab.products.push_back(integrator.products(k, ++slab.level));
    require_finite(slab.products.back(), lobes, lighting);
    const double earlier = slab.difference;
    slab.difference = relative_difference(slab.products.back(), slab.products[slab.products.size() - 2], reference);
    slab.difference = std::max(slab.difference, kEarlierShare * earlier);
    if (slab.products.size() > kLevelsKept) slab.products.erase(slab.products.begin());
  };
  for (std::size_t k = 0; k < slabs.size(); ++k) refine(k);
  // Few slabs make most of the error: the worst one is refined until their sum is below the tolerance.
  const double goal = std::max(options.tolerance, options.patch_tolerance) / (1 + kCommonShare);
  double total_difference = 0;
  for (;;) {
    total_difference = 0;
    Slab* worst = nullptr;
    for (Slab& slab : slabs) {
      total_difference += slab.difference;
      const bool may_grow = slab.level + 1 < kPatchLevels.size();
      if (may_grow && (worst == nullptr || slab.difference > worst->difference)) worst = &slab;
    }
    report_progress(options, lighting, std::min(1.0, goal / total_difference));
    if (total_difference <= goal || worst == nullptr) break;
    refine(static_cast<std::size_t>(worst - slabs.data()));
  }
  std::vector<std::size_t> levels;
  for (const Slab& slab : slabs) {
    sums.add_lobe_products(slab.products);
    levels.push_back(slab.level);
  }
  const double rounding = product_rounding(Precision::double_precision);
  for (auto& total : sums.totals()) {
    total.gram_error += (rounding + kCommonShare * total_difference) * total.gram.cwiseAbs();
    const Eigen::VectorXd squares = rounding * total.gram.diagonal();
    total.squared_distance_error.colwise() += squares;
    total.squared_distance_error.rowwise() += squares.transpose();
  }
  refine_close_pairs(integrator, levels, lobes, lighting, options, sums);
}

}  // namespace lobe
