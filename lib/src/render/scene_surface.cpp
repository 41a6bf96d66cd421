#include "render/scene_surface.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <utility>

#include "core/parallel.hpp"
#include "energy/known_as.hpp"
#include "lobe/core/colour.hpp"
#include "lobe/core/error.hpp"
#include "lobe/sampling/sampling.hpp"
#include "model/delta.hpp"
#include "model/delta_shares.hpp"
#include "model/evaluate.hpp"
#include "model/lobes.hpp"
#include "sampling/cell_proposal.hpp"
#include "sampling/mixture.hpp"
#include "table/as_function.hpp"
#include "table/tabulate.hpp"

namespace lobe {
namespace {

using std::numbers::pi;

constexpr std::size_t kPiece = 512;  // pairs or viewers that a thread takes at a time

constexpr std::size_t kElevations = 32;  // at which densities of tables and albedos of terms are known

/// Middle of the elevations' intervals, of equal width in the angle from the normal.
double middle_of(std::size_t k) {
  return (static_cast<double>(k) + 0.5) / kElevations * pi / 2;
}

std::size_t interval_of(const UnitVector& view) {
  const double theta = std::atan2(std::hypot(view[0], view[1]), view[2]);
  return std::min(kElevations - 1, static_cast<std::size_t>(theta / (pi / 2) * kElevations));
}

/// A vector turned about the normal.
UnitVector turned_about_normal(const UnitVector& v, double cosine, double sine) {
  return {cosine * v[0] - sine * v[1], sine * v[0] + cosine * v[1], v[2]};
}

/// Values of a function, pairs x channels.
Eigen::MatrixXd values_of(const BrdfFunction& function, std::span<const Directions> pairs) {
  if (!function.is_concurrent) return function.at(pairs).value;
  Eigen::MatrixXd values(static_cast<Eigen::Index>(pairs.size()), static_cast<Eigen::Index>(function.channels.size()));
  parallel_for_pieces(pairs.size(), kPiece, [&](std::size_t begin, std::size_t end) {
    values.middleRows(static_cast<Eigen::Index>(begin), static_cast<Eigen::Index>(end - begin)) =
        function.at(pairs.subspan(begin, end - begin)).value;
  });
  return values;
}

}  // namespace

/// Densities that are drawn from for a list of viewers.
struct DrawPlan {
  DrawOrders orders;
  std::vector<Mixture> mixtures;             ///< for each viewer, or one for all
  std::vector<std::array<double, 2>> turns;  ///< cosine and sine by which each direction is to be turned; empty: none

  [[nodiscard]] const Mixture& mixture(std::size_t i) const { return mixtures.size() == 1 ? mixtures[0] : mixtures[i]; }
};

struct SceneSurface::Implementation {
  Eigen::Matrix3Xd colours = {};  ///< linear red, green and blue of each channel
  std::function<Eigen::MatrixXd(std::span<const Directions> pairs)> values;  ///< pairs x channels
  std::function<DrawPlan(std::span<const PathView> views)> plan;
  double narrowest = 1;
};

namespace {

using Implementation = SceneSurface::Implementation;

/// Albedos of a material's terms over the angle of the viewer, which share out their densities.
class TermAlbedos {
 public:
  TermAlbedos(const Device& device, const Material& smooth, bool has_no_delta, const SamplingOptions& options) {
    for (std::size_t k = 0; k < kElevations; ++k) {
      const double theta = middle_of(k);
      rows_.push_back(term_albedos(device, smooth, has_no_delta, {std::sin(theta), 0, std::cos(theta)}, options));
    }
  }
  [[nodiscard]] std::span<const double> at(const UnitVector& view) const { return rows_[interval_of(view)]; }

 private:
  std::vector<std::vector<double>> rows_;
};

/// The density of cosines alone.
DrawPlan cosine_plan_of(std::span<const PathView> views, std::size_t channels) {
  DrawPlan plan;
  plan.mixtures.push_back({{ProposalPart{}}, {}, channels});
  const std::size_t density = plan.orders.add_density(plan.mixtures.front().parts);
  for (const PathView& view : views) plan.orders.add(view.direction, density, view.number);
  return plan;
}

Implementation formula_surface(const Device& device, const Material& material, const SamplingOptions& options) {
  if (material.terms.empty()) throw ArgumentError("material '" + material.name + "' has no terms");
  const auto split = std::make_shared<const DeltaSplit>(split_delta(material));
  const std::size_t channels = material.channels();
  const bool has_delta = !split->deltas.terms.empty();
  Implementation surface;
  if (!split->smooth.terms.empty()) {
    surface.narrowest = make_lobe_set(std::span(&split->smooth, 1), {.with_anisotropic = true}).sharpest();
  }
  surface.values = [=](std::span<const Directions> pairs) -> Eigen::MatrixXd {
    if (split->smooth.terms.empty()) {
      return Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(pairs.size()), static_cast<Eigen::Index>(channels));
    }
    Eigen::MatrixXd found = evaluate(device, split->smooth, pairs, options.precision);
    if (found.cols() == 1 && channels > 1) found = found.replicate(1, static_cast<Eigen::Index>(channels)).eval();
    return found;
  };
  if (options.proposal == SamplingStrategy::cosine && !has_delta) {
    surface.plan = [channels](std::span<const PathView> views) { return cosine_plan_of(views, channels); };
    return surface;
  }
  const auto albedos = std::make_shared<const TermAlbedos>(device, split->smooth, !has_delta, options);
  surface.plan = [=](std::span<const PathView> views) {
    DrawPlan plan;
    plan.mixtures.resize(views.size());
    DeltaParts shares;
    if (has_delta) {
      std::vector<double> elevations;
      for (const auto& [view, number] : views) elevations.push_back(std::atan2(view[2], std::hypot(view[0], view[1])));
      shares = delta_parts(device, split->deltas, channels, elevations);
    }
    parallel_for_pieces(views.size(), kPiece, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const UnitVector& view = views[i].direction;
        std::vector<DeltaDirection> deltas;
        if (has_delta) {
          const auto column = [&](const Eigen::MatrixXd& part) {
            const Eigen::VectorXd factors = part.col(static_cast<Eigen::Index>(i));
            return std::vector<double>(factors.begin(), factors.end());
          };
          deltas = delta_directions(view, column(shares.mirror), column(shares.retro));
        }
        plan.mixtures[i] = mixture_of(split->smooth, albedos->at(view), std::move(deltas), channels, view, options);
      }
    });
    for (std::size_t i = 0; i < views.size(); ++i) {
      plan.orders.add(views[i].direction, plan.orders.add_density(plan.mixtures[i].parts), views[i].number);
    }
    return plan;
  };
  return surface;
}

/// A surface of a function whose densities follow a table.
Implementation function_surface(const BrdfFunction& function, const BrdfTable& table, const SamplingOptions& options) {
  const std::size_t channels = table.channels;
  Implementation surface;
  surface.values = [function](std::span<const Directions> pairs) { return values_of(function, pairs); };
  if (options.proposal == SamplingStrategy::cosine || table.form != TableForm::isotropic) {
    surface.plan = [channels](std::span<const PathView> views) { return cosine_plan_of(views, channels); };
    return surface;
  }
  auto densities = std::make_shared<std::vector<std::vector<ProposalPart>>>();
  for (std::size_t k = 0; k < kElevations; ++k) densities->push_back(propose(table, {middle_of(k), 0}));
  surface.plan = [densities, channels](std::span<const PathView> views) {
    DrawPlan plan;
    plan.mixtures.push_back({{}, {}, channels});
    std::array<std::optional<std::size_t>, kElevations> places;
    for (const auto& [view, number] : views) {
      const std::size_t k = interval_of(view);
      if (!places.at(k)) places.at(k) = plan.orders.add_density((*densities)[k]);
      const double sine = std::hypot(view[0], view[1]);
      plan.orders.add({sine, 0, view[2]}, *places.at(k), number);
      plan.turns.push_back(sine > 0 ? std::array{view[0] / sine, view[1] / sine} : std::array{1.0, 0.0});
    }
    return plan;
  };
  return surface;
}

Implementation implementation_of(const Device& device, const SceneMaterial& material, const SceneOptions& options) {
  Eigen::Matrix3Xd colours = scene_colours(material);
  const SamplingOptions sampling{.seed = options.seed,
                                 .first = 0,
                                 .proposal = options.proposal,
                                 .patches = options.patches,
                                 .precision = options.precision,
                                 .progress = {}};
  Implementation surface =
      known_as(device, material.reflectance,
               Cases{[&](const Material& formula) { return formula_surface(device, formula, sampling); },
                     [&](const BrdfFunction& function) {
                       return function_surface(function, natural_table(function, options.progress), sampling);
                     },
                     [&](const BrdfTable& table) { return function_surface(as_function(table), table, sampling); }});
  surface.colours = std::move(colours);
  return surface;
}

}  // namespace

Eigen::Matrix3Xd scene_colours(const SceneMaterial& material) {
  const Reflectance& reflectance = material.reflectance;
  const BrdfFunction* const function = reflectance.function();
  const BrdfTable* const table = reflectance.table();
  std::vector<std::string> names = function != nullptr ? function->channels
                                   : table != nullptr  ? table->channel_names
                                                       : std::vector<std::string>();
  if (names.empty()) {
    for (std::size_t k = 1; k <= reflectance.channels(); ++k) names.push_back(std::to_string(k));
  }
  const DisplayColours colours =
      display_colours(names, function == nullptr ? std::vector<double>() : function->wavelengths);
  if (colours.weights.rows() == 3) return colours.weights;
  if (colours.weights.cols() == 1) return colours.weights.replicate(3, 1);
  throw ArgumentError(
      fmt::format("material '{}' has {} channels without a colour; expected 1, a grey, 3, red, green and blue, or "
                  "wavelengths from 460 to 650 nm at least, no gap above 60 nm",
                  material.name, colours.weights.cols()));
}

SceneSurface::SceneSurface(const Device& device, const SceneMaterial& material, const SceneOptions& options)
    : implementation_(std::make_unique<const Implementation>(implementation_of(device, material, options))) {}
SceneSurface::SceneSurface(SceneSurface&&) noexcept = default;
SceneSurface::~SceneSurface() = default;

Eigen::Matrix3Xd SceneSurface::values(std::span<const Directions> pairs) const {
  Eigen::Matrix3Xd colours(3, static_cast<Eigen::Index>(pairs.size()));
  if (pairs.empty()) return colours;
  colours.noalias() = implementation_->colours * implementation_->values(pairs).transpose();
  return colours;
}

double SceneSurface::narrowest() const {
  return implementation_->narrowest;
}

std::vector<PathStep> SceneSurface::draw(EachDrawer& drawer, std::span<const PathView> views,
                                         std::uint64_t seed) const {
  const DrawPlan plan = implementation_->plan(views);
  const auto drawn = drawer.draw(plan.orders, seed);
  std::vector<PathStep> steps(views.size());
  std::vector<Directions> pairs;
  std::vector<std::size_t> smooth;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const Mixture& mixture = plan.mixture(i);
    const DeltaDirection* const delta = mixture.deltas.empty() ? nullptr : mixture.delta_of(drawn[i].part);
    if (delta != nullptr) {
      const Eigen::Map<const Eigen::VectorXd> factors(delta->factors.data(),
                                                      static_cast<Eigen::Index>(delta->factors.size()));
      const Eigen::Vector3d weight = implementation_->colours * factors / -drawn[i].density;
      steps[i] = {delta->direction, {weight[0], weight[1], weight[2]}};
      continue;
    }
    if (!(drawn[i].density > 0) || !(drawn[i].direction[2] > 0)) continue;
    steps[i].direction = plan.turns.empty()
                             ? drawn[i].direction
                             : turned_about_normal(drawn[i].direction, plan.turns[i][0], plan.turns[i][1]);
    pairs.push_back(pair_of(steps[i].direction, views[i].direction));
    smooth.push_back(i);
  }
  const Eigen::Matrix3Xd found = values(pairs);
  for (std::size_t k = 0; k < smooth.size(); ++k) {
    const std::size_t i = smooth[k];
    const Eigen::Vector3d weight = found.col(static_cast<Eigen::Index>(k)) * (drawn[i].direction[2] / drawn[i].density);
    steps[i].weight = {weight[0], weight[1], weight[2]};
  }
  return steps;
}

Directions pair_of(const UnitVector& light, const UnitVector& view) {
  const auto theta = [](const UnitVector& v) { return std::atan2(std::hypot(v[0], v[1]), v[2]); };
  const double phi_in = std::atan2(light[1], light[0]);
  return {theta(light), theta(view), std::atan2(view[1], view[0]) - phi_in, phi_in};
}

}  // namespace lobe
