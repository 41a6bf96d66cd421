#include "metric/grazing_growth.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "hemisphere/gauss.hpp"
#include "metric/lighting_traits.hpp"

namespace lobe {
namespace {

using std::numbers::pi;

constexpr int kPanelNodes = 3;               // per panel
constexpr std::size_t kGrazingAzimuths = 4;  // of the grazing direction, for anisotropic functions

/// A point and its weight.
struct Weighted {
  double at, weight;
};

std::vector<Weighted> gauss_points(const std::vector<double>& limits) {
  const GaussRule gauss = gauss_rule(kPanelNodes);
  std::vector<Weighted> points;
  for (std::size_t i = 0; i + 1 < limits.size(); ++i) {
    const double span = limits[i + 1] - limits[i];
    for (std::size_t k = 0; k < gauss.nodes.size(); ++k) {
      points.push_back({limits[i] + span * gauss.nodes[k], span * gauss.weights[k]});
    }
  }
  return points;
}

/// Cosines of the other direction, in panels of half a decade down to that of the grazing one and to none.
std::vector<Weighted> other_cosines(double grazing) {
  std::vector<double> limits{0};
  for (double cosine = grazing; cosine < 0.5; cosine *= std::sqrt(10.0)) limits.push_back(cosine);
  limits.push_back(1);
  return gauss_points(limits);
}

/// delta_phi in [0, pi], in panels of a decade away from the mirror direction, where grazing lobes are narrow.
std::vector<Weighted> azimuths() {
  std::vector<double> limits{0, 1, 2};
  for (const double off : {1.0, 0.3, 0.1, 1e-2, 1e-3, 1e-4, 0.0}) limits.push_back(pi - off);
  return gauss_points(limits);
}

/// Which of the directions is the grazing one.
enum class Grazing { light, viewer };

/// Contribution to the integral per unit of ln(cos) of the grazing direction, the largest of all channels.
double added_at(const BrdfFunction& function, double grazing, Grazing side, bool of_albedos) {
  static const std::vector<Weighted> turns = azimuths();
  const std::size_t own_turns = function.is_isotropic ? 1 : kGrazingAzimuths;
  const auto channels = static_cast<Eigen::Index>(function.channels.size());
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(channels);
  for (std::size_t own = 0; own < own_turns; ++own) {
    const double azimuth = 2 * pi * (static_cast<double>(own) + 0.3) / static_cast<double>(own_turns);
    std::vector<Directions> pairs;
    std::vector<double> weights;
    for (const Weighted& other : other_cosines(grazing)) {
      for (const Weighted& turn : turns) {
        for (const double delta_phi : {turn.at, -turn.at}) {
          const double theta = std::acos(grazing);
          const double other_theta = std::acos(other.at);
          pairs.push_back(side == Grazing::light ? Directions{theta, other_theta, delta_phi, azimuth}
                                                 : Directions{other_theta, theta, delta_phi, azimuth - delta_phi});
          weights.push_back(other.at * other.weight * turn.weight);
        }
      }
    }
    const Eigen::MatrixXd values = function.at(pairs).value;
    const Eigen::Map<const Eigen::VectorXd> weight(weights.data(), static_cast<Eigen::Index>(weights.size()));
    if (of_albedos) {
      sum += (values.transpose() * weight).cwiseAbs2();
    } else {
      sum += values.cwiseAbs2().transpose() * weight;
    }
  }
  return sum.maxCoeff() * grazing * grazing / static_cast<double>(own_turns);
}

// Cosines from which to which the decay is looked at, and how many decades lie between.
constexpr double kFirst = 1e-7;
constexpr double kLast = 1e-10;
constexpr double kDecades = 3;

/// Of one direction, what cosines below kUnseenCosine add, by the measured power; none where the whole is infinite.
std::optional<double> unseen_at(const BrdfFunction& function, Grazing side, bool of_albedos) {
  constexpr double kDecay = 0.8 * 0.8 * 0.8;  // over three decades
  constexpr double kRounding = 1e-12;
  constexpr double kFastest = 2;  // of bounded functions
  const double first = added_at(function, kFirst, side, of_albedos);
  const double last = added_at(function, kLast, side, of_albedos);
  if (last > kDecay * first && last > kRounding * added_at(function, 0.1, side, of_albedos)) return std::nullopt;
  if (first == 0) return 0;
  const double power = std::min(kFastest, std::log(first / last) / (kDecades * std::numbers::ln10));
  if (!(power > 0)) return first;  // at most rounding: anything larger is infinite
  return 2 * pi * first * std::pow(kUnseenCosine / kFirst, power) / power;
}

/// The most that W of patch lights is at two points: discs about both have no larger area in common within the base
/// plane than one of them, or the plane.
double largest_light(const Lighting& lighting) {
  constexpr int kRadii = 8;  // of a density
  double largest = 0;
  for (const LightDisc& disc : light_discs(lighting.shares(kRadii))) {
    largest += disc.factor * pi * std::pow(std::min(disc.radius, 1.0), 2);
  }
  return largest;
}

}  // namespace

bool has_infinite_norm(const BrdfFunction& function, const Lighting& lighting) {
  return !finite_unseen_square(function, lighting);
}

std::optional<double> finite_unseen_square(const BrdfFunction& function, const Lighting& lighting) {
  if (lighting == Lighting::daylight()) return unseen_at(function, Grazing::viewer, true);
  // W of patch lights is bounded and positive: their norms are finite where those of albedos are.
  const LightingTraits& traits = traits_of(lighting);
  if (!traits.has_operator && lighting != Lighting::point()) return 0;
  const auto of_viewer = unseen_at(function, Grazing::viewer, traits.has_operator);
  const auto of_light = unseen_at(function, Grazing::light, traits.has_operator);
  if (!of_viewer || !of_light) return std::nullopt;
  if (!traits.has_operator) return *of_viewer + *of_light;
  // The mean over both orders of the directions counts. Lights that are tables see no more than their tables.
  return traits.takes_functions ? largest_light(lighting) * (*of_viewer + *of_light) / 2 : 0;
}

void add_unseen(const Eigen::VectorXd& roots, double weight, ChannelProducts& products) {
  products.gram_error += weight * roots * roots.transpose();
  for (Eigen::Index j = 0; j < roots.size(); ++j) {
    for (Eigen::Index i = 0; i < roots.size(); ++i) {
      if (i != j) products.squared_distance_error(i, j) += weight * std::pow(roots(i) + roots(j), 2);
    }
  }
}

}  // namespace lobe
