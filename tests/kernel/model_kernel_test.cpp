#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <numbers>
#include <random>
#include <set>
#include <sstream>
#include <vector>

#include "device/known_values.hpp"
#include "lobe/model/model.hpp"
#include "model/catalogue.hpp"
#include "model/evaluate.hpp"
#include "models/model_test.hpp"
#include "support/deviation.hpp"
#include "support/device.hpp"
#include "support/error_budget.hpp"
#include "support/names.hpp"
#include "support/scale.hpp"

namespace lobe::test {

/// The claims that every model's kernel is held to.
class ModelKernel : public ::testing::TestWithParam<ModelCase> {};

// Suites by the names of the models, a line LOBE_MODEL(<model>) for each file of tests/models (tests/CMakeLists.txt).
#define LOBE_MODEL(model) \
  INSTANTIATE_TEST_SUITE_P(model, ModelKernel, ::testing::ValuesIn(model_test(#model).cases), ByName{});
#include "lobe/core/directions.hpp"
#include "model_tests.inc"
#undef LOBE_MODEL

namespace {

/// Name of the model in a specification.
std::string model_of(const std::string& specification) {
  return specification.substr(0, specification.find(':'));
}

using std::numbers::pi;

std::string text(const Directions& d) {
  std::ostringstream out;
  out.precision(17);
  out << "theta_in " << d.theta_in / kDegree << " theta_out " << d.theta_out / kDegree << " delta_phi "
      << d.delta_phi / kDegree << " phi_in " << d.phi_in / kDegree << " deg";
  return out.str();
}

bool above_horizon(double theta) {
  return theta >= 0 && theta < pi / 2;
}

/// Normal incidence to 89.99 degrees; at each angle the mirror direction, steps of the lobe's width away from it in
/// both axes, the retro direction, and the plane across; for anisotropic models along both axes and between them.
std::vector<Directions> structured_directions(const ModelCase& model) {
  const double width = model.width;
  const bool is_isotropic = find_model(model_of(model.name)).traits.isotropic;
  std::vector<Directions> list;
  const auto add = [&](double theta_in, double theta_out, double delta_phi) {
    if (!above_horizon(theta_out)) return;
    list.push_back({theta_in, theta_out, delta_phi});
    if (is_isotropic) return;
    for (const double phi_in : {0.7, pi / 2}) list.push_back({theta_in, theta_out, delta_phi, phi_in});
  };
  for (const double degrees : {0.0, 1e-4, 10.0, 45.0, 80.0, 89.0, 89.9, 89.99}) {
    const double theta = degrees * kDegree;
    for (const double steps : {-5.0, -2.0, -0.5, -0.01, 0.0, 0.01, 0.5, 2.0, 5.0}) {
      add(theta, theta + steps * width, pi);
      add(theta, theta, pi - steps * width);
    }
    add(theta, theta, 0);
    add(theta, theta, pi / 2);
    add(theta, 0, 0);
    add(theta, 30 * kDegree, 1);
    add(theta, 89.99 * kDegree, pi);
    add(theta, 89.99 * kDegree, 0);
  }
  return list;
}

unsigned seed() {
  const char* text = std::getenv("LOBE_TEST_SEED");
  return text != nullptr ? static_cast<unsigned>(std::strtoul(text, nullptr, 10)) : 20010713U;
}

/// Half of the pairs anywhere, half within a few widths of the mirror direction.
std::vector<Directions> random_directions(double width, std::size_t count) {
  std::mt19937 engine(seed());
  std::uniform_real_distribution<double> theta(0, pi / 2);
  std::uniform_real_distribution<double> phi(-pi, pi);
  std::normal_distribution<double> step(0, width);
  std::vector<Directions> list;
  while (list.size() < count) {
    const Directions anywhere{theta(engine), theta(engine), phi(engine), phi(engine)};
    list.push_back(anywhere);
    const Directions near{anywhere.theta_in, anywhere.theta_in + step(engine), pi + step(engine), anywhere.phi_in};
    if (above_horizon(near.theta_out)) list.push_back(near);
  }
  return list;
}

Deviation deviation(const ModelCase& model, const std::vector<Directions>& directions, Precision precision) {
  const ErrorBudget& budget = model.budget;
  const bool is_double = precision == Precision::double_precision;
  const auto eps = static_cast<Real>(is_double ? kDoubleEps : kSingleEps);
  const auto factor = static_cast<Real>(is_double ? budget.double_factor : budget.single_factor);
  const auto floor = static_cast<Real>(is_double ? kDoubleFloor : kSingleFloor);
  const auto values = evaluate(device(), parse_material(model.name), directions, precision);

  Deviation worst;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const auto light = reference::light_of(directions[i]);
    const auto view = reference::view_of(directions[i]);
    const Real expected = model.f(light, view);
    const Real computed = static_cast<Real>(values(static_cast<Eigen::Index>(i), 0));
    const Real condition = model.condition(light, view);
    // Values that the arithmetic cannot hold are compared absolutely.
    const Real relative = std::abs(expected) > floor ? factor * eps * condition * std::abs(expected) : floor;
    const Real tolerance = std::max(relative, model.floor ? model.floor(eps) : 0.0L);
    const Real error = std::abs(computed - expected);
    worst.add(static_cast<double>(error), static_cast<double>(tolerance), text(directions[i]));
  }
  return worst;
}

}  // namespace

TEST_P(ModelKernel, MatchesReferenceOnStructuredDirections) {
  const auto directions = structured_directions(GetParam());

  const auto worst = deviation(GetParam(), directions, Precision::double_precision);

  worst.report("double_structured");
  EXPECT_LE(worst.worst(), 1) << worst.cause();
}

TEST_P(ModelKernel, MatchesReferenceOnRandomDirections) {
  std::cout << "  seed " << seed() << " (LOBE_TEST_SEED)\n";
  const auto directions = random_directions(GetParam().width, scaled<std::size_t>(2000, 60));

  const auto worst = deviation(GetParam(), directions, Precision::double_precision);

  worst.report("double_random");
  EXPECT_LE(worst.worst(), 1) << worst.cause();
}

TEST_P(ModelKernel, MatchesReferenceInSinglePrecision) {
  auto directions = structured_directions(GetParam());
  const auto random = random_directions(GetParam().width, scaled<std::size_t>(2000, 60));
  directions.insert(directions.end(), random.begin(), random.end());

  const auto worst = deviation(GetParam(), directions, Precision::single_precision);

  worst.report("single");
  EXPECT_LE(worst.worst(), 1) << worst.cause();
}

TEST_P(ModelKernel, HasKnownValuesOfTheReference) {
  const Material material = parse_material(GetParam().name);
  const CatalogueEntry& entry = find_entry(material.terms.front().model);
  const Coefficients coefficients = entry.coefficients(material.terms.front().values);
  std::ostringstream row;
  row.precision(17);
  row << ".known = KnownValues{\"" << GetParam().name << "\", {";
  auto last = std::find_if(coefficients.rbegin(), coefficients.rend(), [](double c) { return c != 0; });
  for (auto c = coefficients.begin(); c != last.base(); ++c) row << (c == coefficients.begin() ? "" : ", ") << *c;
  row << "}, {";
  std::vector<double> values;
  for (const auto& pair : kKnownPairs) {
    values.push_back(static_cast<double>(GetParam().f(reference::light_of(pair), reference::view_of(pair))));
    row << (values.size() == 1 ? "" : ", ") << values.back();
  }
  row << "}}";
  const auto known = std::ranges::find(known_models(), entry.kernel, &KnownModel::kernel);
  ASSERT_NE(known, known_models().end()) << "an entry with this kernel needs, for example,\n" << row.str();
  if (known->material != GetParam().name) return;  // they are those of another case
  RecordProperty("known", std::string(known->kernel));
  for (std::size_t k = 0; k < known->coefficients.size(); ++k) {
    EXPECT_EQ(known->coefficients[k], coefficients[k]) << row.str();
  }
  for (std::size_t k = known->coefficients.size(); k < coefficients.size(); ++k) EXPECT_EQ(coefficients[k], 0) << k;
  // The row has 17 digits.
  for (std::size_t i = 0; i < values.size(); ++i) {
    EXPECT_NEAR(known->values[i], values[i], 4 * kDoubleEps * std::abs(values[i])) << row.str();
  }
}

/// Values that no case stands for would be held against nothing.
TEST(KnownValues, AreThoseOfCasesAboveAndOfWholeCatalogue) {
  std::set<std::string> cases;
  for (const ModelTest& test : model_tests()) {
    for (const ModelCase& one : test.cases) cases.insert(one.name);
  }
  std::set<std::string_view> kernels;
  for (const KnownModel& known : known_models()) {
    EXPECT_TRUE(cases.contains(std::string(known.material))) << known.material;
    EXPECT_TRUE(kernels.insert(known.kernel).second) << known.kernel << " twice";
  }
  for (const CatalogueEntry& entry : catalogue_entries()) {
    EXPECT_TRUE(entry.kernel.empty() || kernels.contains(entry.kernel)) << entry.kernel;
  }
}

TEST(ModelTests, AreThereForEveryModelWithAKernel) {
  for (const CatalogueEntry& entry : catalogue_entries()) {
    if (entry.kernel.empty()) continue;
    EXPECT_FALSE(model_test(std::string(entry.model.name)).cases.empty()) << entry.model.name;
  }
}

TEST(ModelTests, AreOfTheModelOfTheirFile) {
  for (const ModelTest& test : model_tests()) {
    SCOPED_TRACE(test.model);
    for (const ModelCase& one : test.cases) EXPECT_EQ(model_of(one.name), test.model) << one.name;
    EXPECT_EQ(test.excess ? model_of(test.excess->material) : test.model, test.model);
  }
}

TEST_P(ModelKernel, IsZeroAtTheHorizon) {
  const std::vector<Directions> directions{
      {pi / 2, 0.5, pi}, {0.5, pi / 2, pi}, {pi / 2, pi / 2, pi}, {pi / 2, pi / 2, 0}};

  const auto values = evaluate(device(), parse_material(GetParam().name), directions);

  EXPECT_EQ(values.cwiseAbs().maxCoeff(), 0);
}

}  // namespace lobe::test
