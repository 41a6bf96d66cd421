#include <cmath>
#include <limits>
#include <vector>

#include "kernel/model_kernel.hpp"
#include "lobe/evaluate.hpp"
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

INSTANTIATE_TEST_SUITE_P(basic_patch, ModelKernel,
                         ::testing::Values(basic_patch("0.001"), basic_patch("0.1"), basic_patch("0.5"),
                                           basic_patch("1"), basic_patch("1.25"), basic_patch("2")),
                         ByName{});

TEST(BasicPatch, OfTheWholeBasePlaneIsLambertAlsoInTheGrazingRetroDirection) {
  const double theta = std::nextafter(std::acos(0.0), 0);
  const std::vector<Directions> retro{{theta, theta, 0}, {1.5, 1.5, 0}, {0, 0, 0}};

  EXPECT_EQ(evaluate(device(), parse_material("basic_patch:R=2"), retro),
            evaluate(device(), parse_material("lambert"), retro));
}

}  // namespace
}  // namespace lobe::test
