// Products of reflectances that are functions: point by half-difference quadrature, others by albedos.
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "core/stopwatch.hpp"
#include "hemisphere/half_difference_rule.hpp"
#include "hemisphere/node_directions.hpp"
#include "lobe/core/error.hpp"
#include "metric/channel_metric.hpp"
#include "metric/domain.hpp"
#include "metric/function_products.hpp"
#include "metric/function_sums.hpp"
#include "metric/function_values.hpp"
#include "metric/grazing_growth.hpp"
#include "metric/lighting_traits.hpp"
#include "metric/products.hpp"
#include "metric/routes.hpp"
#include "table/ring_cells.hpp"

namespace lobe {
namespace {

using std::numbers::pi;

constexpr std::size_t kAzimuths = kFunctionAzimuths;
constexpr std::size_t kBlock = 4096;  // nodes

/// A node: elevations and azimuth of both directions, its weight, and where the azimuths of anisotropic functions
/// begin, as a share of their step.
struct PairNode {
  double theta_in, theta_out, delta_phi, weight;
  double turn = 0;
};

PairNode pair_node(const NodeBlock& block, std::size_t at) {
  const Directions pair = directions_at(block, at);
  return {pair.theta_in, pair.theta_out, pair.delta_phi, factor_at(block, at), 0};
}

std::vector<PairNode> nodes_of(const NodeBlock& block) {
  std::vector<PairNode> nodes;
  for (std::size_t at = 0; at < block.size(); ++at) nodes.push_back(pair_node(block, at));
  return nodes;
}

/// The pairs that a node stands for, [variant][azimuth]: both orders of L and V, each with both signs of delta_phi; the
/// azimuth is that of L.
constexpr std::size_t kVariants = 4;

Directions pair_of(const PairNode& node, std::size_t variant, double azimuth) {
  const double delta_phi = variant % 2 == 0 ? node.delta_phi : -node.delta_phi;
  if (variant / 2 == 0) return {node.theta_in, node.theta_out, delta_phi, azimuth};
  return {node.theta_out, node.theta_in, delta_phi, azimuth};
}

/// Every row for all variants that have the same values, one after the other.
Eigen::MatrixXd repeated(const Eigen::MatrixXd& rows, Eigen::Index times) {
  Eigen::MatrixXd all(times * rows.rows(), rows.cols());
  for (Eigen::Index c = 0; c < rows.cols(); ++c) {
    for (Eigen::Index i = 0; i < rows.rows(); ++i) all.col(c).segment(times * i, times).setConstant(rows(i, c));
  }
  return all;
}

/// Values and errors of one function, (node, variant, azimuth) x channels, with one azimuth for isotropic ones.
BrdfValues function_values(const BrdfFunction& function, const std::vector<PairNode>& nodes, WorkDone& work) {
  const std::size_t azimuths = function.is_isotropic ? 1 : kAzimuths;
  // Of even functions the other sign of delta_phi, and of those that are reciprocal, too, the other order.
  const bool is_even = function.is_isotropic && function.is_bilateral;
  const std::size_t alike = !is_even ? 1 : function.is_reciprocal ? kVariants : 2;
  std::vector<Directions> pairs;
  pairs.reserve(nodes.size() * kVariants / alike * azimuths);
  for (const PairNode& node : nodes) {
    for (std::size_t v = 0; v < kVariants; v += alike) {
      for (std::size_t a = 0; a < azimuths; ++a) {
        const double azimuth = 2 * pi * (static_cast<double>(a) + node.turn) / static_cast<double>(azimuths);
        pairs.push_back(pair_of(node, v, azimuth));
      }
    }
  }
  BrdfValues values = values_at(function, pairs);
  work.evaluations += pairs.size();
  const auto times = static_cast<Eigen::Index>(alike);
  if (is_even) values = {repeated(values.value, times), repeated(values.error, times)};
  return values;
}

class FunctionIntegrator {
 public:
  FunctionIntegrator(std::span<const BrdfFunction> functions, std::size_t channels,
                     const FunctionMetricOptions& options, WorkDone& work)
      : functions_(functions), channels_(channels), options_(options), work_(work) {}

  /// Products of values over a slab of the half-difference rule.
  [[nodiscard]] FunctionSums point(const HalfDifferenceRule& rule, std::size_t slab, int nodes_per_panel) {
    FunctionSums sums(channels_, functions_.size());
    NodeBlock block(kBlock);
    std::size_t placed = 0;
    rule.place_gauss(slab, nodes_per_panel, block, [&] {
      auto nodes = nodes_of(block);
      block.clear();
      for (PairNode& node : nodes) node.turn = turn_of(placed++, nodes_per_panel);
      const std::size_t rows = nodes.size() * kVariants;
      Eigen::VectorXd roots(static_cast<Eigen::Index>(rows));
      for (std::size_t row = 0; row < rows; ++row) {
        roots(static_cast<Eigen::Index>(row)) =
            nodes[row / kVariants].weight / std::sqrt(static_cast<double>(kVariants));
      }
      add(nodes, roots.asDiagonal(), static_cast<Eigen::Index>(rows), sums);
      if (options_.progress && !options_.progress("point", 0)) throw Cancelled("cancelled");
    });
    return sums;
  }

 private:
  template <typename Weights>
  void add(const std::vector<PairNode>& nodes, const Weights& roots, Eigen::Index rows, FunctionSums& sums) {
    std::vector<FunctionColumns> columns(channels_, FunctionColumns(functions_, rows));
    for (std::size_t f = 0; f < functions_.size(); ++f) {
      const BrdfValues values = values_of(f, nodes);
      const std::size_t azimuths = functions_[f].is_isotropic ? 1 : kAzimuths;
      for (std::size_t c = 0; c < channels_; ++c) {
        columns[c].set(f, roots * channel_rows(values.value, c, azimuths),
                       roots * channel_rows(values.error, c, azimuths));
      }
    }
    for (std::size_t c = 0; c < channels_; ++c) columns[c].add_to(sums.gram[c], sums.square_error[c]);
  }

  [[nodiscard]] BrdfValues values_of(std::size_t f, const std::vector<PairNode>& nodes) {
    Stopwatch watch;
    BrdfValues values = function_values(functions_[f], nodes, work_);
    work_.nodes += f == 0 ? nodes.size() : 0;
    work_.seconds_values += watch.lap();
    return values;
  }

  std::span<const BrdfFunction> functions_;
  std::size_t channels_;
  const FunctionMetricOptions& options_;
  WorkDone& work_;
};

/// Roots of finite_unseen_square(), by function.
/// \throws NumericError naming a function whose norm does not exist
Eigen::VectorXd unseen_roots(std::span<const BrdfFunction> functions, const Lighting& lighting, double cos_min) {
  Eigen::VectorXd roots = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(functions.size()));
  if (cos_min > 0) return roots;
  for (Eigen::Index i = 0; i < roots.size(); ++i) {
    const BrdfFunction& function = functions[static_cast<std::size_t>(i)];
    const auto unseen = finite_unseen_square(function, lighting);
    if (unseen) {
      roots(i) = std::sqrt(*unseen);
      continue;
    }
    const std::string refusal = "the norm of '" + function.name + "' under lighting '" + lighting.name() +
                                "' is infinite: every decade of cos(theta) towards the horizon adds as much to it; "
                                "'mean-albedo' takes it, or ";
    if (takes_tables(lighting)) {
      throw NumericError(refusal + "read its file up to a largest angle, such as 80 degrees, beyond which values stay");
    }
    throw NumericError(refusal + domain_advice(lighting), {.fault = Fault::infinite_norm});
  }
  return roots;
}

void report(const FunctionMetricOptions& options, const Lighting& lighting, std::size_t done, std::size_t all) {
  const double share = static_cast<double>(done) / static_cast<double>(all);
  if (options.progress && !options.progress(lighting.name(), share)) throw Cancelled("cancelled");
}

std::vector<ChannelProducts> integrate_point(FunctionIntegrator& integrator, std::size_t functions,
                                             std::size_t channels, const FunctionMetricOptions& options) {
  const Lighting lighting = Lighting::point();
  const HalfDifferenceRule rule({.width = options.lobe_width,
                                 .patch_radii = {},
                                 .retro_patch_radii = {},
                                 .cos_min = cos_of_domain(options.theta_max, lighting)});
  const auto slabs =
      refined_slabs(rule.slabs(), kFunctionLevels.size(), options.tolerance, [&](std::size_t slab, std::size_t level) {
        report(options, lighting, slab, rule.slabs());
        return integrator.point(rule, slab, kFunctionLevels.at(level));
      });
  std::vector<ChannelProducts> finished;
  for (std::size_t c = 0; c < channels; ++c) {
    finished.push_back(finished_products(slabs, functions, c));
  }
  return finished;
}

/// Whether products are sums over rings and cells.
bool has_exact_products(std::span<const BrdfFunction> functions, const Lighting& lighting, double cos_min) {
  const bool is_of_values = lighting == Lighting::point() || lighting == Lighting::mean_albedo();
  return is_of_values && cos_min == 0 &&
         std::ranges::all_of(functions, [](const BrdfFunction& f) { return f.ring_cells != nullptr; });
}

/// Products under point light or of mean albedos, of functions that are constant on rings and cells.
ChannelProducts exact_products(std::span<const BrdfFunction> functions, const Lighting& lighting, std::size_t channel) {
  const auto n = static_cast<Eigen::Index>(functions.size());
  const Eigen::MatrixXd zero = Eigen::MatrixXd::Zero(n, n);
  ChannelProducts products{zero, zero, zero, zero};
  const auto at = [&](Eigen::Index i) -> const BrdfFunction& { return functions[static_cast<std::size_t>(i)]; };
  const auto channel_of = [&](Eigen::Index i) { return at(i).channels.size() == 1 ? 0 : channel; };
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      const RingCells& f = *at(i).ring_cells;
      const RingCells& g = *at(j).ring_cells;
      Estimate product = lobe::product(f, channel_of(i), g, channel_of(j));
      Estimate distance = squared_distance(f, channel_of(i), g, channel_of(j));
      if (lighting == Lighting::mean_albedo()) {
        const Estimate a = mean_albedo(f, channel_of(i));
        const Estimate b = mean_albedo(g, channel_of(j));
        product = {pi * pi * a.value * b.value,
                   pi * pi * (a.error * std::abs(b.value) + b.error * std::abs(a.value) + a.error * b.error)};
        const double difference = pi * (a.value - b.value);
        const double error = pi * (a.error + b.error);
        distance = {difference * difference, error * (2 * std::abs(difference) + error)};
      }
      products.gram(i, j) = product.value;
      products.gram_error(i, j) = product.error;
      products.squared_distance(i, j) = i == j ? 0 : distance.value;
      products.squared_distance_error(i, j) = i == j ? 0 : distance.error;
    }
  }
  return products;
}

}  // namespace

FunctionProducts::FunctionProducts(std::size_t functions)
    : square_error(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(functions))) {
  const Eigen::MatrixXd zero = Eigen::MatrixXd::Zero(square_error.size(), square_error.size());
  products = {zero, zero, zero, zero};
}

ChannelProducts with_own_errors(FunctionProducts sums) {
  constexpr double kRounding = 1e-13;  // of sums of some 1e6 products
  ChannelProducts& result = sums.products;
  const Eigen::VectorXd norm = result.gram.diagonal().cwiseMax(0).cwiseSqrt();
  const Eigen::VectorXd error = sums.square_error.cwiseSqrt();
  result.gram_error += error * norm.transpose() + norm * error.transpose() + error * error.transpose() +
                       kRounding * norm * norm.transpose();
  const Eigen::Index n = norm.size();
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      if (i == j) continue;
      const double moved = error(i) + error(j);
      double& square = result.squared_distance(i, j);
      square = std::max(square, 0.0);
      result.squared_distance_error(i, j) +=
          moved * (2 * std::sqrt(square) + moved) + kRounding * (norm(i) * norm(i) + norm(j) * norm(j));
    }
  }
  result.squared_distance.diagonal().setZero();
  result.squared_distance_error.diagonal().setZero();
  return result;
}

MetricResult measure_functions(std::span<const BrdfFunction> functions, const Lighting& lighting,
                               const FunctionMetricOptions& options) {
  const std::size_t channels = common_channels(functions);
  if (!traits_of(lighting).takes_functions) {
    throw ArgumentError("lighting '" + lighting.name() +
                        "' of functions takes tables; expected point, daylight, mean-albedo or patches");
  }
  if (!(options.tolerance > 0 && options.tolerance < 1)) {
    throw ArgumentError("tolerance out of range; expected a value in (0, 1)");
  }
  const std::vector<double> weights = channel_weights(options.channel_weights, channels);
  const double cos_min = cos_of_domain(options.theta_max, lighting);
  const bool is_exact = has_exact_products(functions, lighting, cos_min);
  Eigen::VectorXd unseen;
  if (!is_exact) unseen = unseen_roots(functions, lighting, cos_min);
  MetricResult result;
  result.lighting = lighting;
  result.tolerance = options.tolerance;
  result.theta_max = options.theta_max;
  std::vector<ChannelProducts> products;
  if (is_exact) {
    for (std::size_t c = 0; c < channels; ++c) products.push_back(exact_products(functions, lighting, c));
  } else if (lighting == Lighting::point()) {
    FunctionIntegrator integrator(functions, channels, options, result.work);
    products = integrate_point(integrator, functions.size(), channels, options);
  } else if (traits_of(lighting).has_operator) {
    products = integrate_function_patches(functions, channels, lighting, options, result.work);
  } else {
    for (auto& sums : integrate_albedo_products(functions, channels, lighting, options, result.work)) {
      products.push_back(with_own_errors(std::move(sums)));
    }
  }
  const auto n = static_cast<Eigen::Index>(functions.size());
  const Eigen::MatrixXd zero = Eigen::MatrixXd::Zero(n, n);
  ChannelProducts combined{zero, zero, zero, zero};
  for (std::size_t c = 0; c < channels; ++c) {
    ChannelProducts& channel = products[c];
    if (!is_exact) add_unseen(unseen, 1, channel);
    combined.gram += weights[c] * channel.gram;
    combined.gram_error += weights[c] * channel.gram_error;
    combined.squared_distance += weights[c] * channel.squared_distance;
    combined.squared_distance_error += weights[c] * channel.squared_distance_error;
    if (channels > 1) result.channels.push_back(make_metric(std::move(channel)));
  }
  result.combined = make_metric(std::move(combined));
  return result;
}

}  // namespace lobe
