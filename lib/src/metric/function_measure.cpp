// Products of reflectances that are functions: point by half-difference quadrature, others by albedos.
#include <algorithm>
#include <array>
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
#include "metric/function_values.hpp"
#include "metric/grazing_growth.hpp"
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

/// Every second group of rows again, for the other sign of delta_phi.
Eigen::MatrixXd with_mirror_images(const Eigen::MatrixXd& rows) {
  Eigen::MatrixXd both(2 * rows.rows(), rows.cols());
  for (Eigen::Index i = 0; i < rows.rows(); ++i) both.middleRows(2 * i, 2) = rows.row(i).replicate(2, 1);
  return both;
}

/// Values and errors of one function, (node, variant, azimuth) x channels, with one azimuth for isotropic ones.
BrdfValues sample(const BrdfFunction& function, const std::vector<PairNode>& nodes) {
  const std::size_t azimuths = function.is_isotropic ? 1 : kAzimuths;
  const bool is_even = function.is_isotropic && function.is_bilateral;
  std::vector<Directions> pairs;
  pairs.reserve(nodes.size() * kVariants * azimuths);
  for (const PairNode& node : nodes) {
    for (std::size_t v = 0; v < kVariants; v += is_even ? 2 : 1) {
      for (std::size_t a = 0; a < azimuths; ++a) {
        const double azimuth = 2 * pi * (static_cast<double>(a) + node.turn) / static_cast<double>(azimuths);
        pairs.push_back(pair_of(node, v, azimuth));
      }
    }
  }
  BrdfValues values = values_at(function, pairs);
  if (is_even) values = {with_mirror_images(values.value), with_mirror_images(values.error)};
  return values;
}

/// Sums of a quadrature: of products, functions x functions, and of squared errors, by channel.
struct Sums {
  std::vector<Eigen::MatrixXd> gram;
  std::vector<Eigen::VectorXd> square_error;

  Sums(std::size_t channels, std::size_t functions) {
    const auto n = static_cast<Eigen::Index>(functions);
    gram.assign(channels, Eigen::MatrixXd::Zero(n, n));
    square_error.assign(channels, Eigen::VectorXd::Zero(n));
  }
};

/// Values of functions at the rows of a rule: isotropic ones a column each, anisotropic ones a column per azimuth.
class Columns {
 public:
  Columns(std::span<const BrdfFunction> functions, Eigen::Index rows) {
    const auto n = static_cast<Eigen::Index>(functions.size());
    mean_ = Eigen::MatrixXd::Zero(rows, n);
    mean_error_ = Eigen::MatrixXd::Zero(rows, n);
    for (std::size_t f = 0; f < functions.size(); ++f) {
      if (functions[f].is_isotropic) continue;
      anisotropic_.push_back(static_cast<Eigen::Index>(f));
      turned_.emplace_back(Eigen::MatrixXd::Zero(rows, static_cast<Eigen::Index>(kAzimuths)));
    }
  }

  /// Values and errors, rows x azimuths, times the root of each row's weight.
  void set(std::size_t function, const Eigen::MatrixXd& value, const Eigen::MatrixXd& error) {
    const auto f = static_cast<Eigen::Index>(function);
    mean_.col(f) = value.rowwise().mean();
    mean_error_.col(f) = error.cwiseAbs2().rowwise().mean().cwiseSqrt();
    const auto found = std::ranges::find(anisotropic_, f);
    if (found != anisotropic_.end()) turned_[static_cast<std::size_t>(found - anisotropic_.begin())] = value;
  }

  void add_to(Eigen::MatrixXd& gram, Eigen::VectorXd& square_error) const {
    Eigen::MatrixXd products = mean_.transpose() * mean_;
    for (std::size_t a = 0; a < anisotropic_.size(); ++a) {
      for (std::size_t b = 0; b < anisotropic_.size(); ++b) {
        products(anisotropic_[a], anisotropic_[b]) =
            turned_[a].cwiseProduct(turned_[b]).sum() / static_cast<double>(kAzimuths);
      }
    }
    gram += products;
    square_error += mean_error_.cwiseAbs2().colwise().sum().transpose();
  }

 private:
  Eigen::MatrixXd mean_;
  Eigen::MatrixXd mean_error_;
  std::vector<Eigen::Index> anisotropic_;
  std::vector<Eigen::MatrixXd> turned_;
};

/// A channel of all rows, rows x azimuths.
Eigen::MatrixXd channel_rows(const Eigen::MatrixXd& samples, std::size_t channel, std::size_t azimuths) {
  const Eigen::Index column = samples.cols() == 1 ? 0 : static_cast<Eigen::Index>(channel);
  const auto width = static_cast<Eigen::Index>(azimuths);
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  return Eigen::Map<const Rows>(samples.col(column).data(), samples.rows() / width, width);
}

class FunctionIntegrator {
 public:
  FunctionIntegrator(std::span<const BrdfFunction> functions, std::size_t channels,
                     const FunctionMetricOptions& options, WorkDone& work)
      : functions_(functions), channels_(channels), options_(options), work_(work) {}

  /// Products of values over a slab of the half-difference rule.
  [[nodiscard]] Sums point(const HalfDifferenceRule& rule, std::size_t slab, int nodes_per_panel) {
    Sums sums(channels_, functions_.size());
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
  void add(const std::vector<PairNode>& nodes, const Weights& roots, Eigen::Index rows, Sums& sums) {
    std::vector<Columns> columns(channels_, Columns(functions_, rows));
    for (std::size_t f = 0; f < functions_.size(); ++f) {
      const BrdfValues samples = sampled(f, nodes);
      const std::size_t azimuths = functions_[f].is_isotropic ? 1 : kAzimuths;
      for (std::size_t c = 0; c < channels_; ++c) {
        columns[c].set(f, roots * channel_rows(samples.value, c, azimuths),
                       roots * channel_rows(samples.error, c, azimuths));
      }
    }
    for (std::size_t c = 0; c < channels_; ++c) columns[c].add_to(sums.gram[c], sums.square_error[c]);
  }

  [[nodiscard]] BrdfValues sampled(std::size_t f, const std::vector<PairNode>& nodes) {
    Stopwatch watch;
    BrdfValues samples = sample(functions_[f], nodes);
    work_.nodes += f == 0 ? nodes.size() : 0;
    work_.evaluations += static_cast<std::size_t>(samples.value.rows());
    work_.seconds_samples += watch.lap();
    return samples;
  }

  std::span<const BrdfFunction> functions_;
  std::size_t channels_;
  const FunctionMetricOptions& options_;
  WorkDone& work_;
};

/// Products of a channel with their errors, from sums at two levels and the functions' own errors.
class Products {
 public:
  explicit Products(std::size_t functions) : sums_(functions) {}

  /// Adds a slab at successive levels, at least two.
  void add(std::span<const Sums> levels, std::size_t channel) {
    std::vector<Eigen::MatrixXd> grams;
    std::vector<Eigen::MatrixXd> distances;
    for (const Sums& level : levels) {
      grams.push_back(level.gram[channel]);
      distances.push_back(squared_distances(grams.back()));
    }
    ChannelProducts& products = sums_.products;
    products.gram += grams.back();
    products.gram_error += error_of_levels(grams);
    products.squared_distance += distances.back();
    products.squared_distance_error += error_of_levels(distances);
    sums_.square_error += levels.back().square_error[channel];
  }

  [[nodiscard]] ChannelProducts finished() const {
    FunctionProducts sums = sums_;
    add_common_share(sums.products);
    return with_own_errors(std::move(sums));
  }

 private:
  /// Two levels may agree by accident in single entries: no product is better known, relatively, than both norms.
  static void add_common_share(ChannelProducts& products) {
    const Eigen::ArrayXd squares = products.gram.diagonal().array();
    const Eigen::ArrayXd own = (squares > 0).select(products.gram_error.diagonal().array() / squares, 0.0);
    const Eigen::Index n = own.size();
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index j = 0; j < n; ++j) {
        const double share = std::max(own(i), own(j));
        products.gram_error(i, j) += share * std::abs(products.gram(i, j));
        products.squared_distance_error(i, j) += share * std::max(products.squared_distance(i, j), 0.0);
      }
    }
  }

  static Eigen::MatrixXd squared_distances(const Eigen::MatrixXd& gram) {
    const Eigen::VectorXd squares = gram.diagonal();
    return squares.replicate(1, gram.cols()) + squares.transpose().replicate(gram.rows(), 1) - 2 * gram;
  }

  FunctionProducts sums_;
};

/// \throws NumericError naming a function whose norm does not exist
void require_norms(std::span<const BrdfFunction> functions, const Lighting& lighting, double cos_min) {
  if (cos_min > 0) return;
  for (const BrdfFunction& function : functions) {
    if (!has_infinite_norm(function, lighting)) continue;
    throw NumericError("the norm of '" + function.name + "' under lighting '" + lighting.name() +
                           "' is infinite: every decade of cos(theta) towards the horizon adds as much to it; "
                           "'mean-albedo' takes it, or " +
                           std::string(kDomainAdvice),
                       {.fault = Fault::infinite_norm});
  }
}

void report(const FunctionMetricOptions& options, const Lighting& lighting, std::size_t done, std::size_t all) {
  const double share = static_cast<double>(done) / static_cast<double>(all);
  if (options.progress && !options.progress(lighting.name(), share)) throw Cancelled("cancelled");
}

/// A slab's sums at the levels so far.
using Levels = std::vector<Sums>;

/// Error estimates of f.f relative to it, of a slab's share: functions of all channels, one after the other.
Eigen::VectorXd relative_errors(const Levels& slab, const Eigen::VectorXd& squares) {
  Eigen::VectorXd errors(squares.size());
  Eigen::Index at = 0;
  for (std::size_t c = 0; c < slab.back().gram.size(); ++c) {
    std::vector<Eigen::MatrixXd> diagonals;
    for (const Sums& level : slab) diagonals.emplace_back(level.gram[c].diagonal());
    const Eigen::VectorXd error = error_of_levels(diagonals);
    errors.segment(at, error.size()) = error;
    at += error.size();
  }
  return (squares.array() > 0).select(errors.array() / squares.array(), 0.0);
}

/// Refines the slab that counts most in the worst of the norms, one after the other.
template <typename Evaluate>
std::vector<Levels> refined(std::size_t slabs, double tolerance, const Evaluate& evaluate) {
  std::vector<Levels> all(slabs);
  Eigen::VectorXd squares;
  for (std::size_t slab = 0; slab < slabs; ++slab) {
    for (const std::size_t level : {0U, 1U}) all[slab].push_back(evaluate(slab, level));
    Eigen::VectorXd own(static_cast<Eigen::Index>(all[slab][1].gram.size()) * all[slab][1].gram[0].rows());
    for (std::size_t c = 0; c < all[slab][1].gram.size(); ++c) {
      const Eigen::MatrixXd& gram = all[slab][1].gram[c];
      own.segment(static_cast<Eigen::Index>(c) * gram.rows(), gram.rows()) = gram.diagonal();
    }
    squares = slab == 0 ? own : Eigen::VectorXd(squares + own);
  }
  Eigen::MatrixXd errors(squares.size(), static_cast<Eigen::Index>(slabs));
  for (std::size_t slab = 0; slab < slabs; ++slab) {
    errors.col(static_cast<Eigen::Index>(slab)) = relative_errors(all[slab], squares);
  }
  Eigen::VectorXd can_improve = Eigen::VectorXd::Ones(squares.size());
  for (;;) {
    Eigen::Index worst = 0;
    if (errors.rowwise().sum().cwiseProduct(can_improve).maxCoeff(&worst) <= tolerance) return all;
    std::size_t next = slabs;
    for (std::size_t slab = 0; slab < slabs; ++slab) {
      if (all[slab].size() == kFunctionLevels.size()) continue;
      const auto error = [&](std::size_t k) { return errors(worst, static_cast<Eigen::Index>(k)); };
      if (next == slabs || error(slab) > error(next)) next = slab;
    }
    // No use in refining what is not to blame.
    constexpr double kBlame = 1e-2;
    if (next == slabs || errors(worst, static_cast<Eigen::Index>(next)) <= kBlame * tolerance) {
      can_improve(worst) = 0;
      continue;
    }
    all[next].push_back(evaluate(next, all[next].size()));
    errors.col(static_cast<Eigen::Index>(next)) = relative_errors(all[next], squares);
  }
}

std::vector<ChannelProducts> integrate_point(FunctionIntegrator& integrator, std::size_t functions,
                                             std::size_t channels, const FunctionMetricOptions& options) {
  const Lighting lighting = Lighting::point();
  const HalfDifferenceRule rule({.width = options.lobe_width,
                                 .patch_radii = {},
                                 .retro_patch_radii = {},
                                 .cos_min = cos_of_domain(options.theta_max, lighting)});
  const auto slabs = refined(rule.slabs(), options.tolerance, [&](std::size_t slab, std::size_t level) {
    report(options, lighting, slab, rule.slabs());
    return integrator.point(rule, slab, kFunctionLevels.at(level));
  });
  std::vector<ChannelProducts> finished;
  for (std::size_t c = 0; c < channels; ++c) {
    Products products(functions);
    for (const Levels& slab : slabs) products.add(slab, c);
    finished.push_back(products.finished());
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
  if (takes_tables(lighting)) {
    throw ArgumentError("lighting '" + lighting.name() +
                        "' of functions takes tables; expected point, daylight or "
                        "mean-albedo");
  }
  if (!(options.tolerance > 0 && options.tolerance < 1)) {
    throw ArgumentError("tolerance out of range; expected a value in (0, 1)");
  }
  const std::vector<double> weights = channel_weights(options.channel_weights, channels);
  const double cos_min = cos_of_domain(options.theta_max, lighting);
  const bool is_exact = has_exact_products(functions, lighting, cos_min);
  if (!is_exact) require_norms(functions, lighting, cos_min);
  MetricResult result;
  result.lighting = lighting;
  result.theta_max = options.theta_max;
  std::vector<ChannelProducts> products;
  if (is_exact) {
    for (std::size_t c = 0; c < channels; ++c) products.push_back(exact_products(functions, lighting, c));
  } else if (lighting == Lighting::point()) {
    FunctionIntegrator integrator(functions, channels, options, result.work);
    products = integrate_point(integrator, functions.size(), channels, options);
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
