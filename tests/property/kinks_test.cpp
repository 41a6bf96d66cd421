// Places where reflectances are not smooth: the catalogue declares all of them, as random slices through pairs of
// directions find, and products, norms and albedos have errors that hold in spite of them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "core/text.hpp"
#include "hemisphere/kink.hpp"
#include "lobe/energy/albedo.hpp"
#include "lobe/metric/metric.hpp"
#include "lobe/model/model.hpp"
#include "model/evaluate.hpp"
#include "model/lobes.hpp"
#include "reference/kinked.hpp"
#include "reference/quadrature.hpp"
#include "support/device.hpp"
#include "support/estimates.hpp"
#include "support/random_specifications.hpp"
#include "support/scale.hpp"

namespace lobe::test {
namespace {

using std::numbers::pi;

std::size_t number_of(const char* variable, std::size_t otherwise) {
  const char* text = std::getenv(variable);
  return text == nullptr ? otherwise : std::strtoull(text, nullptr, 10);
}

using Vector = std::array<double, 3>;

double dot(const Vector& a, const Vector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Vector random_direction(Dice& dice) {
  const double z = dice.below(3) == 0 ? dice.spread(0.02, 1) : dice.uniform(0.02, 1);
  const double phi = dice.uniform(-pi, pi);
  const double r = std::sqrt(1 - z * z);
  return {r * std::cos(phi), r * std::sin(phi), z};
}

/// A path through pairs of directions: both go straight, but for their lengths.
struct Slice {
  std::array<Vector, 2> from, to;

  [[nodiscard]] Vector at(std::size_t which, double t) const {
    Vector v{};
    for (std::size_t k = 0; k < 3; ++k) v[k] = from[which][k] + t * (to[which][k] - from[which][k]);
    const double length = std::sqrt(dot(v, v));
    for (double& component : v) component /= length;
    return v;
  }

  [[nodiscard]] Directions directions(double t) const {
    const auto theta = [](const Vector& v) { return std::atan2(std::hypot(v[0], v[1]), v[2]); };
    const auto phi = [](const Vector& v) { return std::atan2(v[1], v[0]); };
    const Vector in = at(0, t);
    const Vector out = at(1, t);
    return {theta(in), theta(out), phi(out) - phi(in), phi(in)};
  }

  [[nodiscard]] KinkPair pair(double t) const {
    const Vector in = at(0, t);
    const Vector out = at(1, t);
    return {in[2], out[2], dot(in, out), in[0], in[1], out[0], out[1]};
  }
};

/// Functions that change sign where all rules have limits, or where the lobes say that they are not smooth.
std::vector<std::function<double(const KinkPair&)>> known_limits(const LobeSet& lobes, bool with_declared) {
  std::vector<std::function<double(const KinkPair&)>> limits{
      [](const KinkPair& p) { return p.cos_i - p.cos_o; },
      [](const KinkPair& p) { return p.cos_between - p.cos_i * p.cos_o; }};
  if (lobes.common.mirror_cosine && with_declared) {
    limits.emplace_back([](const KinkPair& p) { return p.cos_between - 2 * p.cos_i * p.cos_o; });
  }
  if (lobes.common.attenuation && with_declared) {
    // 2 N.H min(N.L, N.V) = L.H
    limits.emplace_back(
        [](const KinkPair& p) { return 2 * (p.cos_i + p.cos_o) * std::min(p.cos_i, p.cos_o) - 1 - p.cos_between; });
  }
  if (lobes.narrowest_retro < 1) limits.emplace_back([](const KinkPair& p) { return p.cos_between; });
  for (const double radius : lobes.patch_radii) {
    limits.emplace_back([=](const KinkPair& p) {
      const double sum = p.cos_i + p.cos_o;
      return 2 * (1 + p.cos_between) - sum * sum - radius * radius;
    });
  }
  for (const double radius : lobes.retro_patch_radii) {
    limits.emplace_back([=](const KinkPair& p) {
      const double difference = p.cos_i - p.cos_o;
      return 2 * (1 - p.cos_between) - difference * difference - radius * radius;
    });
  }
  for (const PatchEdge& edge : lobes.patch_edges) {
    limits.emplace_back([=](const KinkPair& p) {
      const double x = p.in_x + p.out_x;
      const double y = p.in_y + p.out_y;
      return std::hypot(x, y) - edge.reach(std::atan2(y, x));
    });
    for (const double axis : {edge.rotation, edge.rotation + pi / 2}) {
      limits.emplace_back(
          [=](const KinkPair& p) { return (p.in_y + p.out_y) * std::cos(axis) - (p.in_x + p.out_x) * std::sin(axis); });
    }
  }
  for (const PatchEdge& edge : lobes.retro_patch_edges) {
    limits.emplace_back([=](const KinkPair& p) {
      const double x = p.out_x - p.in_x;
      const double y = p.out_y - p.in_y;
      return std::hypot(x, y) - edge.reach(std::atan2(y, x));
    });
  }
  if (with_declared) {
    for (const Kink& kink : lobes.kinks) limits.emplace_back([=](const KinkPair& p) { return kink(p); });
  }
  return limits;
}

/// Second differences of step h against those of 2 h: of the order of h^4 where the values are smooth.
std::vector<double> roughness(const std::vector<double>& values) {
  std::vector<double> result(values.size(), 0);
  for (std::size_t k = 2; k + 2 < values.size(); ++k) {
    const double fine = values[k - 1] - 2 * values[k] + values[k + 1];
    const double coarse = values[k - 2] - 2 * values[k] + values[k + 2];
    result[k] = std::abs(coarse - 4 * fine);
  }
  return result;
}

double middle_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

/// A stretch of a slice under the lens.
struct Lens {
  const Slice* slice;
  double middle;
  double step;
  double last = 0;     ///< largest roughness before
  int not_smooth = 0;  ///< how many times in a row it has not fallen as that of a smooth function
};

/// Where along slices a material is not smooth although nothing says so: looks nearer and nearer at where second
/// differences are rough. Jumps of values and of derivatives of an order up to 2 are found.
std::vector<Lens> undeclared_kinks(const std::string& text, std::span<const Slice> slices, bool with_declared = true) {
  constexpr std::size_t kFirst = 257;
  constexpr std::size_t kPoints = 65;
  constexpr double kCloser = 4;
  constexpr int kStages = 7;
  constexpr int kResolved = 3;        // from this stage on all lobes are
  constexpr double kSmooth = 80;      // falls by 256 where smooth, by 16 at a jump of the second derivative
  constexpr double kNoise = 3e-12;    // of values, relative to the largest of a stretch
  constexpr double kLeast = 1e-280;   // below, numbers lose their digits
  constexpr double kLocal = 30;       // times the median: what stands out
  constexpr std::size_t kPlaces = 3;  // of each slice
  const Material material = parse_material(text);
  const LobeSet lobes = make_lobe_set({&material, 1}, {.with_deltas = true, .with_anisotropic = true});
  const auto limits = known_limits(lobes, with_declared);
  const auto is_known = [&](const Lens& lens) {
    constexpr double kReach = 4;  // steps
    const KinkPair before = lens.slice->pair(lens.middle - kReach * lens.step);
    const KinkPair after = lens.slice->pair(lens.middle + kReach * lens.step);
    // About the mirror and the retro direction lobes have tips, which slices pass as near as chance has it.
    constexpr double kNear = 0.03;
    const KinkPair here = lens.slice->pair(lens.middle);
    if (std::hypot(here.in_x + here.out_x, here.in_y + here.out_y) < kNear) return true;
    if (std::hypot(here.in_x - here.out_x, here.in_y - here.out_y) < kNear) return true;
    return std::ranges::any_of(limits, [&](const auto& limit) { return limit(before) * limit(after) <= 0; });
  };

  std::vector<Lens> lenses;
  for (const Slice& slice : slices) lenses.push_back({&slice, 0.5, 1.0 / (kFirst - 1)});
  std::vector<Lens> found;
  for (int stage = 0; stage < kStages && !lenses.empty(); ++stage) {
    const std::size_t count = stage == 0 ? kFirst : kPoints;
    const auto at = [&](const Lens& lens, std::size_t k) {
      return lens.middle + (static_cast<double>(k) - static_cast<double>(count - 1) / 2) * lens.step;
    };
    std::vector<Directions> directions;
    for (const Lens& lens : lenses) {
      for (std::size_t k = 0; k < count; ++k) directions.push_back(lens.slice->directions(at(lens, k)));
    }
    const Eigen::MatrixXd values = evaluate(device(), material, directions);
    std::vector<Lens> next;
    for (std::size_t i = 0; i < lenses.size(); ++i) {
      const auto first = static_cast<Eigen::Index>(i * count);
      std::vector<double> here(values.data() + first, values.data() + first + static_cast<Eigen::Index>(count));
      const auto rough = roughness(here);
      double scale = 0;
      for (const double value : here) scale = std::max(scale, std::abs(value));
      const auto look_at = [&](std::size_t k) {
        Lens lens = lenses[i];
        lens.middle = at(lens, k);
        if (rough[k] <= kNoise * scale || scale < kLeast) return;
        lens.not_smooth = stage > 0 && rough[k] * kSmooth > lens.last ? lens.not_smooth + 1 : 0;
        lens.last = rough[k];
        if (stage >= kResolved) {
          // Rounding is rough everywhere, a steep slope towards the end of the stretch.
          if (rough[k] < kLocal * middle_of(rough) || k < count / 4 || k > 3 * count / 4) return;
          if (lens.not_smooth == 0 || is_known(lens)) return;
          if (lens.not_smooth > kResolved) {
            found.push_back(lens);
            return;
          }
        }
        lens.step /= kCloser;
        // The slice ends where directions do.
        const double reach = lens.step * static_cast<double>(kPoints / 2);
        lens.middle = std::clamp(lens.middle, reach, 1 - reach);
        next.push_back(lens);
      };
      if (stage > 0) {
        look_at(static_cast<std::size_t>(std::ranges::max_element(rough) - rough.begin()));
        continue;
      }
      std::vector<std::size_t> order;
      for (std::size_t k = 2; k + 2 < count; ++k) {
        if (rough[k] >= rough[k - 1] && rough[k] >= rough[k + 1]) order.push_back(k);
      }
      std::ranges::sort(order, std::greater<>(), [&](std::size_t k) { return rough[k]; });
      order.resize(std::min(order.size(), kPlaces));
      for (const std::size_t k : order) look_at(k);
    }
    lenses = std::move(next);
  }
  return found;
}

std::vector<Slice> random_slices(Dice& dice, std::size_t count) {
  std::vector<Slice> slices(count);
  for (Slice& slice : slices) {
    slice = {{random_direction(dice), random_direction(dice)}, {random_direction(dice), random_direction(dice)}};
  }
  return slices;
}

/// A value that is neither extreme nor makes a lobe narrower than slices resolve; often the lowest of them, where
/// powers are.
double moderate_value(Dice& dice, const Parameter& parameter) {
  const double high = std::min(parameter.maximum, 300.0);
  const double low = std::max(parameter.minimum, -300.0);
  if (low < 0) return dice.uniform(std::max(low, -10.0), std::min(high, 10.0));
  const double start = std::max(low, std::min(0.05, 0.05 * high));
  if (dice.below(3) == 0) return dice.uniform(start, std::min(high, 4 * start));
  return high > 10 * start ? dice.spread(start, high) : dice.uniform(low, high);
}

template <typename Entry>
std::string moderate_specification(Dice& dice, const Entry& entry) {
  std::string text(entry.name);
  for (std::size_t k = 0; k < entry.parameters.size(); ++k) {
    const Parameter& parameter = entry.parameters[k];
    double value = moderate_value(dice, parameter);
    if (parameter.default_value && dice.below(2) == 0) value = *parameter.default_value;
    text += (k == 0 ? ":" : ",") + std::string(parameter.name) + "=" + shortest(value);
  }
  return text;
}

std::string describe(const Lens& lens) {
  const Directions at = lens.slice->directions(lens.middle);
  const KinkPair pair = lens.slice->pair(lens.middle);
  return "theta_in " + shortest(at.theta_in) + ", theta_out " + shortest(at.theta_out) + ", delta_phi " +
         shortest(at.delta_phi) + ", phi_in " + shortest(at.phi_in) + " radians; N.L " + shortest(pair.cos_i) +
         ", N.V " + shortest(pair.cos_o) + ", L.V " + shortest(pair.cos_between);
}

TEST(RandomSlices, FindNoKinkThatAModelOrFactorDoesNotDeclare) {
  constexpr std::size_t kSlices = 12;
  Dice dice(number_of("LOBE_KINKS_SEED", 20));
  const std::size_t draws = number_of("LOBE_KINKS_DRAWS", 6);
  const auto attack = [&](const std::string& text) {
    const auto slices = random_slices(dice, kSlices);
    const auto found = undeclared_kinks(text, slices);
    EXPECT_TRUE(found.empty()) << text << " at " << describe(found.front());
  };
  for (const Model& model : catalogue()) {
    if (model.traits.has_delta) continue;
    for (std::size_t k = 0; k < draws; ++k) attack(moderate_specification(dice, model));
  }
  for (const FactorModel& factor : factors()) {
    for (std::size_t k = 0; k < draws; ++k) attack("lambert*" + moderate_specification(dice, factor));
  }
}

class Declared : public testing::TestWithParam<const char*> {};

TEST_P(Declared, KinkIsFoundBySlicesWhereItsDeclarationIsTakenAway) {
  Dice dice(20);
  const auto slices = random_slices(dice, 100);
  EXPECT_FALSE(undeclared_kinks(GetParam(), slices, false).empty());
  EXPECT_TRUE(undeclared_kinks(GetParam(), slices).empty());
}

INSTANTIATE_TEST_SUITE_P(
    Models, Declared,
    testing::Values("lafortune:c_xy=-0.837624,c_z=0.512639,n=1.46519", "lafortune:c_xy=0.8,c_z=-0.5,n=1",
                    "lafortune_ngan:c_xy=-1,c_z=0.3,n=1.2",
                    "lafortune_anisotropic:c_x=-1,c_y=-0.6,c_z=0.5,n=1.3,rotation=0.3",
                    "lafortune_matrix:m_xx=-0.5,m_yy=-0.8,m_zz=0.5,m_xz=0.3,n=1.5",
                    "metal_phong_anisotropic:n=1.5,c_x=0.6,c_y=1,c_z=0.8", "li_sparse", "cox_munk_anisotropic:wind=25",
                    "oren_nayar_full:sigma=1.5,rho=0.02", "bagher_sgd:alpha=0.3,p=1,f0=0.5,lambda=1,k=1.2,theta0=0.6",
                    "bagher_sgd:alpha=0.3,p=1,f0=0.5,f1=1,lambda=1,k=10,theta0=0.6", "tobler_power:n=1.5",
                    "patch_band:R=1.5,inner=0.3", "cook_torrance_fresnel:m=0.5,ior=0.7",
                    "metal_phong_fresnel:n=3,ior=0.7", "coated_metal:s=2,ior=0.7",
                    "beard_maxwell:sigma=0.3,tau=0.5,omega=0.5,ior=0.7", "lambert*fresnel:ior=0.7",
                    "lambert*transmission:ior=0.7", "lambert*f82:f0=0.1,tint=0", "hapke:w=0.3,theta_bar=0.3",
                    "cook_torrance:m=0.5", "cook_torrance_torrance_fresnel:m=0.7,ior=1.5,k=0",
                    "low_microfacet:A=1,B=20,C=0.3,ior=1.8", "phong:n=1.5", "metal_phong:n=2.5", "p_model:n=1,p=0.5",
                    "phong_bisector:n=1.2", "phong_mean:n=1.5,p=0.5", "metal_phong_fresnel:n=1.5,ior=1.5,k=0"));

/// Lobes whose cosine passes 0 away from R.V = 0 and L.V = 0.
constexpr std::array<reference::LafortuneLobe, 4> kLobes{
    {{-0.837624, 0.512639, 1.46519}, {-1, 0.4, 1}, {0.7, -0.3, 1.3}, {-0.6, -0.4, 0.7}}};

std::string specification(const reference::LafortuneLobe& lobe) {
  return "lafortune:c_xy=" + shortest(lobe.c_xy) + ",c_z=" + shortest(lobe.c_z) + ",n=" + shortest(lobe.n);
}

class KinkedLobe : public testing::TestWithParam<double> {};

Estimate product(const std::string& text, const Lighting& lighting, double tolerance) {
  const Material material = parse_material(text);
  return scalar_product(device(), material, material, lighting, {.tolerance = tolerance, .patch_tolerance = tolerance});
}

TEST_P(KinkedLobe, HasProductsInDaylightWithErrorsThatHold) {
  for (const auto& lobe : kLobes) {
    const Estimate found = product(specification(lobe), Lighting::daylight(), GetParam());
    SCOPED_TRACE(specification(lobe));
    EXPECT_NEAR(found.value, reference::lafortune_daylight(lobe), found.error);
    EXPECT_LE(found.error, GetParam() * found.value);
  }
}

TEST_P(KinkedLobe, HasProductsInPointLightWithErrorsThatHold) {
  for (const auto& lobe : kLobes) {
    const Estimate found = product(specification(lobe), Lighting::point(), GetParam());
    SCOPED_TRACE(specification(lobe));
    EXPECT_NEAR(found.value, reference::lafortune_point(lobe), found.error);
    EXPECT_LE(found.error, GetParam() * found.value);
  }
}

TEST_P(KinkedLobe, HasProductsInTheWidestPatchLightWithErrorsThatHold) {
  for (const auto& lobe : kLobes) {
    const Estimate found = product(specification(lobe), Lighting::patch(2), GetParam());
    SCOPED_TRACE(specification(lobe));
    EXPECT_NEAR(found.value, reference::lafortune_daylight(lobe) / pi, found.error);
    EXPECT_LE(found.error, GetParam() * found.value);
  }
}

TEST_P(KinkedLobe, HasAlbedosWithErrorsThatHold) {
  constexpr std::array<double, 4> kAngles{0.1, 0.5, 1.0, 1.5};
  for (const auto& lobe : kLobes) {
    const Material material = parse_material(specification(lobe));
    const auto found = albedo(device(), material, kAngles, {.tolerance = GetParam()}).front();
    for (std::size_t k = 0; k < kAngles.size(); ++k) {
      EXPECT_NEAR(found[k].value, reference::lafortune_albedo(lobe, kAngles[k]), found[k].error)
          << specification(lobe) << " at " << kAngles[k];
    }
    const Estimate mean = mean_albedo(device(), material, {.tolerance = GetParam()}).front();
    EXPECT_NEAR(mean.value, reference::lafortune_light(lobe) / pi, mean.error) << specification(lobe);
  }
}

/// As a matrix, which the rules for anisotropic lobes take.
std::string matrix_specification(const reference::LafortuneLobe& lobe) {
  return "lafortune_matrix:m_xx=" + shortest(lobe.c_xy) + ",m_yy=" + shortest(lobe.c_xy) +
         ",m_zz=" + shortest(lobe.c_z) + ",n=" + shortest(lobe.n);
}

constexpr reference::LafortuneLobe kMatrixLobe{-0.837624, 0.512639, 1.46519};

TEST_P(KinkedLobe, HasAlbedosWithErrorsThatHoldByTheRulesForAnisotropicLobes) {
  constexpr std::array<double, 3> kAngles{0.1, 0.7, 1.5};
  const auto found =
      albedo(device(), parse_material(matrix_specification(kMatrixLobe)), kAngles, {.tolerance = GetParam()}).front();
  for (std::size_t k = 0; k < kAngles.size(); ++k) {
    EXPECT_NEAR(found[k].value, reference::lafortune_albedo(kMatrixLobe, kAngles[k]), found[k].error) << kAngles[k];
    EXPECT_LE(found[k].error, 2 * GetParam() * found[k].value) << k;
  }
}

TEST_P(KinkedLobe, HasProductsWithErrorsThatHoldByTheRulesForAnisotropicLobes) {
  const double tolerance = std::max(GetParam(), 1e-5);  // what costs seconds
  const Estimate daylight = product(matrix_specification(kMatrixLobe), Lighting::daylight(), tolerance);
  EXPECT_NEAR(daylight.value, reference::lafortune_daylight(kMatrixLobe), daylight.error);
  const Estimate point = product(matrix_specification(kMatrixLobe), Lighting::point(), tolerance);
  EXPECT_NEAR(point.value, reference::lafortune_point(kMatrixLobe), point.error);
}

/// A coordinate from 0 to 1 and its derivative, with which powers at both ends become smooth, for the midpoint rule.
std::pair<double, double> smoothed(double u) {
  const double t = u * u * (3 - 2 * u);
  return {t * t * (3 - 2 * t), 6 * t * (1 - t) * 6 * u * (1 - u)};
}

/// Albedo of the power patch (Neumann 2001, eq. 5.12) at r = sin(theta): over distances d from L'_P in the base plane,
/// with the arc of each circle within the unit disc.
double power_patch_albedo(double n, double r) {
  constexpr int kSteps = 400;
  double sum = 0;
  const auto add = [&](double low, double high, const auto& arc) {
    for (int i = 0; i < kSteps; ++i) {
      const auto [t, stretch] = smoothed((i + 0.5) / kSteps);
      const double d = low + (high - low) * t;
      const double rest = (high - low) * (1 - t) + (1 - high);
      sum += (high - low) * stretch / kSteps * std::pow(rest, n) * d * arc(d);
    }
  };
  add(0, 1 - r, [](double) { return 2 * pi; });
  add(1 - r, 1, [r](double d) { return 2 * std::acos(std::clamp((d * d + r * r - 1) / (2 * d * r), -1.0, 1.0)); });
  return (n + 1) * (n + 2) / (2 * pi) * sum;
}

/// Integrals of a^2 dmu and a dmu of the power patch.
struct PowerPatchIntegrals {
  double squares = 0;
  double mean = 0;
};

PowerPatchIntegrals power_patch_integrals(double n) {
  constexpr int kSteps = 200;
  PowerPatchIntegrals sums;
  for (int i = 0; i < kSteps; ++i) {
    const auto [r, stretch] = smoothed((i + 0.5) / kSteps);
    const double albedo = power_patch_albedo(n, r);
    sums.squares += 2 * pi * r * stretch / kSteps * albedo * albedo;
    sums.mean += 2 * pi * r * stretch / kSteps * albedo;
  }
  return sums;
}

// Profiles that end as a fractional power: a rule that takes the end for a jump converges slower than it looks.
class PowerPatch : public testing::TestWithParam<double> {
 protected:
  const std::string text_ = "patch_power:n=" + shortest(GetParam());
  const PowerPatchIntegrals integrals_ = power_patch_integrals(GetParam());
};

TEST_P(PowerPatch, HasProductsInDaylightWithErrorsThatHold) {
  for (const double tolerance : {1e-3, 1e-4, 1e-5, 1e-6}) {
    const Estimate daylight = product(text_, Lighting::daylight(), tolerance);
    EXPECT_NEAR(daylight.value, integrals_.squares, daylight.error + 1e-9) << tolerance;
    const Estimate means = product(text_, Lighting::mean_albedo(), tolerance);
    EXPECT_NEAR(means.value, integrals_.mean * integrals_.mean, means.error + 1e-8) << tolerance;
  }
}

INSTANTIATE_TEST_SUITE_P(Exponents, PowerPatch, testing::Values(0.03, 0.05, 0.3, 0.6332342500913513, 1.5, 2.5));

class PowerPatchInPatchLight : public PowerPatch {};

TEST_P(PowerPatchInPatchLight, HasProductsInTheWidestWithErrorsThatHold) {
  for (const double tolerance : swept_of<double>({1e-5, 1e-6}, 2)) {
    const Estimate found = product(text_, Lighting::patch(2), tolerance);
    EXPECT_NEAR(found.value, integrals_.squares / pi, found.error + 1e-9) << tolerance;
    EXPECT_LE(found.error, tolerance * found.value) << tolerance;
  }
}

INSTANTIATE_TEST_SUITE_P(Exponents, PowerPatchInPatchLight,
                         testing::ValuesIn(swept_of<double>({0.6332342500913513, 0.03, 0.3, 0.05, 1.5, 2.5}, 3)));

/// Schlick's term with the edge tint of OpenPBR 1.1, at x = L.H: below 0, where the bound is, for a range of x.
double edge_tint_factor(double f0, double tint, double x) {
  const double drop = (1 - tint) * (f0 + (1 - f0) * std::pow(6.0 / 7, 5)) * std::pow(7.0, 7) / std::pow(6.0, 6);
  return std::max(0.0, f0 + (1 - f0) * std::pow(1 - x, 5) - drop * x * std::pow(1 - x, 6));
}

/// Albedo of the power patch times that factor, in the same coordinates: distances from L'_P and azimuths about it.
double tinted_patch_albedo(double n, double f0, double tint, double theta) {
  constexpr int kDistances = 100;
  constexpr int kAzimuths = 50;
  const double r = std::sin(theta);
  double sum = 0;
  const auto add = [&](double low, double high) {
    for (int i = 0; low < high && i < kDistances; ++i) {
      const auto [u, stretch_d] = smoothed((i + 0.5) / kDistances);
      const double d = low + (high - low) * u;
      const double arc = std::acos(std::clamp((d * d + r * r - 1) / (2 * d * r), -1.0, 1.0));
      double mean = 0;
      for (int k = 0; k < kAzimuths; ++k) {
        const auto [share, stretch] = smoothed((k + 0.5) / kAzimuths);  // with a root at the horizon
        const double along = d * std::cos(arc * share);
        const double cos_o = std::sqrt(std::max(0.0, 1 - d * d - r * r + 2 * r * along));
        const double cos_between = std::cos(theta) * cos_o - r * (r - along);
        mean += stretch / kAzimuths * edge_tint_factor(f0, tint, std::sqrt((1 + cos_between) / 2));
      }
      sum += (high - low) * stretch_d / kDistances * std::pow(1 - d, n) * d * 2 * arc * mean;
    }
  };
  const double reach = std::min(1.0, 36 / n);  // beyond it the profile is 1e-16
  const double touching = std::min(1 - r, reach);
  add(0, touching);
  add(touching, reach);
  return (n + 1) * (n + 2) / (2 * pi) * sum;
}

// The albedo of a narrow lobe bends within its width where the mirror direction passes a kink. What the reference is
// off by was found from twice as many nodes.
TEST(NarrowLobe, HasProductsWithErrorsThatHoldWhereItsMiddlePassesAKink) {
  constexpr double kReference = 2e-6;
  constexpr double kNarrow = 444.55764221229396;
  constexpr double kF0 = 0.008203966804672497;
  constexpr double kTint = 0.0204545283168264;
  const auto light = [&](double theta) {
    return pi * std::sin(2 * theta) * tinted_patch_albedo(kNarrow, kF0, kTint, theta);
  };
  const double expected = reference::integrate(light, 0, pi / 2, 1e-8);
  const Material narrow =
      parse_material("patch_power:n=" + shortest(kNarrow) + "*f82:f0=" + shortest(kF0) + ",tint=" + shortest(kTint));
  constexpr double kTolerance = 5e-3;
  const Estimate found =
      scalar_product(device(), parse_material("lambert"), narrow, Lighting::daylight(), {.tolerance = kTolerance});
  EXPECT_NEAR(found.value, expected, found.error + kReference * expected);
  EXPECT_LE(found.error, kTolerance * found.value);
}

TEST(FractionalEdge, HasMeanAlbedosWithErrorsThatHold) {
  // Tobler's power reflects all light from everywhere, whatever its exponent (Neumann 2001, eq. 1.71).
  const Material material = parse_material("tobler_power:n=0.439487+lambert:scale=0.270711");
  const Estimate product =
      scalar_product(device(), material, material, Lighting::mean_albedo(), {.tolerance = 4.516e-5});
  const double mean_albedo = std::numbers::pi * 1.270711;
  EXPECT_NEAR(product.value, mean_albedo * mean_albedo, product.error);
}

// Levels of 6 and 8 nodes agree here by accident.
TEST(FractionalEdge, HasProductsInPointLightWithErrorsThatHoldAtLooseTolerances) {
  const Material kinked = parse_material("lafortune_ngan:c_xy=-0.685012,c_z=-0.477499,n=0.121659");
  const Material patch = parse_material("patch_power:n=0.0410343");
  const auto at = [&](double tolerance) {
    return scalar_product(device(), kinked, patch, Lighting::point(), {.tolerance = tolerance});
  };
  const Estimate loose = at(2.2e-4);
  const Estimate tight = at(1e-5);
  EXPECT_NEAR(loose.value, tight.value, loose.error + tight.error);
}

/// A norm of a pumped lobe, and what it is: the root of the trace of the composition with itself, or of the integral of
/// the squares of albedos, by five Gauss nodes on each of 126 to 506 panels of the angle of incidence.
struct PumpedNorm {
  const char* name;
  const char* material;
  Lighting lighting;
  double tolerance;
  double value;
  double error;
};

class PumpedLobe : public testing::TestWithParam<PumpedNorm> {};

// Divisors bend where they go over from an albedo to a cosine. Norms were off by up to 3.5 times what was stated, and
// missed tolerances below 2e-4.
TEST_P(PumpedLobe, HasNormsWithErrorsThatHoldThoughItsDivisorBends) {
  const PumpedNorm& expected = GetParam();
  const Estimate square = product(expected.material, expected.lighting, expected.tolerance);
  EXPECT_NEAR(square.value, std::pow(expected.value, 2), square.error + 2 * expected.value * expected.error);
  EXPECT_LE(square.error, expected.tolerance * square.value);
}

INSTANTIATE_TEST_SUITE_P(
    Corrections, PumpedLobe,
    testing::Values(
        PumpedNorm{"controlled_twice", "cook_torrance:m=5.59298,f0=0.212306@pump:correction=controlled,times=2",
                   Lighting::point(), 1.2e-4, 0.7355192, 1e-7},
        PumpedNorm{"g2", "ggx:alpha=0.5@pump:correction=g2", Lighting::point(), 1e-6, 1.07466148, 2e-8},
        PumpedNorm{"narrow", "ward:m=0.02@pump:correction=g2", Lighting::daylight(), 1e-6, 1.741286348, 3e-9}),
    [](const auto& instance) { return std::string(instance.param.name); });

class Tobler : public testing::TestWithParam<const char*> {};

TEST_P(Tobler, HasAlbedosAndProductsOfOneEverywhereBelowAPowerOf4) {
  constexpr std::array<double, 3> kAngles{0, 0.7, 1.5};
  const std::string text = std::string("tobler_power:n=") + GetParam();
  const Estimate daylight = product(text, Lighting::daylight(), 1e-6);
  EXPECT_NEAR(daylight.value, pi, daylight.error);
  EXPECT_LE(daylight.error, 1e-6 * pi);
  const Estimate patch = product(text, Lighting::patch(2), 1e-5);
  EXPECT_NEAR(patch.value, 1, patch.error);
  const auto albedos = albedo(device(), parse_material(text), kAngles);
  EXPECT_THAT(albedos.front(), testing::Each(EstimateCovers(1, 0)));
  EXPECT_THAT(albedos.front(), testing::Each(testing::Field(&Estimate::error, testing::Le(1e-6))));
}

INSTANTIATE_TEST_SUITE_P(Powers, Tobler, testing::Values("0.5", "1", "1.5", "3"));

INSTANTIATE_TEST_SUITE_P(Tolerances, KinkedLobe, testing::Values(1e-4, 1e-5, 1e-6));

}  // namespace
}  // namespace lobe::test
