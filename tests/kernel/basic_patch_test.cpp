#include <cmath>
#include <limits>
#include <vector>

#include "kernel/model_kernel.hpp"
#include "model/evaluate.hpp"
#include "support/device.hpp"

namespace lobe::test {
namespace {

ModelCase basic_patch(const std::string& text) {
  const Real radius = std::stold(text);
  return {"basic_patch:R=" + text,
          [=](const Vector& l, const Vector& v) { return reference::basic_patch(l, v, radius); },
          // Any error of the geometry decides at the edge, none elsewhere; the band holds what single precision moves.
          [=](const Vector& l, const Vector& v) {
            constexpr Real kBand = 4e-7L;
            const Real distance = std::hypot(l.x + v.x, l.y + v.y);
            return std::abs(distance - radius) < kBand * radius ? std::numeric_limits<Real>::infinity() : 1;
          },
          static_cast<double>(radius / 3)};
}

ModelCase retro_patch(const std::string& text) {
  const Real radius = std::stold(text);
  return {"retro_patch:R=" + text,
          [=](const Vector& l, const Vector& v) { return reference::retro_patch(l, v, radius); },
          // The geometry has the square of the distance by a cosine, to an ulp of 1.
          [=](const Vector& l, const Vector& v) {
            constexpr Real kBand = 1e-6L;
            const Real distance = std::hypot(l.x - v.x, l.y - v.y);
            return std::abs(distance - radius) < kBand / radius ? std::numeric_limits<Real>::infinity() : 1;
          },
          static_cast<double>(radius / 3)};
}

INSTANTIATE_TEST_SUITE_P(basic_patch, ModelKernel,
                         ::testing::Values(basic_patch("0.001"), basic_patch("0.1"), basic_patch("0.5"),
                                           basic_patch("1"), basic_patch("1.25"), basic_patch("2")),
                         ByName{});

INSTANTIATE_TEST_SUITE_P(retro_patch, ModelKernel,
                         ::testing::Values(retro_patch("0.01"), retro_patch("0.5"), retro_patch("1"),
                                           retro_patch("1.25"), retro_patch("2")),
                         ByName{});

TEST(BasicPatch, OfTheWholeBasePlaneIsLambertAlsoInTheGrazingRetroDirection) {
  const double theta = std::nextafter(std::acos(0.0), 0);
  const std::vector<Directions> retro{{theta, theta, 0}, {1.5, 1.5, 0}, {0, 0, 0}};

  EXPECT_EQ(evaluate(device(), parse_material("basic_patch:R=2"), retro),
            evaluate(device(), parse_material("lambert"), retro));
}

TEST(RetroPatch, OfTheWholeBasePlaneIsLambertAlsoInTheGrazingMirrorDirection) {
  const double theta = std::nextafter(std::acos(0.0), 0);
  const std::vector<Directions> mirror{{theta, theta, 2 * std::acos(0.0)}, {1.5, 1.5, 2 * std::acos(0.0)}, {0, 0, 0}};

  EXPECT_EQ(evaluate(device(), parse_material("retro_patch:R=2"), mirror),
            evaluate(device(), parse_material("lambert"), mirror));
}

TEST(RetroPatch, IsTheBasicPatchOfMirroredDirections) {
  const std::vector<Directions> pairs{{0.3, 0.5, 0.2}, {1.2, 1.1, 0.3}, {0.1, 1.4, 2}, {1.5, 1.5, 1e-3}};
  std::vector<Directions> mirrored;
  for (const auto& pair : pairs)
    mirrored.push_back({pair.theta_in, pair.theta_out, 2 * std::acos(0.0) - pair.delta_phi});

  EXPECT_EQ(evaluate(device(), parse_material("retro_patch:R=0.3"), pairs),
            evaluate(device(), parse_material("basic_patch:R=0.3"), mirrored));
}

}  // namespace
}  // namespace lobe::test
