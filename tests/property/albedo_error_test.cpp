// Errors of albedos of formulas over random models, parameters, factors, angles and tolerances: none may be off by more
// than twice what is stated, one in a thousand by more than that. LOBE_ALBEDO_CASES and LOBE_ALBEDO_SEED make it a
// longer or another attack; it prints what it found.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "lobe/energy.hpp"
#include "lobe/error.hpp"
#include "lobe/model.hpp"
#include "lobe/pointwise.hpp"
#include "support/device.hpp"
#include "support/random_specifications.hpp"

namespace lobe::test {
namespace {

using std::numbers::pi;

constexpr double kDegree = pi / 180;

std::size_t number_of(const char* variable, std::size_t otherwise) {
  const char* text = std::getenv(variable);
  return text == nullptr ? otherwise : std::strtoull(text, nullptr, 10);
}

/// a(L) / pi is the composition with Lambert at any V: another integral of the same values, far finer.
std::optional<Estimate> reference(const Material& material, double theta) {
  try {
    const std::array<Directions, 1> pair{{{theta, 0.3, 1.0}}};
    Estimate value =
        composition_at(device(), material, parse_material("lambert"), pair, {.tolerance = 1e-10}).front()[0];
    return Estimate{pi * value.value, pi * value.error};
  } catch (const NumericError&) {
    return std::nullopt;
  }
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

void attack(Dice& dice, const Model& model, bool with_factors, Found& found) {
  std::string text = random_specification(dice, model);
  if (with_factors) text += "*" + random_specification(dice, factors()[dice.below(factors().size())]);
  const double theta = random_angle(dice);
  const double tolerance = dice.spread(1e-8, 1e-2);
  const std::array<double, 1> angles{theta};
  Estimate value;
  Material material;
  try {
    material = parse_material(text);
    value = albedo(device(), material, angles, {.tolerance = tolerance}).front().front();
  } catch (const Error&) {
    ++found.refused;
    return;
  }
  const auto expected = reference(material, theta);
  if (!expected) return;
  ++found.count;
  const double off = std::max(0.0, std::abs(value.value - expected->value) - expected->error);
  const double share = off / std::max(value.error, 1e-300);
  found.worst = std::max(found.worst, share);
  if (share > 1) {
    ++found.above;
    std::cout << text << " at " << theta / kDegree << " degrees, tolerance " << tolerance << ": " << value.value
              << " ± " << value.error << ", is " << expected->value << " ± " << expected->error << ": " << share
              << "\n";
  }
  EXPECT_LE(share, 2) << text << " at " << theta / kDegree << " degrees, tolerance " << tolerance;
}

bool is_taken(const Model& model) {
  return !model.traits.has_delta && model.traits.isotropic && model.traits.reciprocal;
}

TEST(AlbedoErrors, HoldForRandomMaterialsAnglesAndTolerances) {
  const std::size_t cases = number_of("LOBE_ALBEDO_CASES", 40);
  Dice dice(number_of("LOBE_ALBEDO_SEED", 20));
  std::vector<const Model*> models;
  for (const Model& model : catalogue()) {
    if (is_taken(model)) models.push_back(&model);
  }
  Found found;
  for (std::size_t k = 0; k < cases; ++k) {
    // Programs are compiled for each model and factor: a short attack takes models alone.
    attack(dice, *models[dice.below(models.size())], cases > 100 && dice.below(2) == 1, found);
  }
  std::cout << found.count << " albedos, " << found.refused << " refused; " << found.above
            << " off by more than stated, the worst by " << found.worst << "\n";
  EXPECT_LE(1000 * found.above, std::max<std::size_t>(found.count, 1000));
  EXPECT_GT(found.count, cases / 2);
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

TEST(AlbedoErrors, HoldForMeansWhereTwoLevelsAgreedByAccident) {
  const double s = 0.00204513;
  const Estimate found = mean_albedo(device(), parse_material("lacquer:s=0.00204513")).front();
  EXPECT_NEAR(found.value, std::pow(2 * exponential_integral_3(s), 2), found.error + 1e-12);
}

}  // namespace
}  // namespace lobe::test
