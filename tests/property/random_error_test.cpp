// Errors of albedos, mean albedos and products of formulas over random models, parameters, factors, sums, angles and
// tolerances: none may be off by more than twice what is stated, one in a thousand by more than that.
// LOBE_ATTACK_CASES and LOBE_ATTACK_SEED make it a longer or another attack; it prints what it found.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/text.hpp"
#include "energy/albedo.hpp"
#include "lobe/algebra/pointwise.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"
#include "lobe/energy/albedo.hpp"
#include "lobe/metric/metric.hpp"
#include "lobe/model/model.hpp"
#include "lobe/reflectance/as_function.hpp"
#include "lobe/reflectance/composition.hpp"
#include "reference/quadrature.hpp"
#include "support/attack.hpp"
#include "support/device.hpp"
#include "support/random_specifications.hpp"
#include "support/scale.hpp"

namespace lobe::test {
namespace {

using std::numbers::pi;

/// Compositions over X for light from each angle, and view at an angle (that of the light by default) and an azimuth.
std::vector<Estimate> compositions(const Material& f, const Material& g, std::span<const double> theta_in,
                                   std::optional<double> theta_out, double delta_phi, double tolerance) {
  std::vector<Directions> pairs;
  for (const double theta : theta_in) pairs.push_back({theta, theta_out.value_or(theta), delta_phi});
  return composition_at(device(), f, g, pairs, {.tolerance = tolerance}).front();
}

/// a(L) / pi is the composition with Lambert at any V: another integral of the same values, far finer.
std::vector<Estimate> albedos(const Material& material, std::span<const double> theta_in, double tolerance = 1e-10) {
  auto values = compositions(material, parse_material("lambert"), theta_in, 0.3, 1, tolerance);
  for (Estimate& value : values) value = {pi * value.value, pi * value.error};
  return values;
}

/// Of the integrals of compositions over a hemisphere, each of which takes a hundred.
constexpr double kIntegralTolerance = 1e-7;

/// Integral of g dmu = 2 pi integral of g(theta) cos(theta) sin(theta) dtheta: panels are halved until Gauss rules of
/// 7 and 15 nodes agree.
template <typename Function>
Estimate hemisphere_integral(const Function& g) {
  struct Panel {
    double from = 0;
    double to = 0;
    Estimate integral;
  };
  const auto coarse = reference::gauss_legendre(7);
  const auto fine = reference::gauss_legendre(15);
  const auto integrate = [&](std::vector<Panel>& panels) {
    std::vector<double> angles;
    for (const Panel& panel : panels) {
      for (const auto* rule : {&coarse, &fine}) {
        for (const double x : rule->nodes) angles.push_back(panel.from + (panel.to - panel.from) * (1 + x) / 2);
      }
    }
    const std::vector<Estimate> values = g(angles);
    std::size_t next = 0;
    for (Panel& panel : panels) {
      std::array<double, 2> sums{};
      double error = 0;
      for (std::size_t r = 0; r < 2; ++r) {
        for (const double weight : (r == 0 ? coarse : fine).weights) {
          const double w =
              2 * pi * weight * (panel.to - panel.from) / 2 * std::cos(angles[next]) * std::sin(angles[next]);
          sums[r] += w * values[next].value;
          if (r == 1) error += w * values[next].error;
          ++next;
        }
      }
      panel.integral = {sums[1], std::abs(sums[1] - sums[0]) + error};
    }
  };
  std::vector<Panel> panels;
  for (const double to : {30., 60., 80., 88., 89.6, 89.97, 90.}) {
    panels.push_back({panels.empty() ? 0 : panels.back().to, to * kDegree, {}});
  }
  integrate(panels);
  const auto sum = [&] {
    Estimate all;
    for (const Panel& panel : panels) all = {all.value + panel.integral.value, all.error + panel.integral.error};
    return all;
  };
  for (int round = 0; round < 12; ++round) {
    const Estimate all = sum();
    std::vector<Panel> halves;
    std::vector<Panel> kept;
    for (const Panel& panel : panels) {
      if (panel.integral.error * static_cast<double>(panels.size()) < kIntegralTolerance * std::abs(all.value)) {
        kept.push_back(panel);
        continue;
      }
      const double middle = (panel.from + panel.to) / 2;
      halves.push_back({panel.from, middle, {}});
      halves.push_back({middle, panel.to, {}});
    }
    if (halves.empty()) break;
    integrate(halves);
    kept.insert(kept.end(), halves.begin(), halves.end());
    panels = std::move(kept);
  }
  return sum();
}

/// f . g is the trace of the composition, integral of C_{f,g}(L, L) dmu(L), where both are reciprocal.
Estimate product_by_composition(const Material& f, const Material& g) {
  return hemisphere_integral([&](std::span<const double> angles) {
    return compositions(f, g, angles, std::nullopt, 0, kIntegralTolerance / 10);
  });
}

/// Integral of a_f a_g dmu.
Estimate daylight_by_composition(const Material& f, const Material& g) {
  return hemisphere_integral([&](std::span<const double> angles) {
    auto values = albedos(f, angles, kIntegralTolerance / 10);
    const auto others = albedos(g, angles, kIntegralTolerance / 10);
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i] = {values[i].value * others[i].value,
                   std::abs(values[i].value) * others[i].error + std::abs(others[i].value) * values[i].error};
    }
    return values;
  });
}

/// An angle of incidence: any, one towards grazing to 89.99 degrees, or the normal.
double random_angle(Dice& dice) {
  switch (dice.below(5)) {
    case 0:
      return 0;
    case 1:
      return (90 - dice.spread(0.01, 20)) * kDegree;
    case 2:
      return dice.spread(0.01, 20) * kDegree;
    default:
      return dice.uniform(0, 89.99) * kDegree;
  }
}

/// E_3(s) = integral of exp(-s t) / t^3 dt from 1 on, by its recurrence from E_1.
double exponential_integral_3(double s) {
  const double e1 = -std::expint(-s);
  const double e2 = std::exp(-s) - s * e1;
  return (std::exp(-s) - s * e2) / 2;
}

/// exp(-s) 2 E_3(s): the albedo of exp(-s (1/N.L + 1/N.V)) / pi.
double lacquer_at_normal(double s) {
  return 2 * std::exp(-s) * exponential_integral_3(s);
}

struct Found {
  std::size_t count = 0;
  std::size_t refused = 0;
  std::size_t above = 0;
  double worst = 0;
};

/// What the library says of a number, what it is, and in words what number it is.
struct RandomCase {
  std::string text;
  Estimate found;
  Estimate expected;
};

class Attack {
 public:
  Attack(Dice& dice, bool is_long) : dice_(dice), is_long_(is_long) {
    for (const Model& model : catalogue()) {
      if (!model.traits.has_delta && model.traits.reciprocal) {
        (model.traits.isotropic ? isotropic_ : anisotropic_).push_back(&model);
      }
    }
  }

  /// \throws Error where the library has no such number or the reference does not.
  [[nodiscard]] RandomCase albedo_case() {
    const std::string text = isotropic_text();
    const std::array<double, 1> theta{random_angle(dice_)};
    const double tolerance = dice_.spread(1e-8, 1e-2);
    const auto material = parse_material(text);
    return {describe(text + " at " + shortest(theta[0] / kDegree) + " degrees", tolerance),
            albedo(device(), material, theta, {.tolerance = tolerance}).front().front(),
            albedos(material, theta).front()};
  }

  [[nodiscard]] RandomCase anisotropic_albedo_case() {
    const std::string text = random_specification(dice_, *anisotropic_[dice_.below(anisotropic_.size())]);
    const std::array<Direction, 1> light{{{random_angle(dice_), dice_.uniform(0, 2 * pi)}}};
    const double tolerance = dice_.spread(1e-6, 1e-2);
    const auto material = parse_material(text);
    const auto expected = albedo(as_function(device(), material), light, 1e-3).front().front();
    return {describe(text + " at " + shortest(light[0].theta / kDegree) + ", " + shortest(light[0].phi / kDegree) +
                         " degrees",
                     tolerance),
            albedo(device(), material, light, {.tolerance = tolerance}).front().front(), expected};
  }

  [[nodiscard]] RandomCase mean_albedo_case() {
    const std::string text = isotropic_text();
    const double tolerance = dice_.spread(1e-6, 1e-2);
    const auto material = parse_material(text);
    const auto found = mean_albedo(device(), material, {.tolerance = tolerance}).front();
    return {describe("mean of " + text, tolerance), found, product_by_composition(material, parse_material("lambert"))};
  }

  [[nodiscard]] RandomCase product_case() {
    const std::string first = isotropic_text();
    const std::string second = isotropic_text();
    const bool daylight = dice_.below(2) == 1;
    const double tolerance = dice_.spread(1e-6, 1e-2);
    const auto f = parse_material(first);
    const auto g = parse_material(second);
    const auto found =
        scalar_product(device(), f, g, daylight ? Lighting::daylight() : Lighting::point(), {.tolerance = tolerance});
    return {describe(first + " . " + second + (daylight ? " in daylight" : ""), tolerance), found,
            daylight ? daylight_by_composition(f, g) : product_by_composition(f, g)};
  }

 private:
  /// A model; in a long attack also with a factor, or the sum of two. Programs are compiled for each: a short one takes
  /// models alone.
  std::string isotropic_text() {
    const auto model = [&] { return random_specification(dice_, *isotropic_[dice_.below(isotropic_.size())]); };
    const std::string text = model();
    if (!is_long_) return text;
    switch (dice_.below(4)) {
      case 0:
        return text + "*" + random_specification(dice_, factors()[dice_.below(factors().size())]);
      case 1:
        return text + "+" + model();
      default:
        return text;
    }
  }

  static std::string describe(const std::string& what, double tolerance) {
    return what + ", tolerance " + shortest(tolerance);
  }

  Dice& dice_;
  bool is_long_ = false;
  std::vector<const Model*> isotropic_;
  std::vector<const Model*> anisotropic_;
};

void grade(const RandomCase& c, Found& found) {
  ++found.count;
  const double off = std::max(0.0, std::abs(c.found.value - c.expected.value) - c.expected.error);
  const double share = off / std::max(c.found.error, 1e-300);
  found.worst = std::max(found.worst, share);
  if (share > 1) {
    ++found.above;
    std::cout << c.text << ": " << shortest(c.found.value) << " ± " << shortest(c.found.error) << ", is "
              << shortest(c.expected.value) << " ± " << shortest(c.expected.error) << ": " << share << "\n";
  }
  EXPECT_LE(share, 2) << c.text;
}

void expect_few_above(const char* what, std::size_t cases, RandomCase (Attack::*draw)(), std::uint64_t offset) {
  Dice dice(number_from("LOBE_ATTACK_SEED", 20) + offset);
  Attack attack(dice, cases > 100);
  Found found;
  for (std::size_t k = 0; k < cases; ++k) {
    try {
      grade((attack.*draw)(), found);
    } catch (const Error&) {
      ++found.refused;
    }
  }
  std::cout << found.count << " " << what << ", " << found.refused << " refused; " << found.above
            << " off by more than stated, the worst by " << found.worst << "\n";
  EXPECT_LE(1000 * found.above, std::max<std::size_t>(found.count, 1000));
  EXPECT_GE(3 * found.count, cases);
}

TEST(RandomErrors, OfAlbedosHold) {
  expect_few_above("albedos", number_from("LOBE_ATTACK_CASES", 40), &Attack::albedo_case, 0);
}

TEST(RandomErrors, OfAnisotropicAlbedosHold) {
  expect_few_above("anisotropic albedos", number_from("LOBE_ATTACK_CASES", 12), &Attack::anisotropic_albedo_case, 1);
}

TEST(RandomErrors, OfMeanAlbedosHold) {
  expect_few_above("mean albedos", number_from("LOBE_ATTACK_CASES", swept(6, 2)), &Attack::mean_albedo_case, 2);
}

TEST(RandomErrors, OfProductsHold) {
  expect_few_above("products", number_from("LOBE_ATTACK_CASES", swept(6, 2)), &Attack::product_case, 3);
}

void expect_albedo(const std::string& text, double degrees, double expected, double known) {
  const std::array<double, 1> angles{degrees * kDegree};
  const Estimate found = albedo(device(), parse_material(text), angles).front().front();
  EXPECT_NEAR(found.value, expected, found.error + known) << text;
  EXPECT_LE(found.error, 1e-6 * found.value) << text;
}

// The levels 6, 8, 10, ... of Gauss nodes per panel agreed by accident.
TEST(AlbedoErrors, HoldWhereTwoLevelsAgreedByAccident) {
  expect_albedo("lacquer:s=0.0153814", 0, lacquer_at_normal(0.0153814), 1e-12);
  expect_albedo("tobler_power:n=20", 89.9, 1, 1e-12);
}

// An estimate is that of a panel's two rules times a safety that was chosen (kPanelSafety of lib/src/energy); of 1768
// albedos of random formulas this one was off by the largest share of its estimate, 0.27.
TEST(AlbedoErrors, HaveTheSafetyThatWasChosen) {
  const auto material = parse_material(
      "hapke:w=0.09670801812141945,b=0.025298667842505146,c=0.5543762546883668,b0=0.049465778366054404,"
      "h=0.0030209196756089455,theta_bar=0.0015589295602219603");
  const std::array<double, 1> angles{1.4131966};
  const Estimate found = albedo(device(), material, angles, {.tolerance = 1e-3}).front().front();
  const Estimate expected = albedo(device(), material, angles, {.tolerance = 1e-10}).front().front();
  const double off = std::abs(found.value - expected.value);
  ASSERT_LT(expected.error, 0.1 * off);
  EXPECT_GT(off / found.error, 0.18);
  EXPECT_LT(off / found.error, 0.36);
}

// Squares of errors below 1e-154 are 0: the estimate was that of rounding, 1e-12 of the value, and 4e-9 was wrong.
TEST(AlbedoErrors, HoldWhereSquaresOfErrorsVanish) {
  const auto material = parse_material("lafortune:c_xy=0.6357517923396641,c_z=0.7939681014833357,n=1200");
  const std::array<double, 1> angles{47.769544 * kDegree};
  const Estimate found = albedo(device(), material, angles, {.tolerance = 5e-4}).front().front();
  const Estimate expected = albedos(material, angles).front();
  EXPECT_NEAR(found.value / expected.value, 1, (found.error + expected.error) / expected.value);
  EXPECT_LT(found.value, 1e-154);
}

TEST(AlbedoErrors, HoldForMeansWhereTwoLevelsAgreedByAccident) {
  const double s = 0.00204513;
  const Estimate found = mean_albedo(device(), parse_material("lacquer:s=0.00204513")).front();
  EXPECT_NEAR(found.value, std::pow(2 * exponential_integral_3(s), 2), found.error + 1e-12);
}

/// Ridges 3 to 160 times longer than wide, as functions, against their formulas.
RandomCase ridge_case(Dice& dice) {
  const double narrow = dice.spread(0.025, 0.16);
  const double wide = dice.spread(0.5, 3.9);
  const std::string text = "ward_anisotropic:m_x=" + shortest(wide) + ",m_y=" + shortest(narrow) +
                           ",rotation=" + shortest(dice.uniform(0, 3));
  const std::array<Direction, 1> light{{{dice.uniform(0, 85) * kDegree, dice.uniform(0, 2 * pi)}}};
  const auto material = parse_material(text);
  return {text + " at " + shortest(light[0].theta / kDegree) + ", " + shortest(light[0].phi / kDegree) + " degrees",
          albedo(as_function(device(), material), light, dice.below(2) == 0 ? 1e-3 : 1).front().front(),
          albedo(device(), material, light, {.tolerance = 1e-7}).front().front()};
}

// Ridges ran on unseen between the nodes of large rectangles: a sixth of these were off by more than stated, by factors
// up to thousands.
TEST(AlbedoErrors, HoldForRidgesOfFunctions) {
  Dice dice(number_from("LOBE_ATTACK_SEED", 20));
  Found found;
  for (std::size_t k = 0; k < number_from("LOBE_ATTACK_CASES", 100); ++k) {
    const RandomCase ridge = ridge_case(dice);
    const double off = std::max(0.0, std::abs(ridge.found.value - ridge.expected.value) - ridge.expected.error);
    ++found.count;
    found.above += off > ridge.found.error ? 1 : 0;
    found.worst = std::max(found.worst, off / ridge.found.error);
  }
  std::cout << found.count << " ridges; " << found.above << " off by more than stated, the worst by " << found.worst
            << "\n";
  EXPECT_LE(100 * found.above, 2 * found.count);  // those narrower than any nodes see from there
}

// Rules that miss much of a ridge do so in all cells along it: their errors have one sign.
TEST(AlbedoErrors, HoldForARidgeThatCellsAreTooLargeFor) {
  const auto material = parse_material(
      "ggx_anisotropic:alpha_x=0.3958146882627695,alpha_y=0.00516391284471564,rotation=-0.27251232778948853");
  const std::array<Direction, 1> light{{{13.725349654193847 * kDegree, 189.02477731586663 * kDegree}}};
  const Estimate found = albedo(as_function(device(), material), light, 1e-3).front().front();
  EXPECT_NEAR(found.value, albedo(device(), material, light, {.tolerance = 1e-7}).front().front().value, found.error);
}

// Off by 2.7 times what was stated.
TEST(AlbedoErrors, HoldForARidgeThatNoNodeSaw) {
  const auto material =
      parse_material("ward_anisotropic:m_x=3.984269057597725,m_y=0.05112297872648524,rotation=0.742799343946742");
  const std::array<Direction, 1> light{{{73.4135042850531 * kDegree, 243.0908477994459 * kDegree}}};
  const Estimate found = albedo(as_function(device(), material), light, 1e-3).front().front();
  EXPECT_NEAR(found.value, 0.1381245459, found.error);
  EXPECT_LE(found.error, 1e-2 * found.value);
}

}  // namespace
}  // namespace lobe::test
