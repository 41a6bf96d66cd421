// Quadrature of products of patches in norms about the mirror direction and about the retro direction.
#include "hemisphere/opposite_patch_rule.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "hemisphere/half_difference_rule.hpp"

namespace lobe::test {
namespace {

using std::numbers::pi;

/// A node as it is seen by what is integrated.
struct Pair {
  double cos_i = 0, cos_o = 0, cos_d = 0;
  double in_x = 0, in_y = 0;
  double u_x = 0, u_y = 0, v_x = 0, v_y = 0;  ///< V_P - L'_P and V_P - L_P
};

template <typename Rule>
double integral(const Rule& rule, int level, const std::function<double(const Pair&)>& g) {
  NodeBlock block(4096, true);
  double sum = 0;
  for (std::size_t slab = 0; slab < rule.slabs(); ++slab) {
    rule.place(slab, level, block, [&] {
      const auto at = [&](std::size_t row, std::size_t k) { return block.data()[row * block.capacity() + k]; };
      const auto tangent = [&](NodeBlock::TangentRow row, std::size_t k) { return at(NodeBlock::kRows + row, k); };
      for (std::size_t k = 0; k < block.size(); ++k) {
        Pair pair{.cos_i = at(NodeBlock::cos_i, k), .cos_o = at(NodeBlock::cos_o, k), .cos_d = at(NodeBlock::cos_d, k)};
        const double along = pair.cos_i + pair.cos_o;
        pair.in_x = tangent(NodeBlock::in_x, k);
        pair.in_y = tangent(NodeBlock::in_y, k);
        pair.u_x = tangent(NodeBlock::slope_x, k) * along;
        pair.u_y = tangent(NodeBlock::slope_y, k) * along;
        pair.v_x = pair.u_x - 2 * pair.in_x;
        pair.v_y = pair.u_y - 2 * pair.in_y;
        const double factor = at(NodeBlock::factor, k);
        sum += factor * factor * g(pair);
      }
      block.clear();
    });
  }
  return sum;
}

double norm_of(const PatchEdge& edge, double x, double y) {
  const double along = x * std::cos(edge.rotation) + y * std::sin(edge.rotation);
  const double across = y * std::cos(edge.rotation) - x * std::sin(edge.rotation);
  return std::pow(std::pow(edge.ratio * std::abs(along), edge.power) + std::pow(std::abs(across), edge.power),
                  1 / edge.power);
}

/// Whether both vectors are within their edges.
bool are_within(const PatchEdge& mirror, const PatchEdge& retro, const Pair& pair) {
  return norm_of(mirror, pair.u_x, pair.u_y) <= mirror.radius && norm_of(retro, pair.v_x, pair.v_y) <= retro.radius;
}

/// The area within an edge, in the whole plane.
double area(const PatchEdge& edge) {
  const double p = edge.power;
  const double square = 4 * std::pow(std::tgamma(1 + 1 / p), 2) / std::tgamma(1 + 2 / p);
  return square * edge.radius * edge.radius / edge.ratio;
}

LobeExtent extent_of(const PatchEdge& mirror, const PatchEdge& retro) {
  LobeExtent extent;
  extent.aspect = 1;
  extent.patch_edges = {mirror};
  extent.retro_patch_edges = {retro};
  return extent;
}

// dmu dmu = du dv / 4. Where the patches do not reach the horizon together the integral is that of their areas.
TEST(OppositePatchRule, MeasuresAreasOfPatchesThatDoNotReachTheHorizon) {
  const std::vector<std::pair<PatchEdge, PatchEdge>> pairs{{{0.3, 0.4, 2, 0.6}, {0.4, 0.5, 1, 0.3}},
                                                           {{0.02, 0.05, 2, -1}, {0.3, 0.7, 1.6, 0}},
                                                           {{0.5, 0.8, 3, 1.4}, {0.25, 0.4, 20, 0.2}},
                                                           {{0.7, 1, 2, 0}, {1.2, 1, 2, 0}}};
  for (const auto& [mirror, retro] : pairs) {
    SCOPED_TRACE(std::to_string(mirror.radius) + " " + std::to_string(retro.radius));
    const OppositePatchRule rule(extent_of(mirror, retro));
    const auto inside = [&mirror = mirror, &retro = retro](const Pair& pair) {
      return are_within(mirror, retro, pair) ? 1.0 : 0.0;
    };
    const double expected = area(mirror) * area(retro) / 4;
    const double coarse = integral(rule, 0, inside);
    const double fine = integral(rule, 1, inside);

    EXPECT_NEAR(fine, expected, std::abs(fine - coarse) + 1e-12 * expected);
    EXPECT_NEAR(fine, expected, 1e-4 * expected);
  }
}

// Round patches are those that the other rule knows, with their limits at the horizon or in a smaller domain.
TEST(OppositePatchRule, HasTheIntegralsOfRoundPatchesUpToTheHorizon) {
  for (const double theta_max : {90.0, 60.0}) {
    for (const auto& [a, b] : {std::pair{1.6, 1.3}, std::pair{0.2, 1.9}, std::pair{2.0, 0.3}}) {
      SCOPED_TRACE(std::to_string(theta_max) + " " + std::to_string(a));
      LobeExtent extent = extent_of({a, 1, 2, 0}, {b, 1, 2, 0});
      extent.cos_min = theta_max == 90 ? 0 : std::cos(theta_max * pi / 180);
      LobeExtent known;
      known.patch_radii = {a};
      known.retro_patch_radii = {b};
      known.cos_min = extent.cos_min;
      known.aspect = 1;
      const auto inside = [a = a, b = b](const Pair& pair) {
        return std::hypot(pair.u_x, pair.u_y) <= a && std::hypot(pair.v_x, pair.v_y) <= b ? 1 - 0.3 * pair.cos_d : 0.0;
      };
      const double expected = integral(HalfDifferenceRule(known), 1, inside);
      const OppositePatchRule rule(extent);
      EXPECT_NEAR(integral(rule, 2, inside), expected, 2e-5 * expected);
      EXPECT_NEAR(integral(rule, 3, inside), expected, 4e-6 * expected);
    }
  }
}

// For given u and azimuth of v the length of v ends at the edge or at the horizon; midpoints of the others.
TEST(OppositePatchRule, HasTheIntegralsOfASumOverThePlaneUpToTheHorizon) {
  const PatchEdge mirror{1.1, 0.7, 2, 0.5};
  const PatchEdge retro{0.8, 0.5, 1.3, -0.4};
  constexpr int kSteps = 60;
  double sum = 0;
  for (int a = 0; a < 2 * kSteps; ++a) {
    const double phi_u = pi * (a + 0.5) / (2 * kSteps);
    const double reach_u = std::min(mirror.radius / norm_of(mirror, std::cos(phi_u), std::sin(phi_u)), 2.0);
    for (int b = 0; b < 2 * kSteps; ++b) {
      const double phi_v = pi * (b + 0.5) / (2 * kSteps);
      const double reach_v = retro.radius / norm_of(retro, std::cos(phi_v), std::sin(phi_v));
      const double cosine = std::abs(std::cos(phi_u - phi_v));
      for (int k = 0; k < kSteps; ++k) {
        const double u = reach_u * (k + 0.5) / kSteps;
        const double limit = -u * cosine + std::sqrt(std::max(0.0, 4 - u * u * (1 - cosine * cosine)));
        const double v = std::min(limit, reach_v);
        sum += u * reach_u * v * v / 2;
      }
    }
  }
  const double expected = sum * pi * pi / (4.0 * kSteps * kSteps * kSteps);
  const auto inside = [&](const Pair& pair) { return are_within(mirror, retro, pair) ? 1.0 : 0.0; };
  const OppositePatchRule rule(extent_of(mirror, retro));
  const double coarse = integral(rule, 1, inside);
  const double fine = integral(rule, 2, inside);

  EXPECT_LT(expected, 0.95 * area(mirror) * area(retro) / 4);  // the horizon matters
  EXPECT_NEAR(fine, expected, 1e-4 * expected);                // the square of a step
  EXPECT_NEAR(fine, coarse, 1e-5 * expected);
}

// A profile has no edge, and may be narrow.
TEST(OppositePatchRule, FollowsNarrowProfiles) {
  const PatchEdge retro{0.3, 0.7, 1.6, 0};
  for (const double s : {40.0, 1e4}) {
    const PatchEdge profile{std::numeric_limits<double>::infinity(), 0.4, 1, 0.4};
    LobeExtent extent = extent_of(profile, retro);
    extent.width = 1 / (2 * s);
    const OppositePatchRule rule(extent);
    const auto inside = [&](const Pair& pair) {
      return norm_of(retro, pair.v_x, pair.v_y) <= retro.radius ? std::exp(-s * norm_of(profile, pair.u_x, pair.u_y))
                                                                : 0.0;
    };
    const double unit = area({1, profile.ratio, profile.power, 0});
    const double expected = unit * 2 / (s * s) * area(retro) / 4;  // of the profile the integral of 2 r exp(-s r)
    EXPECT_NEAR(integral(rule, 2, inside), expected, 1e-5 * expected) << s;
  }
}

// Kinks are limits of the last axis.
TEST(OppositePatchRule, EndsPanelsOnKinks) {
  const PatchEdge mirror{0.3, 0.4, 2, 0.6};
  const PatchEdge retro{1, 0.9, 2, 0.3};
  constexpr double kCosine = 0.93;
  LobeExtent extent = extent_of(mirror, retro);
  const OppositePatchRule without(extent);
  extent.kinks = {difference_kink(kCosine, 0)};
  const OppositePatchRule rule(extent);
  const auto inside = [&](const Pair& pair) {
    return are_within(mirror, retro, pair) && pair.cos_d < kCosine ? 1.0 : 0.0;
  };
  const double expected = integral(rule, 4, inside);
  EXPECT_NEAR(integral(rule, 1, inside), expected, 1e-5 * expected);
  EXPECT_GT(std::abs(integral(without, 1, inside) - expected), 1e-4 * expected);
}

// Where lobes are not the same with L and V exchanged, or half a turn further on, all of these are nodes.
TEST(OppositePatchRule, HasBothOrdersAndBothTurnsWhereTheyDiffer) {
  const PatchEdge mirror{0.3, 0.4, 2, 0.6};
  const PatchEdge retro{0.4, 0.5, 1, 0.3};
  LobeExtent extent = extent_of(mirror, retro);
  extent.both_orders = true;
  extent.half_turn = false;
  const double expected = area(mirror) * area(retro) / 4;
  const auto odd = [&](const Pair& pair) {
    if (!are_within(mirror, retro, pair)) return 0.0;
    return 1 + pair.in_x - 0.7 * pair.in_y + 0.5 * pair.u_x + (pair.cos_i - pair.cos_o);
  };
  EXPECT_NEAR(integral(OppositePatchRule(extent), 1, odd), expected, 1e-5 * expected);
  extent.both_orders = false;
  EXPECT_GT(std::abs(integral(OppositePatchRule(extent), 1, odd) - expected), 1e-3 * expected);
  extent.both_orders = true;
  extent.half_turn = true;
  EXPECT_GT(std::abs(integral(OppositePatchRule(extent), 1, odd) - expected), 1e-3 * expected);
}

}  // namespace
}  // namespace lobe::test
