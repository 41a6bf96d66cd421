#include "render/sphere_surface.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "core/parallel.hpp"
#include "energy/material_albedo.hpp"
#include "hemisphere/half_vector_rule.hpp"
#include "hemisphere/refinement.hpp"
#include "lobe/core/error.hpp"
#include "model/delta.hpp"
#include "model/delta_shares.hpp"
#include "render/sphere_parts.hpp"
#include "table/as_function.hpp"
#include "table/interpolator.hpp"
#include "table/mixed_channels.hpp"

namespace lobe {
namespace {

using std::numbers::pi;

/// \throws ArgumentError for weights that do not fit
Eigen::MatrixXd weights_of(const SphereOptions& options, std::size_t channels, const std::string& name) {
  const auto count = static_cast<Eigen::Index>(channels);
  if (options.weights.size() == 0) return Eigen::MatrixXd::Identity(count, count);
  if (options.weights.cols() != count) {
    throw ArgumentError("'" + name + "' has " + std::to_string(channels) + " channels; expected weights for as many");
  }
  return options.weights;
}

struct Angles {
  double theta, phi;
};

Angles angles_of(const std::array<double, 3>& direction) {
  const auto& [x, y, z] = direction;
  return {std::atan2(std::hypot(x, y), std::max(z, kLeastCosine)), std::atan2(y, x)};
}

Directions pair_of(const Angles& in, const Angles& out) {
  return {in.theta, out.theta, out.phi - in.phi, in.phi};
}

/// Radiance under point lights of a reflectance that is evaluated on the host, a few parts at a time.
class FunctionShader {
 public:
  FunctionShader(BrdfFunction brdf, Eigen::MatrixXd weights, std::function<void()> stop)
      : brdf_(std::move(brdf)), weights_(std::move(weights)), stop_(std::move(stop)) {}

  Eigen::MatrixXd operator()(std::span<const SpherePart> parts, const GaussRule& rule,
                             std::span<const std::array<double, 4>> lights) const {
    constexpr std::size_t kPairs = 8192;
    const std::size_t nodes = rule.nodes.size() * rule.nodes.size();
    const std::size_t block = std::max<std::size_t>(1, kPairs / (nodes * lights.size()));
    const std::size_t blocks = (parts.size() + block - 1) / block;
    Eigen::MatrixXd radiance = Eigen::MatrixXd::Zero(weights_.rows(), static_cast<Eigen::Index>(parts.size()));
    constexpr std::size_t kBetweenStops = 16;  // blocks
    for (std::size_t begin = 0; begin < blocks; begin += kBetweenStops) {
      stop_();
      const std::size_t count = std::min(kBetweenStops, blocks - begin);
      const auto work = [&](std::size_t k) {
        const std::size_t first = (begin + k) * block;
        const auto some = parts.subspan(first, std::min(block, parts.size() - first));
        radiance.middleCols(static_cast<Eigen::Index>(first), static_cast<Eigen::Index>(some.size())) =
            shade(some, rule, lights);
      };
      if (brdf_.is_concurrent) {
        parallel_for(count, work);
      } else {
        for (std::size_t k = 0; k < count; ++k) work(k);
      }
    }
    return radiance;
  }

 private:
  [[nodiscard]] Eigen::MatrixXd shade(std::span<const SpherePart> parts, const GaussRule& rule,
                                      std::span<const std::array<double, 4>> lights) const {
    std::vector<Directions> pairs;
    std::vector<double> shares;
    std::vector<Eigen::Index> part_of;
    for (std::size_t k = 0; k < parts.size(); ++k) {
      for_each_node(parts[k], rule, [&](const SpherePoint& point, double share) {
        const Angles view = angles_of(point.view());
        for (const auto& [x, y, z, irradiance] : lights) {
          const auto light = point.local({x, y, z});
          if (!(light[2] > 0)) continue;
          pairs.push_back(pair_of(angles_of(light), view));
          shares.push_back(share * light[2] * irradiance);
          part_of.push_back(static_cast<Eigen::Index>(k));
        }
      });
    }
    Eigen::MatrixXd radiance = Eigen::MatrixXd::Zero(weights_.rows(), static_cast<Eigen::Index>(parts.size()));
    if (pairs.empty()) return radiance;
    const Eigen::MatrixXd values = brdf_.at(pairs).value * weights_.transpose();
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      radiance.col(part_of[i]) += shares[i] * values.row(static_cast<Eigen::Index>(i)).transpose();
    }
    return radiance;
  }

  BrdfFunction brdf_;
  Eigen::MatrixXd weights_;
  std::function<void()> stop_;
};

/// Albedos of a material by the direction of the viewer, refined until their errors are tolerable.
SkyFunction sky_of(const std::shared_ptr<MaterialAlbedo>& albedo, const Eigen::MatrixXd& weights, double tolerance) {
  return [albedo, weights, tolerance](std::span<const Direction> views) {
    constexpr double kSafety = 2;
    const auto count = static_cast<Eigen::Index>(views.size());
    SkyValues result{Eigen::MatrixXd(weights.rows(), count), Eigen::MatrixXd(weights.rows(), count)};
    std::vector<Eigen::Index> waiting;
    for (Eigen::Index k = 0; k < count; ++k) waiting.push_back(k);
    for (int level = 0; level < kLevels && !waiting.empty(); ++level) {
      std::vector<IncidentNode> nodes;
      for (const Eigen::Index k : waiting) {
        const Direction& view = views[static_cast<std::size_t>(k)];
        nodes.push_back({pi / 2 - view.theta, 1, view.phi});
      }
      const Eigen::MatrixXd values = weights * albedo->at(nodes, level);
      std::vector<Eigen::Index> left;
      for (std::size_t i = 0; i < waiting.size(); ++i) {
        const Eigen::Index k = waiting[i];
        const auto value = values.col(static_cast<Eigen::Index>(i)).array();
        if (level > 0) result.error.col(k) = kSafety * (value - result.value.col(k).array()).abs();
        result.value.col(k) = value;
        const bool is_reached = level > 0 && (result.error.col(k).array() <= tolerance * value.abs().max(1)).all();
        if (!is_reached) left.push_back(k);
      }
      waiting = std::move(left);
    }
    return result;
  };
}

/// Albedos of a function by the direction of the viewer, by two rules over half-vectors.
SkyFunction sky_of(const BrdfFunction& brdf, const Eigen::MatrixXd& weights, const std::function<void()>& stop) {
  return [brdf, weights, stop](std::span<const Direction> views) {
    constexpr double kWidth = 0.01;  // of what measurements resolve
    constexpr std::size_t kNodes = 4096;
    constexpr double kSafety = 2;
    const HalfVectorRule rule({.width = kWidth, .patch_radii = {}, .retro_patch_radii = {}, .aspect = 1});
    const auto albedo = [&](const Direction& view, int level) {
      Eigen::VectorXd sum = Eigen::VectorXd::Zero(weights.cols());
      NodeBlock block(kNodes, true);
      const auto flush = [&] {
        std::vector<Directions> pairs;
        Eigen::VectorXd factors(static_cast<Eigen::Index>(block.size()));
        const auto at = [&](std::size_t row, std::size_t node) { return block.data()[row * block.capacity() + node]; };
        for (std::size_t node = 0; node < block.size(); ++node) {
          const double both = at(NodeBlock::cos_i, node) + at(NodeBlock::cos_o, node);
          const auto tangent = [&](NodeBlock::TangentRow row) { return at(NodeBlock::kRows + row, node); };
          const Angles light =
              angles_of({tangent(NodeBlock::slope_x) * both - tangent(NodeBlock::in_x),
                         tangent(NodeBlock::slope_y) * both - tangent(NodeBlock::in_y), at(NodeBlock::cos_o, node)});
          pairs.push_back(pair_of(light, {view.theta, view.phi}));
          factors(static_cast<Eigen::Index>(node)) = at(NodeBlock::factor, node);
        }
        sum += brdf.at(pairs).value.transpose() * factors;
        block.clear();
      };
      rule.place(pi / 2 - view.theta, view.phi, false, kNodesPerPanel[static_cast<std::size_t>(level)], block, flush);
      if (block.size() > 0) flush();
      return Eigen::VectorXd(weights * sum);
    };
    const auto count = static_cast<Eigen::Index>(views.size());
    SkyValues result{Eigen::MatrixXd(weights.rows(), count), Eigen::MatrixXd(weights.rows(), count)};
    const auto work = [&](std::size_t k) {
      const auto column = static_cast<Eigen::Index>(k);
      result.value.col(column) = albedo(views[k], 1);
      result.error.col(column) = kSafety * (result.value.col(column) - albedo(views[k], 0)).cwiseAbs();
    };
    constexpr std::size_t kBetweenStops = 8;
    for (std::size_t begin = 0; begin < views.size(); begin += kBetweenStops) {
      stop();
      const std::size_t some = std::min(kBetweenStops, views.size() - begin);
      if (brdf.is_concurrent) {
        parallel_for(some, [&](std::size_t k) { work(begin + k); });
      } else {
        for (std::size_t k = 0; k < some; ++k) work(begin + k);
      }
    }
    return result;
  };
}

/// Albedos by row, one channel after the other, and their errors.
struct RowAlbedos {
  std::vector<double> value;
  std::vector<double> error;
};

RowAlbedos albedos_towards_viewer(const BrdfTable& table) {
  RowAlbedos rows;
  for (const auto& channel : row_albedos(table).out) {
    for (const Estimate& estimate : channel) {
      rows.value.push_back(estimate.value);
      rows.error.push_back(estimate.error);
    }
  }
  return rows;
}

}  // namespace

SphereSurface surface_of(const Device& device, const Material& material, const SphereOptions& options) {
  const LobeSet lobes = make_lobe_set({&material, 1}, {.with_deltas = true, .with_anisotropic = true});
  const Eigen::MatrixXd weights = weights_of(options, lobes.channels(), material.name);
  Eigen::MatrixXd mix = Eigen::MatrixXd::Zero(weights.rows(), static_cast<Eigen::Index>(lobes.smooth_lobes()));
  for (Eigen::Index c = 0; c < weights.cols(); ++c) {
    const Eigen::RowVectorXd of_channel = lobes.mix[static_cast<std::size_t>(c)].row(0);
    mix += weights.col(c) * of_channel.head(mix.cols());
  }
  SphereSurface surface;
  surface.name = material.name;
  surface.rows = weights.rows();
  surface.width = lobes.narrowest;
  const auto shader = std::make_shared<SphereShader>(device, lobes.batches, mix, options.precision);
  surface.lit = [shader](std::span<const SpherePart> parts, const GaussRule& rule,
                         std::span<const std::array<double, 4>> lights) {
    return shader->shade(parts, rule.nodes, rule.weights, lights);
  };
  surface.symmetry = {.isotropic = std::ranges::all_of(material.terms, &Traits::isotropic, traits_of),
                      .half_turn = lobes.half_turn};
  surface.sky = sky_of(std::make_shared<MaterialAlbedo>(device, material, options.precision, Given::viewer), weights,
                       options.tolerance / 4);
  if (!lobes.deltas.empty()) {
    surface.has_retro = std::ranges::any_of(lobes.deltas, [](const auto& d) { return d.kind == DeltaKind::retro; });
    surface.mirror = [device, deltas = split_delta(material).deltas, weights](Direction view) {
      const double elevation = pi / 2 - view.theta;
      const auto channels = static_cast<std::size_t>(weights.cols());
      return Eigen::VectorXd(weights * delta_parts(device, deltas, channels, {&elevation, 1}).mirror);
    };
  }
  return surface;
}

namespace {

/// A table with what refers to it, so that both live as long as the functions of a surface do.
struct InterpolatedTable {
  explicit InterpolatedTable(BrdfTable values) : table(std::move(values)), interpolator(table) {}

  BrdfTable table;
  Interpolator interpolator;
};

}  // namespace

SphereSurface surface_of(const BrdfTable& table, const SphereOptions& options, const std::function<void()>& stop) {
  check(table);
  const Eigen::MatrixXd weights = weights_of(options, table.channels, table.expression);
  const auto whole = std::make_shared<const InterpolatedTable>(mixed_channels(table, weights));
  const double theta_last = table.grid.rings().back().theta;
  BrdfTable smooth = whole->table;
  smooth.mirror.clear();
  smooth.retro.clear();
  SphereSurface surface;
  surface.name = table.expression;
  surface.rows = weights.rows();
  surface.lit = FunctionShader(as_function(smooth), Eigen::MatrixXd::Identity(surface.rows, surface.rows), stop);
  surface.highest_order = 8;
  surface.symmetry = {.isotropic = table.form == TableForm::isotropic, .half_turn = false};
  surface.has_steps = !table.grid.is_product();
  const auto rows = std::make_shared<const RowAlbedos>(albedos_towards_viewer(whole->table));
  // Beyond the last ring a polynomial would say anything.
  const auto inside = [theta_last](Direction view) { return Direction{std::min(view.theta, theta_last), view.phi}; };
  surface.sky = [=](std::span<const Direction> views) {
    const Eigen::Index channels = weights.rows();
    const auto count = static_cast<Eigen::Index>(views.size());
    SkyValues result{Eigen::MatrixXd(channels, count), Eigen::MatrixXd(channels, count)};
    for (Eigen::Index k = 0; k < count; ++k) {
      const Direction view = inside(views[static_cast<std::size_t>(k)]);
      for (Eigen::Index c = 0; c < channels; ++c) {
        const Estimate value = whole->interpolator.row_part(rows->value, static_cast<std::size_t>(c), view);
        const Estimate error = whole->interpolator.row_part(rows->error, static_cast<std::size_t>(c), view);
        result.value(c, k) = value.value;
        result.error(c, k) = value.error + std::abs(error.value);
      }
    }
    return result;
  };
  surface.has_retro = !table.retro.empty();
  if (!table.mirror.empty()) {
    surface.mirror = [=](Direction view) {
      Eigen::VectorXd shares(weights.rows());
      for (Eigen::Index c = 0; c < shares.size(); ++c) {
        shares(c) = whole->interpolator.row_part(whole->table.mirror, static_cast<std::size_t>(c), inside(view)).value;
      }
      return shares;
    };
  }
  return surface;
}

SphereSurface surface_of(const BrdfFunction& brdf, const SphereOptions& options, const std::function<void()>& stop) {
  const Eigen::MatrixXd weights = weights_of(options, brdf.channels.size(), brdf.name);
  SphereSurface surface;
  surface.name = brdf.name;
  surface.rows = weights.rows();
  surface.lit = FunctionShader(brdf, weights, stop);
  surface.sky = sky_of(brdf, weights, stop);
  surface.symmetry = {.isotropic = brdf.is_isotropic, .half_turn = false};
  return surface;
}

}  // namespace lobe
