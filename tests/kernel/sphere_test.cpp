// Shading of spheres on the device, against vectors of the host at the same nodes.
#include "device/shade_sphere.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "hemisphere/gauss.hpp"
#include "lobe/model/material.hpp"
#include "model/lobes.hpp"
#include "reference/models.hpp"
#include "reference/sphere.hpp"
#include "support/deviation.hpp"
#include "support/device.hpp"

namespace lobe::test {
namespace {

using reference::Real;
using reference::Vector;

// Within the sphere, across its outline, and to the pole; an odd number, so that the last pack is not full.
const std::vector<SpherePart> kParts{{0.1, 0.2, 0.1, 0.2},    {-0.7, -0.6, 0.5, 0.6},  {0.3, 0.4, -0.9, -0.8},
                                     {0.9, 1.0, 0.1, 0.2},    {-1.0, -0.9, -0.2, 0.0}, {-0.05, 0.05, 0.95, 1.0},
                                     {-0.1, 0.0, -1.0, -0.9}, {0.0, 0.1, 0.0, 0.1},    {0.6, 0.8, 0.55, 0.6}};
const std::vector<std::array<double, 4>> kLights{{-0.48, 0.64, 0.6, 2.5}, {0.8, 0.0, -0.6, 1.5}};

/// The sum that the kernel forms, with the reference's axes and model.
Real shaded(const SpherePart& part, const GaussRule& rule, const reference::SphereReflectance& f) {
  std::vector<reference::SphereLight> lights;
  for (const auto& [x, y, z, irradiance] : kLights) lights.push_back({{x, y, z}, irradiance});
  const auto radiance = reference::under_lights(f, lights);
  Real sum = 0;
  for (std::size_t j = 0; j < rule.nodes.size(); ++j) {
    const Real y = part.y_low + (Real(part.y_high) - part.y_low) * rule.nodes[j];
    const Real reach = std::sqrt(1 - y * y);
    const Real from = std::min(std::max(Real(part.x_low), -reach), reach);
    const Real to = std::min(std::max(Real(part.x_high), -reach), reach);
    for (std::size_t i = 0; i < rule.nodes.size() && to > from; ++i) {
      const Real x = from + (to - from) * rule.nodes[i];
      const Real share = (to - from) * (Real(part.y_high) - part.y_low) * rule.weights[i] * rule.weights[j];
      sum += share * radiance({x, y, std::sqrt(1 - x * x - y * y)});
    }
  }
  return sum;
}

Eigen::MatrixXd shaded_on_device(const std::string& text, const GaussRule& rule, const Eigen::MatrixXd& mix) {
  const Material material = parse_material(text);
  const LobeSet lobes = make_lobe_set({&material, 1}, {.with_anisotropic = true});
  SphereShader shader(device(), lobes.batches, mix, Precision::double_precision);
  return shader.shade(kParts, rule.nodes, rule.weights, kLights);
}

void expect_reference(const std::string& text, const reference::SphereReflectance& f) {
  const GaussRule rule = gauss_rule(3);
  const Eigen::MatrixXd found = shaded_on_device(text, rule, Eigen::MatrixXd::Ones(1, 1));
  Deviation deviation;
  for (std::size_t k = 0; k < kParts.size(); ++k) {
    const auto expected = static_cast<double>(shaded(kParts[k], rule, f));
    // Of the sum a few hundred ulps; directions near the silhouette lose digits.
    deviation.add(std::abs(found(0, static_cast<Eigen::Index>(k)) - expected), 1e-11 * std::abs(expected) + 1e-17,
                  "part " + std::to_string(k));
  }
  deviation.report(text);
  EXPECT_LE(deviation.worst(), 1);
}

TEST(SphereShader, ShadesLambert) {
  expect_reference("lambert", reference::lambert);
}

TEST(SphereShader, ShadesPhong) {
  expect_reference("phong:n=20", [](const Vector& l, const Vector& v) { return reference::phong(l, v, 20); });
}

TEST(SphereShader, ShadesAnisotropicLobesAlongTheParallels) {
  expect_reference("ward_anisotropic:m_x=0.1,m_y=0.4,rotation=0.3", [](const Vector& l, const Vector& v) {
    return reference::ward_anisotropic(l, v, 0.1L, 0.4L, Real(0.3));
  });
}

TEST(SphereShader, MixesLobesIntoRows) {
  const GaussRule rule = gauss_rule(2);
  Eigen::MatrixXd mix(2, 2);
  mix << 0.25, 2, -1, 0.5;
  const std::string text = "lambert+ward:m=0.3";
  const Eigen::MatrixXd found = shaded_on_device(text, rule, mix);

  const Eigen::MatrixXd lambert = shaded_on_device("lambert", rule, Eigen::MatrixXd::Ones(1, 1));
  const Eigen::MatrixXd ward = shaded_on_device("ward:m=0.3", rule, Eigen::MatrixXd::Ones(1, 1));
  const LobeSet lobes = make_lobe_set(std::vector{parse_material(text)});
  const bool lambert_first = lobes.names.front().starts_with("lambert");
  Eigen::MatrixXd both(2, lambert.cols());
  both << (lambert_first ? lambert : ward), (lambert_first ? ward : lambert);
  EXPECT_LT((found - mix * both).cwiseAbs().maxCoeff(), 1e-15);
}

TEST(SphereShader, LeavesPartsBesideTheSphereDark) {
  const std::vector<SpherePart> beside{{0.9, 1.0, 0.9, 1.0}};
  const Material material = parse_material("lambert");
  const LobeSet lobes = make_lobe_set({&material, 1});
  const GaussRule rule = gauss_rule(4);
  SphereShader shader(device(), lobes.batches, Eigen::MatrixXd::Ones(1, 1), Precision::double_precision);
  EXPECT_EQ(shader.shade(beside, rule.nodes, rule.weights, kLights)(0, 0), 0);
}

}  // namespace
}  // namespace lobe::test
