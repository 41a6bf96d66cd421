// What makes products and distances a metric, under every kind of lighting, on random materials.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <ostream>
#include <string>
#include <vector>

#include "lobe/algebra/algebra.hpp"
#include "lobe/metric/metric.hpp"
#include "lobe/table/table.hpp"
#include "metric/table_metric.hpp"
#include "support/device.hpp"
#include "support/lightings.hpp"
#include "support/names.hpp"
#include "support/random_materials.hpp"
#include "support/tables.hpp"

namespace lobe::test {
namespace {

using std::numbers::pi;

constexpr int kTriples = 500;

/// Materials as they are measured under a lighting: by their formulas, or tabulated on the grid of a tabulated W.
MetricResult measured(const std::vector<Material>& materials, const Lighting& lighting) {
  if (lighting.kind() != Lighting::Kind::table) return measure(device(), materials, lighting);
  std::vector<BrdfTable> tables;
  for (const Material& material : materials) tables.push_back(table_of(material, lighting.table().grid));
  return measure(device(), tables, lighting);
}

/// W = F o F of a tabulated material: positive semi-definite, and none of the patch lights.
Lighting self_composed_lighting() {
  const BrdfTable f = table_of("phong:n=6", "gauss:8x16");
  return Lighting::table(compose(device(), f, f), "phong o phong");
}

struct Case {
  std::string name;
  std::function<Lighting()> lighting;
  double narrowest;  ///< width of the random lobes, radians: patch lights and grids are costly for narrow ones
  std::size_t materials = 60;
};
std::ostream& operator<<(std::ostream& out, const Case& c) {
  return out << c.name;
}

// Lightings under which no two reflectances have distance 0, and others.
const std::vector<Case>& norms() {
  static const std::vector<Case> list{{"point", &Lighting::point, 0.01},
                                      {"patch_0p5", [] { return Lighting::patch(0.5); }, 0.1},
                                      {"patch_1", [] { return Lighting::patch(1); }, 0.1},
                                      {"mixture", [] { return parse_lighting("mixture:0.7=0.3,1.2=0.7"); }, 0.1}};
  return list;
}
const std::vector<Case>& semi_norms() {
  static const std::vector<Case> list{{"daylight", &Lighting::daylight, 0.01},
                                      {"mean_albedo", &Lighting::mean_albedo, 0.01}};
  return list;
}
const std::vector<Case>& tabulated() {
  static const std::vector<Case> list{{"table", &self_composed_lighting, 0.3, 30}};
  return list;
}

class MetricAxioms : public ::testing::TestWithParam<Case> {
 protected:
  static std::vector<Material> materials() { return random_materials(GetParam().materials, GetParam().narrowest); }
  /// Measured once per lighting.
  static const MetricResult& result() {
    static std::map<std::string, MetricResult> results;
    const auto found = results.find(GetParam().name);
    if (found != results.end()) return found->second;
    return results.emplace(GetParam().name, measured(materials(), GetParam().lighting())).first->second;
  }
  /// What may be missing of an inequality between products of tables is rounding: they are discrete operators. Of
  /// materials it is what the entry's error says.
  static double known(double error, double size) {
    return result().lighting.kind() == Lighting::Kind::table ? 1e-13 * size : error;
  }
};
class NormAxioms : public MetricAxioms {};
class FormulaAxioms : public MetricAxioms {};

INSTANTIATE_TEST_SUITE_P(norm, MetricAxioms, ::testing::ValuesIn(norms()), ByName{});
INSTANTIATE_TEST_SUITE_P(semi_norm, MetricAxioms, ::testing::ValuesIn(semi_norms()), ByName{});
INSTANTIATE_TEST_SUITE_P(tabulated, MetricAxioms, ::testing::ValuesIn(tabulated()), ByName{});
INSTANTIATE_TEST_SUITE_P(norm, NormAxioms, ::testing::ValuesIn(norms()), ByName{});
INSTANTIATE_TEST_SUITE_P(norm, FormulaAxioms, ::testing::ValuesIn(norms()), ByName{});
INSTANTIATE_TEST_SUITE_P(semi_norm, FormulaAxioms, ::testing::ValuesIn(semi_norms()), ByName{});

TEST_P(MetricAxioms, HoldForRandomTriples) {
  const Metric& m = result().combined;
  Dice dice(500);
  for (int triple = 0; triple < kTriples; ++triple) {
    const auto draw = [&] { return static_cast<Eigen::Index>(dice.below(GetParam().materials)); };
    const Eigen::Index f = draw();
    const Eigen::Index g = draw();
    const Eigen::Index h = draw();
    SCOPED_TRACE(std::to_string(f) + ", " + std::to_string(g) + ", " + std::to_string(h));

    EXPECT_EQ(m.distance(f, f), 0);
    EXPECT_GE(m.distance(f, g), 0);
    EXPECT_EQ(m.distance(f, g), m.distance(g, f));
    EXPECT_EQ(m.gram(f, g), m.gram(g, f));
    EXPECT_LE(m.distance(f, h), m.distance(f, g) + m.distance(g, h) + m.distance_error(f, h) + m.distance_error(f, g) +
                                    m.distance_error(g, h));
    EXPECT_LE(std::abs(m.gram(f, g)), m.norm(f) * m.norm(g) + m.gram_error(f, g)) << "Cauchy-Schwarz";
  }
}

TEST_P(NormAxioms, OnlyEqualMaterialsHaveDistanceZero) {
  const Metric& m = result().combined;
  const auto list = materials();
  for (Eigen::Index g = 0; g < m.distance.cols(); ++g) {
    for (Eigen::Index f = 0; f < g; ++f) {
      EXPECT_GT(m.distance(f, g), m.distance_error(f, g))
          << list[static_cast<std::size_t>(f)].name << " and " << list[static_cast<std::size_t>(g)].name;
    }
  }
}

TEST_P(FormulaAxioms, ErrorsAreSmallBesideTheDistances) {
  const Metric& m = result().combined;
  double sum = 0;
  double errors = 0;
  for (Eigen::Index g = 0; g < m.distance.cols(); ++g) {
    sum += m.distance.col(g).sum();
    errors += m.distance_error.col(g).sum();
  }
  EXPECT_LE(errors, 0.02 * sum);
}

TEST_P(MetricAxioms, PolarisationGivesTheProductFromNorms) {
  const auto list = random_materials(6, GetParam().narrowest);
  std::vector<Material> sums;
  std::vector<Material> differences;
  for (std::size_t k = 0; k + 1 < list.size(); k += 2) {
    sums.push_back(sum_of(list[k], list[k + 1]));
    differences.push_back(sum_of(list[k], scaled(-1, list[k + 1])));
  }
  const Lighting lighting = GetParam().lighting();

  const Metric apart = measured(list, lighting).combined;
  const Metric sum = measured(sums, lighting).combined;
  const Metric difference = measured(differences, lighting).combined;

  for (Eigen::Index k = 0; k < sum.norm.size(); ++k) {
    const Eigen::Index f = 2 * k;
    const Eigen::Index g = f + 1;
    const double product = (sum.gram(k, k) - difference.gram(k, k)) / 4;
    const double error = (sum.gram_error(k, k) + difference.gram_error(k, k)) / 4;
    EXPECT_NEAR(apart.gram(f, g), product, known(apart.gram_error(f, g) + error, sum.gram(k, k))) << "pair " << k;
    EXPECT_NEAR(apart.distance(f, g), difference.norm(k),
                known(apart.distance_error(f, g) + difference.norm_error(k), sum.norm(k)))
        << "pair " << k;
  }
}

// --- Near-identical materials.

struct Neighbours {
  std::string model;
  std::string parameter;
  double value;
  std::vector<std::pair<std::string, double>> others = {};

  [[nodiscard]] Material at(double relative_step) const {
    auto parameters = others;
    parameters.emplace_back(parameter, value * (1 + relative_step));
    return make_material(model, parameters);
  }
};

TEST_P(MetricAxioms, DistancesOfNeighboursAreProportionalToTheStep) {
  const std::vector<Neighbours> families{{"phong", "n", 20},
                                         {"ward", "m", 0.2},
                                         {"blinn", "n", 50},
                                         {"cook_torrance", "m", 0.3},
                                         {"oren_nayar", "sigma", 0.5},
                                         {"exponential_patch", "s", 8},
                                         {"lafortune", "n", 20, {{"c_xy", -1}, {"c_z", 0.9}}},
                                         {"metal_phong", "n", 20},
                                         {"minnaert", "k", 0.5}};
  // Against the first, where a step of 1e-4 is small enough for the derivative and large enough for the products.
  const std::array<double, 5> steps{1e-4, 1e-3, 1e-5, 1e-7, 1e-9};
  std::vector<Material> list;
  for (const auto& family : families) {
    list.push_back(family.at(0));
    for (const double step : steps) list.push_back(family.at(step));
  }

  const MetricResult measurement = measured(list, GetParam().lighting());

  const Metric& metric = measurement.combined;
  const bool has_errors_of_differences = measurement.lighting.kind() != Lighting::Kind::table;
  const auto stride = static_cast<Eigen::Index>(steps.size()) + 1;
  for (std::size_t f = 0; f < families.size(); ++f) {
    const auto base = static_cast<Eigen::Index>(f) * stride;
    const double slope = metric.distance(base, base + 1) / steps[0];
    EXPECT_GT(slope, 1e-3 * metric.norm(base)) << families[f].model;
    for (std::size_t s = 1; s < steps.size(); ++s) {
      const Eigen::Index neighbour = base + 1 + static_cast<Eigen::Index>(s);
      const double distance = metric.distance(base, neighbour);
      // The second derivative at the step of 1e-3.
      EXPECT_NEAR(distance / steps[s], slope, 0.01 * slope) << families[f].model << " step " << steps[s];
      if (has_errors_of_differences) {
        EXPECT_LE(metric.distance_error(base, neighbour), 0.1 * distance) << families[f].model << " step " << steps[s];
      }
    }
  }
}

// --- Limits of patch lights.

TEST(PatchLightsOfRandomMaterials, OfRadiusTwoAreDaylightOverPi) {
  const auto list = random_materials(12, 0.3);

  const auto patch = measure(device(), list, Lighting::patch(2)).combined;

  const auto daylight = measure(device(), list, Lighting::daylight()).combined;
  EXPECT_LE((patch.gram_error.array() / patch.gram.array()).maxCoeff(), 1e-5);
  for (Eigen::Index j = 0; j < patch.gram.cols(); ++j) {
    for (Eigen::Index i = 0; i <= j; ++i) {
      EXPECT_NEAR(patch.gram(i, j), daylight.gram(i, j) / pi, patch.gram_error(i, j) + daylight.gram_error(i, j))
          << list[static_cast<std::size_t>(i)].name << " . " << list[static_cast<std::size_t>(j)].name;
    }
  }
}

TEST(PatchLightsOfRandomMaterials, TendToPointLight) {
  const auto list = random_materials(6, 0.5);
  const auto point = measure(device(), list, Lighting::point()).combined;
  // The deviations are some percent.
  MetricOptions options;
  options.patch_tolerance = 1e-3;
  const auto mean_deviation = [&](double radius) {
    const auto patch = measure(device(), list, Lighting::patch(radius), options).combined;
    return ((patch.gram - point.gram).array() / point.gram.array()).abs().mean();
  };

  const double wide = mean_deviation(0.2);
  const double narrow = mean_deviation(0.1);

  // What the horizon cuts off is of first order in R.
  EXPECT_LE(narrow, 0.6 * wide);
}

/// Isotropic and anisotropic materials on one grid, the former as isotropic tables.
std::vector<BrdfTable> mixed_forms() {
  const auto grid = HemisphereGrid::gauss(6, 12);
  std::vector<BrdfTable> tables;
  for (const char* text : {"phong:n=5", "ward_anisotropic:m_x=0.4,m_y=0.7", "lambert+ward:m=0.5",
                           "ashikhmin_shirley_anisotropic:n_u=5,n_v=2"}) {
    tables.push_back(table_of(text, grid));
  }
  return tables;
}

void expect_same_as_general(const Lighting& lighting) {
  const auto tables = mixed_forms();
  std::vector<BrdfTable> general;
  for (const auto& table : tables) general.push_back(to_general(table));
  const Metric found = measure(device(), tables, lighting).combined;
  const Metric expected = measure(device(), general, lighting).combined;
  // Sums in another order; distances are roots.
  EXPECT_LT((found.gram - expected.gram).cwiseAbs().maxCoeff(), 1e-12 * expected.gram.cwiseAbs().maxCoeff());
  EXPECT_LT((found.distance.cwiseAbs2() - expected.distance.cwiseAbs2()).cwiseAbs().maxCoeff(),
            1e-12 * expected.gram.cwiseAbs().maxCoeff());
}

TEST(MixedForms, AreMeasuredAsIfAllWereGeneral) {
  EXPECT_EQ(mixed_forms()[0].form, TableForm::isotropic);
  EXPECT_EQ(mixed_forms()[1].form, TableForm::general);
  expect_same_as_general(Lighting::point());
  expect_same_as_general(Lighting::daylight());
  expect_same_as_general(Lighting::mean_albedo());
  expect_same_as_general(Lighting::patch(0.7));
}

TEST(MixedForms, UnderALightWithASideAreMeasuredAsGeneralOnes) {
  const BrdfTable w = table_of("ward_anisotropic:m_x=0.4,m_y=0.8", HemisphereGrid::gauss(6, 12));
  expect_same_as_general(Lighting::table(compose(device(), w, transpose(w)), "one-sided"));
}

}  // namespace
}  // namespace lobe::test
