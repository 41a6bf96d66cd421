// Basic patches jump; the quadratures of albedos and products know where.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <ostream>
#include <string>
#include <vector>

#include "lobe/energy/albedo.hpp"
#include "lobe/metric/metric.hpp"
#include "reference/models.hpp"
#include "support/device.hpp"
#include "support/names.hpp"
#include "support/options.hpp"

namespace lobe::test {
namespace {

using std::numbers::pi;

Material patch(double radius) {
  return make_material("basic_patch", {{"R", radius}});
}

class PatchOf : public ::testing::TestWithParam<double> {
 protected:
  double constant() const { return 1 / (pi * std::min(1.0, GetParam() * GetParam())); }
};

TEST_P(PatchOf, AlbedoIsTheAreaWithinTheBasePlane) {
  const double radius = GetParam();
  const std::vector<double> theta{0, 0.2, 0.5, 0.8, 1.1, 1.4, 1.57};

  const auto values = albedo(device(), patch(radius), theta, {.tolerance = 1e-9}).at(0);

  for (std::size_t i = 0; i < theta.size(); ++i) {
    const auto area = static_cast<double>(reference::lens_area(1, radius, std::sin(theta[i])));
    const double edge = 1e-15 / radius;  // an ulp of the angle moves the edge
    EXPECT_NEAR(values[i].value, constant() * area, values[i].error + edge) << theta[i] << " rad";
  }
}

TEST_P(PatchOf, SquaredNormIsItsConstantTimesItsIntegral) {
  // f^2 = c f: |f|^2 = c pi A.
  const auto mean = mean_albedo(device(), patch(GetParam()), {.tolerance = 1e-8}).at(0);

  const auto square =
      scalar_product(device(), patch(GetParam()), patch(GetParam()), Lighting::point(), with_tolerance(1e-8));

  EXPECT_NEAR(square.value, constant() * pi * mean.value, square.error + constant() * pi * mean.error);
}

INSTANTIATE_TEST_SUITE_P(property, PatchOf, ::testing::Values(0.03, 0.25, 0.5, 1, 1.25, 2),
                         [](const auto& instance) { return test_name(std::to_string(instance.param)); });

TEST(Patch, MeanAlbedoIsSmallestInClosedFormForTheUnitRadius) {
  const auto value = mean_albedo(device(), patch(1), {.tolerance = 1e-9}).at(0);

  EXPECT_NEAR(value.value, 1 - 3 * std::sqrt(3.0) / (4 * pi), 1e-9);
}

TEST(Patch, OfTheWholeBasePlaneHasTheProductsOfLambert) {
  const auto product = scalar_product(device(), patch(2), parse_material("phong:n=20"), Lighting::point());
  const auto expected =
      scalar_product(device(), parse_material("lambert"), parse_material("phong:n=20"), Lighting::point());

  EXPECT_NEAR(product.value, expected.value, product.error + expected.error);
}

struct Partner {
  std::string name;
  std::string material;
  double radius;
};
std::ostream& operator<<(std::ostream& out, const Partner& partner) {
  return out << partner.name;
}

class PatchWith : public ::testing::TestWithParam<Partner> {};

TEST_P(PatchWith, ProductKeepsItsEstimate) {
  const auto partner = parse_material(GetParam().material);

  const auto coarse = scalar_product(device(), patch(GetParam().radius), partner, Lighting::point());
  const auto fine =
      scalar_product(device(), patch(GetParam().radius), partner, Lighting::point(), with_tolerance(1e-8));

  EXPECT_LE(std::abs(coarse.value - fine.value), coarse.error + fine.error);
  EXPECT_LE(fine.error, 1e-7 * fine.value);
}

INSTANTIATE_TEST_SUITE_P(property, PatchWith,
                         ::testing::Values(Partner{"oren_nayar", "oren_nayar:sigma=0.5", 0.5},
                                           Partner{"cook_torrance", "cook_torrance:m=0.3", 0.5},
                                           Partner{"metal_phong", "metal_phong:n=20", 1.25},
                                           Partner{"sharp_phong", "phong:n=10000", 0.01},
                                           Partner{"smaller_patch", "basic_patch:R=0.25", 0.5}),
                         ByName{});

}  // namespace
}  // namespace lobe::test
