// Compositions of formulas on grids: values are those at single directions, errors are what is stated.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <ostream>
#include <random>
#include <string>
#include <vector>

#include "lobe/algebra/algebra.hpp"
#include "lobe/algebra/pointwise.hpp"
#include "lobe/core/error.hpp"
#include "lobe/hdf5/table_file.hpp"
#include "lobe/reflectance/as_function.hpp"
#include "lobe/reflectance/composition.hpp"
#include "reference/models.hpp"
#include "reference/quadrature.hpp"
#include "support/device.hpp"
#include "support/names.hpp"
#include "support/tables.hpp"
#include "support/temporary_directory.hpp"
#include "table/tabulate.hpp"

namespace lobe::test {
namespace {

using std::numbers::pi;

BrdfTable resolved(const std::string& f, const std::string& g, const HemisphereGrid& grid, double tolerance = 1e-5) {
  ComposeOptions options;
  options.resolve_formulas = true;
  options.tolerance = tolerance;
  return compose(device(), table_of(f, grid), table_of(g, grid), options);
}

/// A node of an isotropic table: rings and azimuth.
struct Node {
  std::size_t in, out, k;
};

std::string to_string(const Node& node) {
  return std::to_string(node.in) + ", " + std::to_string(node.out) + ", " + std::to_string(node.k);
}

Directions directions(const BrdfTable& table, const Node& node) {
  return {table.grid.rings()[node.in].theta, table.grid.rings()[node.out].theta,
          2 * pi * static_cast<double>(node.k) / static_cast<double>(table.grid.n_phi())};
}

double value(const BrdfTable& table, const Node& node) {
  return table.values[(node.in * table.rows() + node.out) * table.grid.half_azimuths() + node.k];
}

double stated(const BrdfTable& table, const Node& node) {
  return table.error[node.in * table.rows() + node.out];
}

/// Largest value over the azimuth at the rings of a node.
double size(const BrdfTable& table, const Node& node) {
  double largest = 0;
  for (std::size_t k = 0; k < table.grid.half_azimuths(); ++k) {
    largest = std::max(largest, std::abs(value(table, {node.in, node.out, k})));
  }
  return largest;
}

TEST(ResolvedComposition, IsRightInTheLastRing) {
  // The product of the discrete operators has 56599 where 1104 is right.
  const auto c = resolved("ward:m=0.1", "cook_torrance:m=0.1", HemisphereGrid::gauss(64, 128), 1e-2);
  const Node last{63, 63, 0};
  const Directions at = directions(c, last);

  const Estimate exact =
      composition_at(device(), parse_material("ward:m=0.1"), parse_material("cook_torrance:m=0.1"), {&at, 1})[0][0];

  EXPECT_NEAR(exact.value, 1104, 0.5);
  EXPECT_NEAR(value(c, last), exact.value, stated(c, last) + exact.error);
  EXPECT_LT(stated(c, last), 0.015 * exact.value);
  EXPECT_LT(relative_error(c), 1e-2);
}

struct Factors {
  std::string name, f, g;
  double ratio = 100;  ///< of stated and true errors, at most, in the median of peaks
};
std::ostream& operator<<(std::ostream& out, const Factors& factors) {
  return out << factors.name;
}

/// Pairs that had no part in the choice of the constants of the estimate.
class ResolvedCompositionOf : public ::testing::TestWithParam<Factors> {};

INSTANTIATE_TEST_SUITE_P(property, ResolvedCompositionOf,
                         ::testing::Values(Factors{"ward_cook_torrance", "ward:m=0.1", "cook_torrance:m=0.1"},
                                           Factors{"sharp_ward_ggx", "ward:m=0.05", "ggx:alpha=0.05"},
                                           Factors{"blinn_metal_phong", "blinn:n=200", "metal_phong:n=50"},
                                           Factors{"oren_nayar_schlick", "oren_nayar:sigma=0.3", "schlick:r=0.1"},
                                           // Its kinks are away from the peaks.
                                           Factors{"kinked_phong", "phong:n=0.5", "lafortune:c_xy=-1,c_z=0.7,n=30",
                                                   1e300},
                                           Factors{"retro_patch", "retro_metal_phong:n=40", "exponential_patch:s=12"}),
                         ByName{});

TEST_P(ResolvedCompositionOf, IsThatAtSingleDirectionsAtRandomNodes) {
  const auto& [name, f, g, ratio] = GetParam();
  const auto c = resolved(f, g, HemisphereGrid::gauss(24, 48));
  constexpr std::size_t kPeaks = 9;
  std::mt19937 random(20);
  // The largest values of pairs of rings, which is where their errors are as a rule; then any nodes.
  std::vector<Node> nodes{{23, 23, 0}, {23, 22, 0}, {0, 23, 0}};
  while (nodes.size() < kPeaks) nodes.push_back({random() % 24, random() % 24, 0});
  for (Node& node : nodes) {
    for (std::size_t k = 0; k <= 24; ++k) {
      if (std::abs(value(c, {node.in, node.out, k})) > std::abs(value(c, node))) node.k = k;
    }
  }
  while (nodes.size() < 16) nodes.push_back({random() % 24, random() % 24, random() % 25});
  std::vector<Directions> at;
  for (const Node& node : nodes) at.push_back(directions(c, node));

  const auto exact = composition_at(device(), parse_material(f), parse_material(g), at, {.tolerance = 1e-6}).front();

  std::vector<double> ratios;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    SCOPED_TRACE(std::to_string(nodes[n].in) + " " + std::to_string(nodes[n].out) + " " + std::to_string(nodes[n].k));
    // composition_at() is true to at least three digits more than it says.
    const double error = std::max(std::abs(value(c, nodes[n]) - exact[n].value) - 1e-3 * exact[n].error, 0.0);
    EXPECT_LE(error, stated(c, nodes[n]));
    // Below this level errors are rounding, of no known ratio.
    if (n < kPeaks) ratios.push_back(stated(c, nodes[n]) / std::max(error, 1e-11 * size(c, nodes[n])));
  }
  std::ranges::nth_element(ratios, ratios.begin() + kPeaks / 2);
  std::printf("  stated / true error: median %.1f\n", ratios[kPeaks / 2]);
  EXPECT_LE(ratios[kPeaks / 2], ratio);
}

TEST(ResolvedComposition, IsThatOfAnIndependentQuadrature) {
  const auto c = resolved("ward:m=0.2", "cook_torrance:m=0.3", HemisphereGrid::gauss(16, 32));
  const reference::Lobe f{[](const auto& l, const auto& v) { return reference::ward(l, v, 0.2L); }, 0.4};
  const reference::Lobe g{[](const auto& l, const auto& v) { return reference::cook_torrance(l, v, 0.3L, 1); }, 0.6};
  for (const Node& node : {Node{15, 15, 0}, Node{15, 14, 1}, Node{3, 12, 5}, Node{8, 8, 16}}) {
    SCOPED_TRACE(to_string(node));
    const double found = value(c, node);
    const double expected = reference::composition(f, g, directions(c, node), 1e-8 * found);
    EXPECT_NEAR(found, expected, stated(c, node) + 1e-7 * expected);
  }
}

TEST(ResolvedComposition, IsSymmetricToTheBitWhenComposedWithItself) {
  const auto c = resolved("ward:m=0.2", "ward:m=0.2", HemisphereGrid::gauss(12, 24));

  EXPECT_EQ(c.values, transpose(c).values);
}

TEST(ResolvedComposition, IsSemiSymmetricWithinItsErrors) {
  const auto grid = HemisphereGrid::uniform(12, 24);
  const auto fg = resolved("ward:m=0.2", "phong:n=30", grid);
  const auto gf = transpose(resolved("phong:n=30", "ward:m=0.2", grid));
  for (std::size_t at = 0; at < fg.values.size(); ++at) {
    const std::size_t rings = at / grid.half_azimuths();
    ASSERT_NEAR(fg.values[at], gf.values[at], fg.error[rings] + gf.error[rings]) << at;
  }
}

TEST(ResolvedComposition, LeavesDeltaPartsExact) {
  const auto grid = HemisphereGrid::gauss(12, 24);
  const std::string mixed = "phong:n=10,scale=0.6+mirror:rho=0.3+rrim:rho=0.1";
  const auto discrete = compose(device(), table_of(mixed, grid), table_of("ward:m=0.4", grid));
  const auto c = resolved(mixed, "ward:m=0.4", grid);
  const auto smooth = resolved("phong:n=10,scale=0.6", "ward:m=0.4", grid);
  const auto smooth_discrete = compose(device(), table_of("phong:n=10,scale=0.6", grid), table_of("ward:m=0.4", grid));
  for (std::size_t at = 0; at < c.values.size(); ++at) {
    ASSERT_NEAR(c.values[at] - smooth.values[at], discrete.values[at] - smooth_discrete.values[at],
                1e-12 * std::abs(c.values[at]))
        << at;
  }
}

TEST(ResolvedComposition, HasEachChannelOfItsFactors) {
  const auto grid = HemisphereGrid::gauss(10, 20);
  const auto both = resolved("ward:m=0.3,scale=0.2/0.7+lambert:scale=0.3/0.1", "phong:n=8", grid);
  const auto second = resolved("ward:m=0.3,scale=0.7+lambert:scale=0.1", "phong:n=8", grid);

  ASSERT_EQ(both.channels, 2U);
  for (std::size_t at = 0; at < second.values.size(); ++at) {
    ASSERT_NEAR(both.channel(1)[at], second.values[at], 1e-12 * second.values[at]) << at;
  }
}

TEST(ResolvedComposition, IsTheProductOfOperatorsWhereAFactorIsNoFormula) {
  const auto grid = HemisphereGrid::gauss(12, 24);
  auto f = table_of("ward:m=0.3", grid);
  f.source.clear();
  ComposeOptions options;
  options.resolve_formulas = true;

  EXPECT_EQ(compose(device(), f, f, options).values, compose(device(), f, f).values);
}

TEST(ResolvedComposition, IsTheProductOfOperatorsOnGridsOfCells) {
  const auto f = table_of("ward:m=0.3", HemisphereGrid::cells(12, 24));
  ComposeOptions options;
  options.resolve_formulas = true;

  EXPECT_EQ(compose(device(), f, f, options).values, compose(device(), f, f).values);
}

TEST(ResolvedComposition, CanBeCancelled) {
  ComposeOptions options;
  options.resolve_formulas = true;
  options.progress = [](std::string_view, double) { return false; };

  EXPECT_THROW((void)compose(device(), table_of("lambert"), table_of("phong:n=5"), options), Cancelled);
}

/// cos^20 of the angle to the mirror direction, times what tells L from V.
double one_sided(const reference::Vector& light, const reference::Vector& view) {
  const reference::Vector mirror{-light.x, -light.y, light.z};
  const double cosine = static_cast<double>(reference::dot(mirror, view));
  return std::pow(std::max(cosine, 0.0), 20) * (1 + 0.5 * static_cast<double>(light.z)) + 0.1;
}

BrdfFunction one_sided_function() {
  BrdfFunction brdf;
  brdf.name = "one-sided";
  brdf.channels = {"value"};
  brdf.is_bilateral = true;
  brdf.at = [](std::span<const Directions> pairs) {
    BrdfValues values;
    values.value.resize(static_cast<Eigen::Index>(pairs.size()), 1);
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      values.value(static_cast<Eigen::Index>(k), 0) =
          one_sided(reference::direction(static_cast<reference::Real>(pairs[k].theta_in), 0),
                    reference::direction(static_cast<reference::Real>(pairs[k].theta_out),
                                         static_cast<reference::Real>(pairs[k].delta_phi)));
    }
    return values;
  };
  return brdf;
}

TEST(FunctionComposition, IsThatOfAnIndependentQuadratureThoughNotReciprocal) {
  const auto c = compose(device(), one_sided_function(), parse_material("ward:m=0.3"), HemisphereGrid::gauss(12, 24));
  const auto d = compose(device(), parse_material("ward:m=0.3"), one_sided_function(), HemisphereGrid::gauss(12, 24));
  const reference::Lobe f{[](const auto& l, const auto& v) { return reference::Real{one_sided(l, v)}; }, 0.2};
  const reference::Lobe g{[](const auto& l, const auto& v) { return reference::ward(l, v, 0.3L); }, 0.6};
  for (const Node& node : {Node{11, 11, 0}, Node{2, 9, 3}, Node{10, 4, 12}}) {
    SCOPED_TRACE(to_string(node));
    const double expected = reference::composition(f, g, directions(c, node), 1e-8 * value(c, node));
    EXPECT_NEAR(value(c, node), expected, stated(c, node) + 1e-7 * expected);
    const double swapped = reference::composition(g, f, directions(d, node), 1e-8 * value(d, node));
    EXPECT_NEAR(value(d, node), swapped, stated(d, node) + 1e-7 * swapped);
    EXPECT_LT(stated(c, node), 1e-3 * expected);
  }
}

TEST(FunctionComposition, OfAMaterialAsAFunctionIsThatOfTheMaterial) {
  const auto grid = HemisphereGrid::gauss(12, 24);
  const auto function = as_function(device(), parse_material("ward:m=0.1"));
  const auto c = compose(device(), function, function, grid);
  const auto expected = resolved("ward:m=0.1", "ward:m=0.1", grid);
  for (std::size_t at = 0; at < c.values.size(); ++at) {
    const std::size_t rings = at / grid.half_azimuths();
    ASSERT_NEAR(c.values[at], expected.values[at], c.error[rings] + expected.error[rings]) << at;
  }
  EXPECT_LT(relative_error(c), 1e-3);
}

/// (1 + a(delta_phi)) / pi
BrdfFunction turned_function(double (*a)(double)) {
  BrdfFunction brdf;
  brdf.name = "turned";
  brdf.channels = {"value"};
  brdf.at = [a](std::span<const Directions> pairs) {
    BrdfValues values;
    values.value.resize(static_cast<Eigen::Index>(pairs.size()), 1);
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      values.value(static_cast<Eigen::Index>(k), 0) = (1 + a(pairs[k].delta_phi)) / pi;
    }
    return values;
  };
  return brdf;
}

double sine(double phi) {
  return std::sin(phi);
}

double sine_and_cosine(double phi) {
  return std::sin(phi) + std::cos(phi);
}

TEST(FunctionComposition, OfTwoOddPartsIsEven) {
  // C = (1 - cos(delta_phi) / 2) / pi.
  const auto f = turned_function(sine);
  const auto c = compose(device(), f, f, HemisphereGrid::gauss(12, 24));
  for (const Node& node : {Node{11, 11, 0}, Node{2, 9, 12}, Node{0, 4, 5}}) {
    SCOPED_TRACE(to_string(node));
    const double expected = (1 - std::cos(directions(c, node).delta_phi) / 2) / pi;
    EXPECT_NEAR(value(c, node), expected, stated(c, node));
    EXPECT_LT(stated(c, node), 1e-3);
  }
  EXPECT_LT(c.odd_part.front(), 1e-12);
}

TEST(FunctionComposition, TellsHowOddItIs) {
  // C = (1 + sin(delta_phi)) / pi.
  const auto f = turned_function(sine_and_cosine);
  const auto c = compose(device(), f, f, HemisphereGrid::gauss(12, 24));
  const Node node{5, 7, 6};
  EXPECT_NEAR(value(c, node), 1 / pi, 1e-3);
  EXPECT_GE(stated(c, node), 1 / pi);
  EXPECT_LT(stated(c, node), 1.01 / pi);
  EXPECT_NEAR(c.odd_part[5 * 12 + 7], std::sqrt(0.5) / pi, 1e-3);
  EXPECT_LT(c.even_error[5 * 12 + 7], 1e-3);
}

TEST(FunctionComposition, HasAMeanAlbedoThatOddPartsDoNotBlur) {
  const auto f = turned_function(sine_and_cosine);
  const auto grid = HemisphereGrid::gauss(16, 32);
  for (const BrdfTable& table : {tabulate(f, grid), compose(device(), f, f, grid)}) {
    SCOPED_TRACE(table.expression);
    const Estimate mean = row_albedos(table).mean.front();
    EXPECT_NEAR(mean.value, 1, mean.error);
    EXPECT_LT(mean.error, 5e-3) << table.expression;
  }
}

TEST(FunctionComposition, LeavesOddPartsToFilesAndToWhatIsMadeOfTables) {
  const auto f = tabulate(turned_function(sine), HemisphereGrid::gauss(6, 12));
  const TemporaryDirectory directory;
  save(f, directory.path() / "f.h5");
  const BrdfTable read = load_table(directory.path() / "f.h5");
  EXPECT_EQ(read.even_error, f.even_error);
  EXPECT_EQ(read.odd_part, f.odd_part);
  EXPECT_NEAR(f.odd_part.front(), std::sqrt(0.5) / pi, 1e-12);
  EXPECT_NEAR(scale(f, -2).odd_part.front(), 2 * f.odd_part.front(), 1e-12);
  EXPECT_NEAR(transpose(f).odd_part.back(), f.odd_part.back(), 1e-12);
  const std::vector<BrdfTable> both{f, table_of("lambert", f.grid)};
  EXPECT_NEAR(mix(std::vector{0.5, 0.5}, both).odd_part.front(), f.odd_part.front() / 2, 1e-12);
  EXPECT_TRUE(to_general(f).odd_part.empty());
  EXPECT_NEAR(relative_error(f), std::sqrt(0.5), 1e-9);
}

TEST(FunctionComposition, OfTablesKnowsWhatOddPartsMake) {
  const auto f = turned_function(sine);
  const auto c = self_compose(device(), tabulate(f, HemisphereGrid::gauss(16, 32)));
  const Node node{5, 7, 0};
  // Of the mean of both signs, which the table has: odd parts make cos(delta_phi) / 2 of it.
  EXPECT_NEAR(value(c, node), 1 / pi, 1e-6);
  EXPECT_GE(stated(c, node), 0.5 / pi);
  EXPECT_GE(c.even_error[5 * 16 + 7], std::sqrt(0.125) / pi);
}

TEST(FunctionComposition, AtSingleDirectionsIsThatInClosedForm) {
  const auto f = turned_function(sine_and_cosine);
  const std::vector<Directions> at{{0.3, 0.8, 0.4}, {1.5, 0, -2}, {1, 1, pi}};
  const auto values = composition_at(device(), f, f, at, {.tolerance = 1e-6}).front();
  for (std::size_t k = 0; k < at.size(); ++k) {
    EXPECT_NEAR(values[k].value, (1 + std::sin(at[k].delta_phi)) / pi, values[k].error) << k;
    EXPECT_LT(values[k].error, 1e-6) << k;
  }
}

TEST(FunctionComposition, AtSingleDirectionsIsThatOfAnIndependentQuadrature) {
  const std::vector<Directions> at{{0.3, 0.8, 0.4}, {1.2, 1.3, 0.1}};
  const auto values =
      composition_at(device(), one_sided_function(), parse_material("ward:m=0.3"), at, {.tolerance = 1e-5});
  const reference::Lobe f{[](const auto& l, const auto& v) { return reference::Real{one_sided(l, v)}; }, 0.2};
  const reference::Lobe g{[](const auto& l, const auto& v) { return reference::ward(l, v, 0.3L); }, 0.6};
  for (std::size_t k = 0; k < at.size(); ++k) {
    const Estimate found = values.front()[k];
    EXPECT_NEAR(found.value, reference::composition(f, g, at[k], 1e-8 * found.value), found.error) << k;
    EXPECT_LT(found.error, 1e-3 * found.value) << k;
  }
}

TEST(FunctionComposition, AtSingleDirectionsContainsErrorsOfInterpolation) {
  auto interpolated = turned_function(sine);
  interpolated.at = [at = interpolated.at](std::span<const Directions> pairs) {
    BrdfValues values = at(pairs);
    values.error = 0.1 * values.value;
    return values;
  };
  const Directions pair{0.3, 0.8, 0.4};
  const Estimate found = composition_at(device(), interpolated, interpolated, {&pair, 1}).front().front();
  EXPECT_NEAR(found.error, 0.21 * found.value, 0.001 * found.value);
}

TEST(FunctionComposition, RefusesWhatItCannotEvaluate) {
  auto anisotropic = one_sided_function();
  anisotropic.is_isotropic = false;
  auto interpolated = one_sided_function();
  interpolated.at = [at = interpolated.at](std::span<const Directions> pairs) {
    BrdfValues values = at(pairs);
    values.error = 0.1 * values.value;
    return values;
  };
  const auto grid = HemisphereGrid::gauss(8, 16);

  EXPECT_FALSE(can_be_composed(parse_material("phong:n=5+mirror:rho=0.1")));
  EXPECT_THROW((void)compose(device(), anisotropic, anisotropic, grid), ArgumentError);
  EXPECT_THROW((void)compose(device(), interpolated, interpolated, grid), ArgumentError);
  EXPECT_THROW((void)compose(device(), one_sided_function(), one_sided_function(), HemisphereGrid::klems(41)),
               ArgumentError);
}

}  // namespace
}  // namespace lobe::test
