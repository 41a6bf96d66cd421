#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "kernel/microfacet_cases.hpp"
#include "model/evaluate.hpp"
#include "support/device.hpp"
#include "support/error_budget.hpp"

namespace lobe::test {
namespace {

using std::numbers::pi;

ModelCase ward(const std::string& m_x, const std::string& m_y, const std::string& rotation) {
  const Real x = std::stold(m_x);
  const Real y = std::stold(m_y);
  const Real turn = std::stod(rotation);
  return {"ward_anisotropic:m_x=" + m_x + ",m_y=" + m_y + ",rotation=" + rotation,
          [=](const Vector& l, const Vector& v) { return reference::ward_anisotropic(l, v, x, y, turn); },
          // 1 + tan^2 delta (1/m_x^2 + 1/m_y^2)
          [=](const Vector& l, const Vector& v) {
            return 1 + tan_squared_delta(half_vector(l, v)) * (1 / (x * x) + 1 / (y * y));
          },
          static_cast<double>(2 * std::min(x, y))};
}

ModelCase ggx(const std::string& alpha_x, const std::string& alpha_y, const std::string& f0,
              const std::string& rotation) {
  const Real x = std::stold(alpha_x);
  const Real y = std::stold(alpha_y);
  const Real at_normal = std::stold(f0);
  const Real turn = std::stod(rotation);
  return {"ggx_anisotropic:alpha_x=" + alpha_x + ",alpha_y=" + alpha_y + ",f0=" + f0 + ",rotation=" + rotation,
          [=](const Vector& l, const Vector& v) { return reference::ggx_anisotropic(l, v, x, y, at_normal, turn); },
          [=](const Vector& l, const Vector& v) {
            return std::max(x, y) / std::min(x, y) + schlick_condition(at_normal, l, v);
          },
          static_cast<double>(2 * std::min(x, y))};
}

ModelCase ashikhmin_shirley(const std::string& n_u, const std::string& n_v, const std::string& f0,
                            const std::string& rotation) {
  const Real u = std::stold(n_u);
  const Real v = std::stold(n_v);
  const Real at_normal = std::stold(f0);
  const Real turn = std::stod(rotation);
  return {"ashikhmin_shirley_anisotropic:n_u=" + n_u + ",n_v=" + n_v + ",f0=" + f0 + ",rotation=" + rotation,
          [=](const Vector& l, const Vector& w) {
            return reference::ashikhmin_shirley_anisotropic(l, w, u, v, at_normal, turn);
          },
          // 1 + n |ln N.H|
          [=](const Vector& l, const Vector& w) {
            return 1 + std::max(u, v) * std::log1p(tan_squared_delta(half_vector(l, w))) / 2 +
                   schlick_condition(at_normal, l, w);
          },
          static_cast<double>(1 / std::sqrt(std::max(u, v)))};
}

/// Length of L + V along the base plane below which the reference loses the azimuth of H.
constexpr Real kLostAzimuth = 1e-3L;

ModelCase schlick(const std::string& r, const std::string& p, const std::string& rotation) {
  const Real roughness = std::stold(r);
  const Real isotropy = std::stold(p);
  const Real turn = std::stod(rotation);
  return {
      "schlick_anisotropic:r=" + r + ",p=" + p + ",rotation=" + rotation,
      [=](const Vector& l, const Vector& v) { return reference::schlick_anisotropic(l, v, roughness, isotropy, turn); },
      [=](const Vector& l, const Vector& v) {
        const Vector sum = l + v;
        const Real across = std::hypot(sum.x, sum.y);
        return (across > 0 ? 1 + kLostAzimuth / across : 1) / isotropy;
      },
      static_cast<double>(2 * std::sqrt(roughness))};
}

/// 1 + n k / base: the base of the power is a sum with an absolute error of an ulp.
auto lafortune_condition(const Vector& c, Real n, Real turn) {
  return [=](const Vector& l, const Vector& v) {
    const Real base = reference::lafortune_anisotropic(l, v, c, 1, turn);
    const Real size = std::max(std::abs(c.x), std::abs(c.y)) + std::abs(c.z);
    return 1 + n * size / std::max(base, 1e-10L);
  };
}

/// Where the base is an ulp above or below 0.
auto lafortune_floor(Real constant, Real n) {
  return [=](Real eps) { return constant * std::pow(16 * eps, n); };
}

ModelCase lafortune(const std::string& c_x, const std::string& c_y, const std::string& n, const std::string& rotation) {
  const Vector c{std::stold(c_x), std::stold(c_y), 1};
  const Real exponent = std::stold(n);
  const Real turn = std::stod(rotation);
  return {"lafortune_anisotropic:c_x=" + c_x + ",c_y=" + c_y + ",c_z=1,n=" + n + ",rotation=" + rotation,
          [=](const Vector& l, const Vector& v) { return reference::lafortune_anisotropic(l, v, c, exponent, turn); },
          lafortune_condition(c, exponent, turn), static_cast<double>(1 / std::sqrt(exponent)),
          lafortune_floor(1, exponent)};
}

ModelCase metal_phong(const std::string& n, const std::string& c_x, const std::string& c_y, const std::string& p,
                      const std::string& rotation) {
  const Vector c{std::stold(c_x), std::stold(c_y), 1};
  const Real exponent = std::stold(n);
  const Real power = std::stold(p);
  const Real turn = std::stod(rotation);
  return {"metal_phong_anisotropic:n=" + n + ",c_x=" + c_x + ",c_y=" + c_y + ",p=" + p + ",rotation=" + rotation,
          [=](const Vector& l, const Vector& v) {
            return reference::metal_phong_anisotropic(l, v, exponent, c, power, turn);
          },
          lafortune_condition({-c.x, -c.y, c.z}, exponent, turn), static_cast<double>(1 / std::sqrt(exponent)),
          lafortune_floor(1e4L * (exponent + 2), exponent)};
}

ModelCase lafortune_matrix(const std::string& parameters, const reference::SymmetricMatrix& m, Real n) {
  return {"lafortune_matrix:" + parameters,
          [=](const Vector& l, const Vector& v) { return reference::lafortune_matrix(l, v, m, n); },
          // 1 + n k / base
          [=](const Vector& l, const Vector& v) {
            const Real size = std::max({std::abs(m.xx), std::abs(m.xy), std::abs(m.yy)}) + std::abs(m.xz) +
                              std::abs(m.yz) + std::abs(m.zz);
            return 1 + n * size / std::max(reference::lafortune_matrix(l, v, m, 1), 1e-10L);
          },
          static_cast<double>(1 / std::sqrt(n)), lafortune_floor(1, n)};
}

ModelCase exponential_patch(const std::string& s, const std::string& ratio, const std::string& p,
                            const std::string& rotation) {
  const Real decay = std::stold(s);
  const reference::PatchNorm norm{std::stold(ratio), std::stold(p), static_cast<Real>(std::stod(rotation))};
  const Real constant = reference::exponential_patch_constant(decay, norm);
  return {"exponential_patch_anisotropic:s=" + s + ",ratio=" + ratio + ",p=" + p + ",rotation=" + rotation,
          [=](const Vector& l, const Vector& v) {
            return constant * std::exp(-decay * reference::patch_metric(l, v, norm));
          },
          // 1 + s |V_P - L'_P|
          [=](const Vector& l, const Vector& v) { return 1 + decay * std::hypot(l.x + v.x, l.y + v.y); },
          static_cast<double>(1 / decay)};
}

/// A patch with an edge; `distance` of a pair in its norm.
ModelCase patch(const std::string& model, const std::string& parameters, Real radius, const reference::PatchNorm& norm,
                Real band) {
  const Real constant = 1 / reference::patch_norm_area(radius, norm);
  const bool is_retro = model == "retro_patch_anisotropic";
  const auto distance = [=](const Vector& l, const Vector& v) {
    return reference::patch_metric(is_retro ? reference::mirrored(l) : l, v, norm);
  };
  return {model + ":" + parameters,
          [=](const Vector& l, const Vector& v) { return distance(l, v) <= radius ? constant : 0; },
          // Any error of the geometry decides at the edge, none elsewhere; the band holds what single precision moves.
          [=](const Vector& l, const Vector& v) {
            return std::abs(distance(l, v) - radius) < band * radius ? std::numeric_limits<Real>::infinity() : 1;
          },
          static_cast<double>(radius / 3)};
}

ModelCase basic_patch(const std::string& radius, const std::string& ratio, const std::string& p,
                      const std::string& rotation) {
  return patch("basic_patch_anisotropic", "R=" + radius + ",ratio=" + ratio + ",p=" + p + ",rotation=" + rotation,
               std::stold(radius), {std::stold(ratio), std::stold(p), static_cast<Real>(std::stod(rotation))}, 2e-6L);
}

ModelCase retro_patch(const std::string& radius, const std::string& ratio, const std::string& p,
                      const std::string& rotation) {
  return patch("retro_patch_anisotropic", "R=" + radius + ",ratio=" + ratio + ",p=" + p + ",rotation=" + rotation,
               std::stold(radius), {std::stold(ratio), std::stold(p), static_cast<Real>(std::stod(rotation))},
               2e-6L / std::stold(radius));
}

INSTANTIATE_TEST_SUITE_P(
    lafortune_matrix, ModelKernel,
    ::testing::Values(lafortune_matrix("m_xx=-1,m_yy=-0.8,m_zz=0.9,m_xy=0.1,m_xz=0.3,m_yz=-0.2,n=20",
                                       {-1, -0.8L, 0.9L, 0.1L, 0.3L, -0.2L}, 20),
                      lafortune_matrix("m_xx=0.5,m_yy=-0.3,m_zz=0.2,m_xy=-0.7,m_xz=1,n=3",
                                       {0.5L, -0.3L, 0.2L, -0.7L, 1, 0}, 3),
                      lafortune_matrix("m_xx=-0.9,m_yy=-1,m_zz=1,m_xz=0.4,n=200", {-0.9L, -1, 1, 0, 0.4L, 0}, 200)),
    [](const auto& instance) { return "matrix_" + std::to_string(instance.index); });
INSTANTIATE_TEST_SUITE_P(
    exponential_patch_anisotropic, ModelKernel,
    ::testing::Values(exponential_patch("8", "1", "2", "0"), exponential_patch("20", "0.2", "2", "0.6"),
                      exponential_patch("500", "0.02", "2", "-1.2"), exponential_patch("20", "0.3", "4", "0"),
                      exponential_patch("2", "0.5", "10", "0.6"), exponential_patch("20", "0.3", "1", "0.6"),
                      exponential_patch("2", "0.5", "1.5", "0"), exponential_patch("100", "0.1", "3", "-1.2"),
                      exponential_patch("5", "0.5", "100", "0.6")),
    ByName{});
INSTANTIATE_TEST_SUITE_P(basic_patch_anisotropic, ModelKernel,
                         ::testing::Values(basic_patch("0.001", "0.01", "2", "0.6"), basic_patch("0.3", "1", "2", "0"),
                                           basic_patch("0.3", "0.2", "2", "-1.2"),
                                           basic_patch("0.5", "0.5", "1", "0.6"), basic_patch("0.7", "0.3", "1.5", "0"),
                                           basic_patch("1.25", "0.8", "3", "0"),
                                           basic_patch("0.4", "0.5", "100", "0.6"), basic_patch("2", "0.5", "1", "0.6"),
                                           basic_patch("2", "0.5", "2", "0.6")),
                         ByName{});
INSTANTIATE_TEST_SUITE_P(retro_patch_anisotropic, ModelKernel,
                         ::testing::Values(retro_patch("0.01", "0.1", "2", "0.6"), retro_patch("0.3", "0.2", "2", "0"),
                                           retro_patch("0.5", "0.5", "1", "0.6"),
                                           retro_patch("0.7", "0.3", "3", "-1.2"), retro_patch("2", "0.5", "2", "0.6")),
                         ByName{});
INSTANTIATE_TEST_SUITE_P(lafortune_anisotropic, ModelKernel,
                         ::testing::Values(lafortune("-1", "-1", "20", "0"), lafortune("-1", "-0.7", "20", "0.6"),
                                           lafortune("-1", "1", "50", "0"), lafortune("0.9", "0.3", "5", "-1.2")),
                         ByName{});
INSTANTIATE_TEST_SUITE_P(metal_phong_anisotropic, ModelKernel,
                         ::testing::Values(metal_phong("20", "1", "1", "1", "0"),
                                           metal_phong("100", "1", "0.8", "1", "0.6"),
                                           metal_phong("5", "0.5", "0.9", "0.5", "-1.2")),
                         ByName{});
INSTANTIATE_TEST_SUITE_P(ward_anisotropic, ModelKernel,
                         ::testing::Values(ward("0.2", "0.2", "0"), ward("0.05", "0.5", "0"),
                                           ward("0.5", "0.05", "0.6"), ward("0.005", "0.02", "-1.2")),
                         ByName{});
INSTANTIATE_TEST_SUITE_P(ggx_anisotropic, ModelKernel,
                         ::testing::Values(ggx("0.3", "0.3", "1", "0"), ggx("0.05", "0.5", "0.04", "0"),
                                           ggx("1", "0.1", "1", "0.6"), ggx("0.01", "0.04", "1", "-1.2")),
                         ByName{});
INSTANTIATE_TEST_SUITE_P(ashikhmin_shirley_anisotropic, ModelKernel,
                         ::testing::Values(ashikhmin_shirley("20", "20", "1", "0"),
                                           ashikhmin_shirley("10", "1000", "0.04", "0"),
                                           ashikhmin_shirley("5000", "50", "1", "0.6")),
                         ByName{});
INSTANTIATE_TEST_SUITE_P(schlick_anisotropic, ModelKernel,
                         ::testing::Values(schlick("0.2", "1", "0"), schlick("0.01", "0.3", "0"),
                                           schlick("0.0001", "0.1", "0.6")),
                         ByName{});

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

}  // namespace
}  // namespace lobe::test
