// Delta parts that depend on the angle of incidence: mirrors with Fresnel's equations, pumped ones, and those that take
// the light another material leaves.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "energy/albedo.hpp"
#include "energy/prepare.hpp"
#include "lobe/core/error.hpp"
#include "lobe/energy/albedo.hpp"
#include "lobe/energy/plausibility.hpp"
#include "lobe/metric/metric.hpp"
#include "lobe/reflectance/tabulate.hpp"
#include "lobe/table/table.hpp"
#include "metric/table_metric.hpp"
#include "reference/fresnel.hpp"
#include "reference/models.hpp"
#include "reference/quadrature.hpp"
#include "support/device.hpp"
#include "support/estimates.hpp"
#include "table/evaluate.hpp"

namespace lobe::test {
namespace {

using reference::Real;
using std::numbers::pi;
using ::testing::Each;
using ::testing::Field;
using ::testing::Le;

const std::vector<double> kDeltaAngles{0, 0.5, 1, 1.3, 1.5, 1.5707};

Material made(const std::string& text) {
  return prepare(device(), parse_material(text));
}

std::vector<Estimate> albedos_of(const Material& material) {
  return albedo(device(), material, kDeltaAngles).front();
}

double glass(double cosine) {
  return static_cast<double>(reference::fresnel(cosine, 1.5L, 0));
}

/// With a critical angle at 53.1 degrees.
double water_from_inside(double cosine) {
  return static_cast<double>(reference::fresnel(cosine, 0.8L, 0));
}

/// Integral of g(cos(theta)) dmu over the hemisphere.
double over_hemisphere(const std::function<double(double)>& g) {
  return 2 * pi * reference::integrate([&](double cosine) { return g(cosine) * cosine; }, 0, 1, 1e-12);
}

TEST(DeltaParts, OfGlassReflectWhatFresnelsEquationsSay) {
  const auto material = parse_material("mirror:rho=0.5*fresnel:ior=1.5");

  const auto albedos = albedos_of(material);
  const auto mean = mean_albedo(device(), material).front();

  for (std::size_t k = 0; k < kDeltaAngles.size(); ++k) {
    EXPECT_NEAR(albedos[k].value, 0.5 * glass(std::cos(kDeltaAngles[k])), 1e-13) << kDeltaAngles[k];
  }
  EXPECT_NEAR(mean.value, 0.5 * over_hemisphere(glass) / pi, mean.error + 1e-11);
}

TEST(DeltaParts, OfRetroReflectorsSeeTheNormalOfTheirFacets) {
  // L = V = H: Fresnel's equations at normal incidence, whatever the angle.
  const auto albedos = albedos_of(parse_material("rrim*fresnel:ior=1.5"));
  EXPECT_THAT(albedos, Each(EstimateNear(0.04, 1e-15)));
}

TEST(DeltaParts, UnderLacquerAddToTheRest) {
  const auto both = parse_material("phong:n=5+mirror*lacquer:s=0.1");
  const auto smooth = albedos_of(parse_material("phong:n=5"));
  const auto albedos = albedos_of(both);
  for (std::size_t k = 0; k < kDeltaAngles.size(); ++k) {
    const double mirror = std::exp(-0.2 / std::cos(kDeltaAngles[k]));
    EXPECT_NEAR(albedos[k].value, smooth[k].value + mirror, albedos[k].error + smooth[k].error) << k;
  }
}

TEST(DeltaParts, OfGlassHaveProductsUnderDaylight) {
  const std::vector<Material> materials{parse_material("mirror*fresnel:ior=1.5"), parse_material("lambert"),
                                        parse_material("mirror:rho=0.25")};
  const auto metric = measure(device(), materials, Lighting::daylight()).combined;
  const double square = over_hemisphere([](double c) { return glass(c) * glass(c); });
  const double mean = over_hemisphere(glass);
  EXPECT_NEAR(metric.gram(0, 0), square, metric.gram_error(0, 0) + 1e-11);
  EXPECT_NEAR(metric.gram(0, 1), mean, metric.gram_error(0, 1) + 1e-11);
  EXPECT_NEAR(metric.gram(0, 2), 0.25 * mean, metric.gram_error(0, 2) + 1e-11);
}

TEST(DeltaParts, OfGlassHaveProductsUnderPatchLights) {
  const double radius = 0.5;
  const std::vector<Material> materials{parse_material("mirror*fresnel:ior=1.5"), parse_material("mirror:rho=0.5"),
                                        parse_material("lambert")};
  const auto metric = measure(device(), materials, Lighting::patch(radius), {.patch_tolerance = 1e-4}).combined;
  // W(L, L) is c^2 times the common area of the disc about L and the unit disc, c = 1 / (pi R^2).
  const double constant = 1 / (pi * radius * radius);
  const auto trace = [&](const std::function<double(double)>& square) {
    return constant * constant * over_hemisphere([&](double cosine) {
             return square(cosine) *
                    static_cast<double>(reference::lens_area(1, radius, std::sqrt(1 - cosine * cosine)));
           });
  };
  const double squared = trace([](double c) { return glass(c) * glass(c); });
  const double mixed = trace([](double c) { return 0.5 * glass(c); });
  EXPECT_NEAR(metric.gram(0, 0), squared, metric.gram_error(0, 0) + 1e-9);
  EXPECT_NEAR(metric.gram(0, 1), mixed, metric.gram_error(0, 1) + 1e-9);
  // With Lambert: c^2 / pi times the integral over Z of the common area A(Z) and of F over the disc about Z.
  const auto about = [&](double z) {
    return reference::integrate(
        [&](double cosine) {
          const double r = std::sqrt(1 - cosine * cosine);
          const double inside = (r * r + z * z - radius * radius) / (2 * r * z);
          return glass(cosine) * cosine * 2 * std::acos(std::clamp(inside, -1.0, 1.0));
        },
        0, 1, 1e-7);
  };
  const double received = reference::integrate(
      [&](double z) { return static_cast<double>(reference::lens_area(1, radius, z)) * about(z) * 2 * pi * z; }, 1e-9,
      1, 1e-6);
  EXPECT_NEAR(metric.gram(0, 2), constant * constant / pi * received, metric.gram_error(0, 2) + 1e-6);
}

// At the critical angle the share begins as a root: of an index below 1, seen from inside.
TEST(DeltaParts, ThatReflectTotallyHaveProductsWithErrorsThatHold) {
  const double critical = 0.6;  // cosine of the critical angle
  const auto over_both = [&](const std::function<double(double)>& g) {
    const auto weighted = [&](double cosine) { return g(cosine) * cosine; };
    return 2 * pi *
           (reference::integrate(weighted, 0, critical, 1e-11) + reference::integrate(weighted, critical, 1, 1e-11));
  };
  const double square = over_both([&](double c) { return water_from_inside(c) * water_from_inside(c); });
  const double mean = over_both(water_from_inside);
  const double radius = 0.5;
  const double squared_in_patches = over_both([&](double c) {
                                      return water_from_inside(c) * water_from_inside(c) *
                                             static_cast<double>(reference::lens_area(1, radius, std::sqrt(1 - c * c)));
                                    }) /
                                    std::pow(pi * radius * radius, 2);
  const std::vector<Material> materials{parse_material("mirror*fresnel:ior=0.8"), parse_material("lambert")};
  for (const double tolerance : {5e-3, 1e-7}) {
    SCOPED_TRACE(tolerance);
    const MetricOptions options{.tolerance = tolerance, .patch_tolerance = std::max(tolerance, 1e-4)};
    const auto daylight = measure(device(), materials, Lighting::daylight(), options).combined;
    EXPECT_NEAR(daylight.gram(0, 0), square, daylight.gram_error(0, 0) + 1e-10);
    EXPECT_NEAR(daylight.gram(0, 1), mean, daylight.gram_error(0, 1) + 1e-10);
    EXPECT_LE(daylight.gram_error(0, 0), tolerance * square);
    const auto means = measure(device(), materials, Lighting::mean_albedo(), options).combined;
    EXPECT_NEAR(means.gram(0, 0), mean * mean, means.gram_error(0, 0) + 1e-10);
    EXPECT_NEAR(means.gram(0, 1), pi * mean, means.gram_error(0, 1) + 1e-10);
    EXPECT_LE(means.gram_error(0, 0), tolerance * mean * mean);
    const auto patch = measure(device(), materials, Lighting::patch(radius), options).combined;
    EXPECT_NEAR(patch.gram(0, 0), squared_in_patches, patch.gram_error(0, 0) + 1e-9);
    EXPECT_LE(patch.gram_error(0, 0), options.patch_tolerance * squared_in_patches);
  }
}

TEST(DeltaParts, OfTablesVaryByRow) {
  const auto grid = HemisphereGrid::gauss(6, 12);
  const auto general = tabulate(device(), parse_material("mirror*fresnel:ior=1.5"), grid, {.form = TableForm::general});
  const auto table = tabulate(device(), parse_material("mirror*fresnel:ior=1.5"), grid);
  for (std::size_t ring = 0; ring < grid.rings().size(); ++ring) {
    EXPECT_NEAR(table.mirror[ring], glass(std::cos(grid.rings()[ring].theta)), 1e-14) << ring;
  }
  for (std::size_t row = 0; row < general.rows(); ++row) {
    EXPECT_EQ(general.mirror[row], table.mirror[grid.ring_of(row)]) << row;
  }
  EXPECT_TRUE(table.retro.empty());
}

TEST(DeltaParts, OfTablesHaveTheErrorOfTheirInterpolation) {
  const auto table = tabulate(device(), parse_material("mirror*fresnel:ior=1.5"), HemisphereGrid::gauss(8, 16));
  const std::vector<double> angles{0.2, 0.9, 70 * pi / 180, 1.4};
  const auto albedos = albedo(table, angles).front();
  for (std::size_t k = 0; k < angles.size(); ++k) {
    EXPECT_NEAR(albedos[k].value, glass(std::cos(angles[k])), albedos[k].error) << angles[k];
    // Of eight rings, on which Fresnel's equations rise at the horizon as a kink does.
    EXPECT_LT(albedos[k].error, 0.06) << angles[k];
  }
}

TEST(DeltaParts, OfCellsAreAverages) {
  using Share = double (*)(double);
  for (const auto& [text, share] : {std::pair<const char*, Share>("mirror*fresnel:ior=1.5", glass),
                                    {"mirror*fresnel:ior=0.8", water_from_inside}}) {
    const auto table = tabulate(device(), parse_material(text), HemisphereGrid::parse("klems:145"));
    const double mean = over_hemisphere(share) / pi;
    EXPECT_NEAR(row_albedos(table).mean.front().value, mean, 1e-10) << text;
  }
}

TEST(DeltaParts, ThatGrowWithoutBoundAreRefused) {
  for (const char* text : {"mirror*cos_max", "mirror*power_mean:p=1,alpha=-1", "rrim*half_cosine:alpha=-1"}) {
    EXPECT_THROW((void)albedo(device(), parse_material(text), kDeltaAngles), NumericError) << text;
  }
  EXPECT_NO_THROW((void)albedo(device(), parse_material("mirror*cos_max*lacquer:s=0.1"), kDeltaAngles));
}

TEST(Factors, ThatGrowTooFastTogetherHaveNoNorm) {
  const auto norm_of = [](const std::string& text) {
    return measure(device(), std::vector<Material>{parse_material(text)}, Lighting::point(), {.tolerance = 1e-3});
  };
  EXPECT_THROW((void)norm_of("phong:n=20*power_mean:p=-1,alpha=-0.6*power_mean:p=-1,alpha=-0.6"), NumericError);
  EXPECT_NO_THROW((void)norm_of("phong:n=20*power_mean:p=-1,alpha=-0.3*power_mean:p=-1,alpha=-0.3"));
}

TEST(DeltaParts, ArePumpedUpWithTheRest) {
  // g1 of a mirror alone divides it by its own albedo.
  const auto mirror = made("mirror:rho=0.3*fresnel:ior=1.5@pump");
  EXPECT_THAT(albedos_of(mirror), Each(EstimateNear(1, kAdjustmentError)));
  const auto both = made("lambert:scale=0.2+mirror*fresnel:ior=1.5@pump:times=2");
  EXPECT_THAT(albedos_of(both), Each(Field(&Estimate::value, Le(1 + 2 * kAdjustmentError))));
  // (L, R) is divided by a(L) = a(R).
  const auto once =
      tabulate(device(), made("lambert:scale=0.2+mirror*fresnel:ior=1.5@pump"), HemisphereGrid::gauss(6, 12));
  for (std::size_t ring = 0; ring < once.grid.rings().size(); ++ring) {
    const double mirrored = glass(std::cos(once.grid.rings()[ring].theta));
    EXPECT_NEAR(once.mirror[ring], mirrored / (0.2 + mirrored), kAdjustmentError) << ring;
  }
}

class MirrorExtension : public ::testing::TestWithParam<std::string> {};

TEST_P(MirrorExtension, MakesTheAlbedoOne) {
  const auto extended = made(GetParam() + "@mirror");
  EXPECT_THAT(albedos_of(extended), Each(EstimateCovers(1, kAdjustmentError)));
  EXPECT_TRUE(check_plausibility(device(), extended, {.tolerance = 1e-4}).is_plausible());
}

INSTANTIATE_TEST_SUITE_P(materials, MirrorExtension,
                         ::testing::Values("phong:n=20", "ggx:alpha=0.3", "lambert:scale=0.5",
                                           "oren_nayar:sigma=0.3@normalise"),
                         [](const auto& one) { return std::string(1, static_cast<char>('a' + one.index)); });

TEST(MirrorExtension, OfGlassReflectsItsShareOfWhatIsLeft) {
  const auto extended = made("phong:n=20@mirror:ior=1.5");
  const auto plain = albedos_of(parse_material("phong:n=20"));
  const auto albedos = albedos_of(extended);
  for (std::size_t k = 0; k < kDeltaAngles.size(); ++k) {
    const double expected = plain[k].value + (1 - plain[k].value) * glass(std::cos(kDeltaAngles[k]));
    EXPECT_NEAR(albedos[k].value, expected, kAdjustmentError) << k;
  }
}

TEST(MirrorExtension, HasItsOwnMirrorForEveryChannel) {
  const auto extended = made("phong:n=20,scale=0.5/1@mirror");
  const auto albedos = albedo(device(), extended, kDeltaAngles);
  ASSERT_EQ(albedos.size(), 2U);
  EXPECT_THAT(albedos, Each(Each(EstimateCovers(1, kAdjustmentError))));
}

TEST(MirrorExtension, SurvivesJson) {
  const auto extended = made("phong:n=20@mirror:ior=1.5");
  const auto read = material_from_json(to_json(extended));
  EXPECT_EQ(to_json(read), to_json(extended));
  EXPECT_EQ(albedos_of(read)[3].value, albedos_of(extended)[3].value);
}

TEST(MirrorExtension, RefusesAlbedosAboveOneAndAnisotropicModels) {
  try {
    (void)made("ward:m=0.2@mirror");
    FAIL() << "not refused";
  } catch (const NumericError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("cannot be extended by a mirror: its albedo is"));
  }
  EXPECT_THROW((void)made("ward_anisotropic:m_x=0.1,m_y=0.2@mirror"), NumericError);
}

TEST(MirrorExtension, IsWrittenAsAText) {
  for (const char* text : {"mirror", "mirror:ior=1.5,k=0", "mirror:ior=0.2,k=3.5"}) {
    SCOPED_TRACE(text);
    EXPECT_EQ(to_string(parse_adjustment(text)), text);
  }
  EXPECT_EQ(to_string(parse_adjustment("mirror:ior=2")), "mirror:ior=2,k=0");
  for (const char* text : {"mirror:k=1", "mirror:ior=-1", "mirror:ior=x", "mirror:n=1.5", "miror"}) {
    EXPECT_THROW((void)parse_adjustment(text), ArgumentError) << text;
  }
}

}  // namespace
}  // namespace lobe::test
