#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "model/evaluate.hpp"
#include "models/model_test.hpp"
#include "support/device.hpp"
#include "support/names.hpp"

namespace lobe::test {
namespace {

using std::numbers::pi;

/// Pairs at all azimuths, about the mirror direction and elsewhere.
std::vector<Directions> around(double turn) {
  std::vector<Directions> list;
  for (const double theta_in : {0.0, 0.4, 1.2, 1.57}) {
    for (const double theta_out : {0.1, 0.41, 1.2}) {
      for (const double delta_phi : {0.0, 1.0, 3.0, pi}) {
        for (const double phi_in : {0.0, 0.5, 1.9, 4.0})
          list.push_back({theta_in, theta_out, delta_phi, phi_in + turn});
      }
    }
  }
  return list;
}

void expect_equal(const Eigen::MatrixXd& values, const Eigen::MatrixXd& expected, double ulps) {
  for (Eigen::Index i = 0; i < values.rows(); ++i) {
    EXPECT_NEAR(values(i, 0), expected(i, 0), ulps * kDoubleEps * expected(i, 0)) << "pair " << i;
  }
}

Eigen::MatrixXd values_of(const std::string& specification, double turn = 0) {
  return evaluate(device(), parse_material(specification), around(turn));
}

struct Twin {
  std::string name;
  std::string isotropic;
};

std::ostream& operator<<(std::ostream& out, const Twin& twin) {
  return out << twin.name;
}

class EqualParameters : public ::testing::TestWithParam<Twin> {};

TEST_P(EqualParameters, GiveTheIsotropicModel) {
  // exp(-x) at the largest x of the pairs, 350: as many ulps.
  expect_equal(values_of(GetParam().name), values_of(GetParam().isotropic), 1000);
}

INSTANTIATE_TEST_SUITE_P(
    anisotropic, EqualParameters,
    ::testing::Values(
        Twin{"ward_anisotropic:m_x=0.3,m_y=0.3,rotation=0.4", "ward:m=0.3"},
        Twin{"ggx_anisotropic:alpha_x=0.3,alpha_y=0.3,f0=0.1,rotation=0.4", "ggx:alpha=0.3,f0=0.1"},
        Twin{"ashikhmin_shirley_anisotropic:n_u=30,n_v=30,f0=0.1,rotation=0.4", "ashikhmin_shirley:n=30,f0=0.1"},
        Twin{"schlick_anisotropic:r=0.1,p=1,rotation=0.4", "schlick:r=0.1"},
        Twin{"lafortune_anisotropic:c_x=-1,c_y=-1,c_z=0.8,n=5,rotation=0.4", "lafortune:c_xy=-1,c_z=0.8,n=5"},
        Twin{"lafortune_matrix:m_xx=-1,m_yy=-1,m_zz=0.8,n=5", "lafortune:c_xy=-1,c_z=0.8,n=5"},
        Twin{"exponential_patch_anisotropic:s=8,ratio=1,rotation=0.4", "exponential_patch:s=8"},
        Twin{"basic_patch_anisotropic:R=0.4,ratio=1,rotation=0.4", "basic_patch:R=0.4"},
        Twin{"retro_patch_anisotropic:R=0.4,ratio=1,rotation=0.4", "retro_patch:R=0.4"},
        Twin{"metal_phong_anisotropic:n=5,p=0.5,rotation=0.4", "p_model:n=5,p=0.5"}),
    ByName{});

// Rounding chose the azimuth of H, so that tables were not what their formulas said at the mirror directions.
TEST(SchlickAnisotropic, PutsTheHalfVectorOverTheSecondAxisAtTheMirrorDirection) {
  const double p = 0.15;
  std::vector<Directions> mirror;
  for (const double theta : {0.0, 0.2, 0.9, 1.5, 1.5707}) {
    for (int k = 0; k < 64; ++k) mirror.push_back({theta, theta, pi, 2 * pi * k / 64});
  }
  const auto values = [&](const std::string& specification) {
    return evaluate(device(), parse_material(specification), mirror);
  };
  expect_equal(values("schlick_anisotropic:r=0.5,p=0.15,rotation=0.28"), values("schlick:r=0.5") / std::sqrt(p), 4000);
}

/// A model with its first parameter's value along the first axis, and with both exchanged.
struct Exchange {
  std::string name;
  std::string exchanged;
};

std::ostream& operator<<(std::ostream& out, const Exchange& exchange) {
  return out << exchange.name;
}

class QuarterTurn : public ::testing::TestWithParam<Exchange> {};

TEST_P(QuarterTurn, OfTheDirectionsExchangesTheParameters) {
  expect_equal(values_of(GetParam().name), values_of(GetParam().exchanged, pi / 2), 4000);
}

TEST_P(QuarterTurn, OfTheLobeIsThatOfTheDirections) {
  expect_equal(values_of(GetParam().name + ",rotation=1.1", 1.1), values_of(GetParam().name), 4000);
}

INSTANTIATE_TEST_SUITE_P(
    anisotropic, QuarterTurn,
    ::testing::Values(Exchange{"ward_anisotropic:m_x=0.3,m_y=0.6", "ward_anisotropic:m_x=0.6,m_y=0.3"},
                      Exchange{"ggx_anisotropic:alpha_x=0.1,alpha_y=0.5", "ggx_anisotropic:alpha_x=0.5,alpha_y=0.1"},
                      Exchange{"ashikhmin_shirley_anisotropic:n_u=5,n_v=80",
                               "ashikhmin_shirley_anisotropic:n_u=80,n_v=5"}),
    ByName{});

TEST(Anisotropic, LobeDependsOnTheAzimuthOfBothDirections) {
  const std::vector<Directions> along{{0.5, 0.7, pi, 0}};
  const std::vector<Directions> across{{0.5, 0.7, pi, pi / 2}};
  const auto material = parse_material("ward_anisotropic:m_x=0.05,m_y=0.5");

  const double sharp = evaluate(device(), material, along)(0, 0);
  const double wide = evaluate(device(), material, across)(0, 0);

  // tan delta = tan(0.1): by hand exp(-tan^2 (1/m_x^2 - 1/m_y^2)).
  EXPECT_NEAR(sharp / wide, std::exp(-std::pow(std::tan(0.1), 2) * (400 - 4)), 1e-13);
}

// Cox and Munk 1954, abstract: at high winds the most frequent slope is one of a few degrees, rising downwind. Normals
// of facets that rise downwind lean upwind.
TEST(Anisotropic, MostFrequentFacetsOfTheSeaRiseDownwindAndSteepOnesUpwind) {
  const auto ratio_at = [](double slope) {
    const double theta = std::atan(slope);
    const std::vector<Directions> upwind{{theta, theta, 0, 0.4 + pi}};
    const std::vector<Directions> downwind{{theta, theta, 0, 0.4}};
    const auto sea = parse_material("cox_munk_anisotropic:wind=10,rotation=0.4");
    return evaluate(device(), sea, upwind)(0, 0) / evaluate(device(), sea, downwind)(0, 0);
  };
  // All but the odd terms of the series is the same. With eta = slope / sqrt(0.0316) these are -0.038 eta
  // + 0.29/6 (eta^3 - 3 eta), the others 1.05 - 0.03 (eta^2 - 1) + 0.23/24 (eta^4 - 6 eta^2 + 3).
  const auto expected_at = [](double slope) {
    const double eta = slope / std::sqrt(0.0316);
    const double odd = -0.038 * eta + 0.29 / 6 * eta * (eta * eta - 3);
    const double even = 1.05 - 0.03 * (eta * eta - 1) + 0.23 / 24 * (std::pow(eta, 4) - 6 * eta * eta + 3);
    return (even - odd) / (even + odd);
  };

  EXPECT_GT(expected_at(0.1), 1.1);
  EXPECT_LT(expected_at(0.4), 0.9);
  for (const double slope : {0.1, 0.4}) EXPECT_NEAR(ratio_at(slope), expected_at(slope), 1e-13) << slope;
}

}  // namespace
}  // namespace lobe::test
