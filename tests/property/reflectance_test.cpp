// What holds for every reflectance of the catalogue, whatever its formula.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "lobe/energy.hpp"
#include "lobe/evaluate.hpp"
#include "lobe/model.hpp"
#include "support/device.hpp"
#include "support/materials.hpp"
#include "support/names.hpp"

namespace lobe::test {
namespace {

using std::numbers::pi;

std::vector<Directions> random_directions() {
  std::mt19937 engine(7);
  std::uniform_real_distribution<double> theta(0, pi / 2);
  std::uniform_real_distribution<double> phi(-pi, pi);
  std::vector<Directions> list;
  for (int i = 0; i < 1000; ++i) list.push_back({theta(engine), theta(engine), phi(engine)});
  return list;
}

class Reflectance : public ::testing::TestWithParam<std::string> {};

TEST_P(Reflectance, IsReciprocal) {
  const auto forward = random_directions();
  std::vector<Directions> backward;
  for (const auto& d : forward) backward.push_back({d.theta_out, d.theta_in, -d.delta_phi});

  const auto f = evaluate(device(), parse_material(GetParam()), forward);
  const auto g = evaluate(device(), parse_material(GetParam()), backward);

  for (Eigen::Index i = 0; i < f.rows(); ++i) EXPECT_NEAR(f(i, 0), g(i, 0), 1e-13 * f(i, 0)) << "pair " << i;
}

TEST_P(Reflectance, IsFiniteAndNotNegative) {
  const auto values = evaluate(device(), parse_material(GetParam()), random_directions());

  EXPECT_TRUE(values.allFinite());
  EXPECT_GE(values.minCoeff(), 0);
}

TEST_P(Reflectance, IsLinearInItsScale) {
  const auto directions = random_directions();
  auto scaled = parse_material(GetParam());
  for (auto& term : scaled.terms) term.weight.at(0) *= 0.25;

  const auto values = evaluate(device(), parse_material(GetParam()), directions);

  EXPECT_EQ(evaluate(device(), scaled, directions), Eigen::MatrixXd(0.25 * values));
}

TEST_P(Reflectance, KeepsItsPromiseOfEnergyConservation) {
  const auto material = parse_material(GetParam());
  if (material.terms.size() > 1 || !find_model(material.terms[0].model).traits.conserves_energy) {
    SUCCEED() << "the catalogue promises nothing";
    return;
  }
  const std::vector<double> theta{0, 0.3, 0.8, 1.2, 1.5, 1.57};

  const auto values = albedo(device(), material, theta).at(0);

  for (std::size_t i = 0; i < theta.size(); ++i) EXPECT_LE(values[i].value, 1 + values[i].error) << theta[i] << " rad";
}

INSTANTIATE_TEST_SUITE_P(property, Reflectance, ::testing::ValuesIn(sample_specifications()),
                         [](const auto& instance) { return test_name(instance.param); });

}  // namespace
}  // namespace lobe::test
