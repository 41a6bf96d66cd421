// Models times factors against the references of both, and models that are written out against the same of the
// catalogue.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <ostream>
#include <random>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "device/known_values.hpp"
#include "energy/prepare.hpp"
#include "lobe/core/error.hpp"
#include "model/evaluate.hpp"
#include "model/factors.hpp"
#include "reference/fresnel.hpp"
#include "reference/models.hpp"
#include "support/device.hpp"
#include "support/error_budget.hpp"
#include "support/names.hpp"
#include "support/scale.hpp"

namespace lobe::test {
namespace {

using reference::Real;
using reference::Vector;
using std::numbers::pi;

std::vector<Directions> directions() {
  std::mt19937 engine(11);
  std::uniform_real_distribution<double> theta(0, 89.9 * pi / 180);
  std::uniform_real_distribution<double> phi(-pi, pi);
  std::vector<Directions> list{{0, 0, 0}, {0.5, 0.5, pi}, {0.5, 0.5, 0}, {1.57, 1.57, pi}, {1.57, 0.1, 1}};
  while (list.size() < scaled<std::size_t>(500, 60)) {
    list.push_back({theta(engine), theta(engine), phi(engine), phi(engine)});
  }
  return list;
}

Real cos_d(const Vector& l, const Vector& v) {
  const Vector sum{l.x + v.x, l.y + v.y, l.z + v.z};
  return std::sqrt(sum.x * sum.x + sum.y * sum.y + sum.z * sum.z) / 2;
}

/// F82 as Kutz, Hasan and Edmondson write it: Schlick's term, and the edge term scaled by its value at 1/7.
Real edge_tinted(Real cosine, Real f0, Real tint) {
  const auto edge = [](Real x) { return x * std::pow(1 - x, 6.0L); };
  const Real at_edge = reference::schlick_fresnel(1 / 7.0L, f0);
  const Real value = reference::schlick_fresnel(cosine, f0) - at_edge * (1 - tint) * edge(cosine) / edge(1 / 7.0L);
  return std::max(Real{0}, value);
}

struct ProductCase {
  std::string name;
  std::string text;
  std::function<Real(const Vector& light, const Vector& view)> f;
};
std::ostream& operator<<(std::ostream& out, const ProductCase& product) {
  return out << product.name;
}

const std::vector<ProductCase>& product_cases() {
  static const std::vector<ProductCase> cases{
      {"metal", "phong:n=20*cos_max",
       [](const Vector& l, const Vector& v) { return reference::metal_phong(l, v, 20); }},
      {"p_model", "phong:n=5*cos_max:p=0.5",
       [](const Vector& l, const Vector& v) { return reference::phong(l, v, 5) / std::sqrt(std::max(l.z, v.z)); }},
      {"lacquer", "lambert*lacquer:s=0.3",
       [](const Vector& l, const Vector& v) { return reference::lacquer(l, v, 0.3L); }},
      {"sandwich", "lambert:scale=2*sandwich:k=3,n=2",
       [](const Vector& l, const Vector& v) { return 2 * reference::sandwich(l, v, 3, 2); }},
      {"fresnel", "lambert*fresnel:ior=1.5",
       [](const Vector& l, const Vector& v) {
         return reference::fresnel(cos_d(l, v), 1.5L, 0) / std::numbers::pi_v<Real>;
       }},
      {"f82", "lambert*f82:f0=0.7,tint=0.4",
       [](const Vector& l, const Vector& v) {
         return edge_tinted(cos_d(l, v), 0.7L, 0.4L) / std::numbers::pi_v<Real>;
       }},
      {"dark_f82", "lambert*f82:f0=0.1,tint=0",
       [](const Vector& l, const Vector& v) { return edge_tinted(cos_d(l, v), 0.1L, 0) / std::numbers::pi_v<Real>; }},
      {"half_cosine", "phong:n=20*half_cosine",
       [](const Vector& l, const Vector& v) { return reference::phong(l, v, 20) * 2 * cos_d(l, v) / (l.z + v.z); }},
      {"power_mean", "phong:n=20*power_mean:p=3",
       [](const Vector& l, const Vector& v) {
         return reference::phong(l, v, 20) / std::cbrt((l.z * l.z * l.z + v.z * v.z * v.z) / 2);
       }},
      {"geometric_mean", "exponential_patch:s=8*power_mean:p=0,alpha=-1",
       [](const Vector& l, const Vector& v) { return reference::exponential_patch(l, v, 8) / std::sqrt(l.z * v.z); }},
      {"harmonic_mean", "lambert*power_mean:p=-1,alpha=0.5",
       [](const Vector& l, const Vector& v) { return std::sqrt(2 / (1 / l.z + 1 / v.z)) / std::numbers::pi_v<Real>; }},
      {"two_factors", "oren_nayar:sigma=0.3*transmission:ior=1.5*lacquer:s=0.1",
       [](const Vector& l, const Vector& v) {
         return reference::oren_nayar(l, v, 0.3L, 0.33L) * (1 - reference::fresnel(cos_d(l, v), 1.5L, 0)) *
                std::exp(-0.1L * (1 / l.z + 1 / v.z));
       }},
      {"three_factors", "phong:n=3*fresnel:ior=0.2,k=3*cos_max:p=0.3*sandwich:k=0.1",
       [](const Vector& l, const Vector& v) {
         return reference::phong(l, v, 3) * reference::fresnel(cos_d(l, v), 0.2L, 3) /
                std::pow(std::max(l.z, v.z), 0.3L) / (2 + 0.1L * (1 / l.z + 1 / v.z));
       }},
      {"anisotropic", "ward_anisotropic:m_x=0.3,m_y=0.3*lacquer:s=0.2",
       [](const Vector& l, const Vector& v) {
         return reference::ward(l, v, 0.3L) * std::exp(-0.2L * (1 / l.z + 1 / v.z));
       }},
  };
  return cases;
}

/// The sharpest condition of these is n (|ln R.V| + 1/R.V) of a cosine lobe and s (1/N.L + 1/N.V) of lacquer, at most
/// 1200 at 89.9 degrees; a factor of the models' budgets on top.
double tolerance(double eps, Real light_z, Real view_z) {
  return 64 * eps * static_cast<double>(4 + 1 / light_z + 1 / view_z);
}

class Product : public ::testing::TestWithParam<ProductCase> {};

TEST_P(Product, IsThatOfTheReferences) {
  const auto list = directions();
  for (const auto precision : {Precision::double_precision, Precision::single_precision}) {
    const double eps = precision == Precision::double_precision ? kDoubleEps : kSingleEps;
    const auto values = evaluate(device(), parse_material(GetParam().text), list, precision);
    for (std::size_t i = 0; i < list.size(); ++i) {
      const auto light = reference::light_of(list[i]);
      const auto view = reference::view_of(list[i]);
      const auto expected = static_cast<double>(GetParam().f(light, view));
      const double floor = precision == Precision::double_precision ? 1e-290 : 1e-9;
      EXPECT_NEAR(values(static_cast<Eigen::Index>(i), 0), expected,
                  std::max(floor, tolerance(eps, light.z, view.z) * expected))
          << "pair " << i << ", eps " << eps;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(factors, Product, ::testing::ValuesIn(product_cases()), ByName{});

/// Factors by their specifications.
using FactorFunction = std::function<Real(const Vector& light, const Vector& view)>;
const std::map<std::string, FactorFunction>& factor_references() {
  static const std::map<std::string, FactorFunction> all{
      {"cos_max:p=0.5", [](const Vector& l, const Vector& v) { return 1 / std::sqrt(std::max(l.z, v.z)); }},
      {"f82:f0=0.6,tint=0.5", [](const Vector& l, const Vector& v) { return edge_tinted(cos_d(l, v), 0.6L, 0.5L); }},
      {"fresnel:ior=1.5", [](const Vector& l, const Vector& v) { return reference::fresnel(cos_d(l, v), 1.5L, 0); }},
      {"half_cosine", [](const Vector& l, const Vector& v) { return 2 * cos_d(l, v) / (l.z + v.z); }},
      {"lacquer:s=0.3", [](const Vector& l, const Vector& v) { return std::exp(-0.3L * (1 / l.z + 1 / v.z)); }},
      {"power_mean:p=3",
       [](const Vector& l, const Vector& v) { return 1 / std::cbrt((l.z * l.z * l.z + v.z * v.z * v.z) / 2); }},
      {"sandwich:k=0.1", [](const Vector& l, const Vector& v) { return 1 / (2 + 0.1L * (1 / l.z + 1 / v.z)); }},
      {"transmission:ior=1.5",
       [](const Vector& l, const Vector& v) { return 1 - reference::fresnel(cos_d(l, v), 1.5L, 0); }},
  };
  return all;
}

TEST(KnownFactors, AreThoseOfTheReferencesAndAll) {
  std::set<std::string_view> known_names;
  for (const KnownFactor& known : known_factors()) known_names.insert(known.factor);
  std::set<std::string> names;
  for (const auto& [specification, f] : factor_references()) {
    const std::string name = specification.substr(0, specification.find(':'));
    names.insert(name);
    const Factor factor = parse_material("lambert*" + specification).terms.front().factors.front();
    const auto coefficients = find_factor_entry(name).coefficients(factor.values);
    std::ostringstream row;
    row.precision(17);
    row << "{\"" << name << "\", \"" << specification << "\", {" << coefficients[0] << ", " << coefficients[1]
        << "}, {";
    std::vector<double> values;
    for (const auto& pair : kKnownPairs) {
      values.push_back(static_cast<double>(f(reference::light_of(pair), reference::view_of(pair))));
      row << (values.size() == 1 ? "" : ", ") << values.back();
    }
    row << "}},";
    const auto known = std::ranges::find(known_factors(), name, &KnownFactor::factor);
    EXPECT_NE(known, known_factors().end()) << "lib/src/device/known_values.cpp needs the row\n" << row.str();
    if (known == known_factors().end()) continue;
    EXPECT_EQ(known->specification, specification);
    EXPECT_EQ(known->coefficients, coefficients) << row.str();
    for (std::size_t i = 0; i < values.size(); ++i) {
      EXPECT_NEAR(known->values[i], values[i], 4 * kDoubleEps * values[i]) << row.str();
    }
  }
  for (const FactorModel& factor : factors()) EXPECT_TRUE(names.contains(std::string(factor.name))) << factor.name;
  EXPECT_EQ(known_names.size(), names.size());
}

Term formula_term(const std::string& text, std::vector<std::string> parameters, const std::vector<double>& values) {
  Formula formula;
  formula.text = text;
  formula.parameters = std::move(parameters);
  return {.model = std::string(kCustomModel), .values = values, .weight = {1.0}, .formula = formula};
}

void expect_same(const Term& term, const std::string& model, double double_tolerance) {
  const auto list = directions();
  for (const auto precision : {Precision::double_precision, Precision::single_precision}) {
    const bool is_double = precision == Precision::double_precision;
    const auto values = evaluate(device(), {"written out", "", {term}}, list, precision);
    // The geometry that formulas see is rounded to single precision, too.
    const auto expected = evaluate(device(), parse_material(model), list, Precision::double_precision);
    for (Eigen::Index i = 0; i < values.rows(); ++i) {
      const double allowed = is_double ? double_tolerance : 1e-2;
      EXPECT_NEAR(values(i, 0), expected(i, 0), allowed * std::abs(expected(i, 0)) + (is_double ? 1e-290 : 1e-6))
          << "pair " << i;
    }
  }
}

TEST(Formula, OfACosineLobeIsTheModel) {
  expect_same(formula_term("(n + 2) / (2 * pi) * exp(n * log_rv)", {"n"}, {7}), "phong:n=7", 1e-14);
}

TEST(Formula, TakesPowersOfNegativeNumbersAndChoices) {
  expect_same(formula_term("where(cos_rv > 0, 4.5 / pi * pow(cos_rv, 7), 0.0 * pow(cos_rv, 2))", {}, {}), "phong:n=7",
              1e-9);  // R.V from its parts, not from 1 - R.V
}

TEST(Formula, KnowsEveryQuantity) {
  expect_same(formula_term("1 / pi * where(fabs(cos_lv + cos_rv - 2 * cos_i * cos_o) < 1e-6 && distance_p >= 0 &&"
                           " fabs(cos(theta_i) - cos_i) < 1e-6 && fabs(cos(theta_o) - cos_o) < 1e-6 &&"
                           " fabs(log_cos_h - log(cos_h)) < 1e-5 && fabs(cos_lv + 1 - 2 * cos_d * cos_d) < 1e-6 &&"
                           " fmin(tan2_h, 1.0) <= fmax(1.0, 0.5) && hypot(cos_i, 0.0) == cos_i &&"
                           " fabs(atan2(1.0, 1.0) - pi / 4) < 1e-6, 1, 0)",
                           {}, {}),
              "lambert", 1e-14);
}

TEST(Formula, OfAnAnisotropicLobeIsTheModel) {
  expect_same(formula_term("exp(-(half_x * half_x / (m_x * m_x) + half_y * half_y / (m_y * m_y)) / (cos_h * cos_h)) /"
                           " (4 * pi * m_x * m_y * sqrt(cos_i * cos_o)) *"
                           " where(fabs(in_x * in_x + in_y * in_y + cos_i * cos_i - 1) < 1e-5 &&"
                           " fabs(out_x * out_x + out_y * out_y + cos_o * cos_o - 1) < 1e-5, 1, 0)",
                           {"m_x", "m_y"}, {0.2, 0.5}),
              "ward_anisotropic:m_x=0.2,m_y=0.5", 1e-11);
}

TEST(Formula, HasFresnelsEquationsAndFactors) {
  Term term = formula_term("fresnel(cos_d, ior, 0.0) / pi", {"ior"}, {1.5});
  term.factors.push_back(make_factor("lacquer", {{"s", 0.1}}));
  expect_same(term, "lambert*fresnel:ior=1.5*lacquer:s=0.1", 1e-13);
}

TEST(Formula, ThatCannotBeReadIsReportedWithItsPlace) {
  Term term = formula_term("rho / pi *\n cosine_i", {"rho"}, {0.3});
  term.formula->file = "mine.toml";
  term.formula->line = 12;
  try {
    (void)prepare(device(), {"wrong", "", {term}});
    FAIL() << "expected ArgumentError";
  } catch (const ArgumentError& error) {
    EXPECT_EQ(std::string(error.what()).find("mine.toml:13:2: unknown name 'cosine_i'; known: rho, cos_i"), 0U)
        << error.what();
  }
}

}  // namespace
}  // namespace lobe::test
