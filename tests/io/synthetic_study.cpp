#include "synthetic_study.hpp"

#include <cmath>

#include "study/run/agreement.hpp"

namespace lobe::test {
namespace {

Metric synthetic_metric(std::size_t count, double scale) {
  const auto n = static_cast<Eigen::Index>(count);
  Eigen::MatrixXd points(n, 2);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double t = static_cast<double>(i + 1);
    points.row(i) << scale * t, scale * std::sqrt(t) / 3;
  }
  Metric metric;
  metric.gram = points * points.transpose();
  metric.gram_error = 1e-7 * metric.gram;
  metric.norm = points.rowwise().norm();
  metric.norm_error = 1e-8 * metric.norm;
  metric.distance.resize(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) metric.distance(i, j) = (points.row(i) - points.row(j)).norm();
  }
  metric.distance_error = 1e-9 * metric.distance;
  return metric;
}

MetricResult synthetic_result(const Lighting& lighting, std::size_t count) {
  MetricResult result;
  result.lighting = lighting;
  result.channels = {synthetic_metric(count, 1), synthetic_metric(count, 1.5)};
  result.combined = synthetic_metric(count, 1.25);
  if (lighting == Lighting::point()) result.unresolved = {{0, 1, 3e-5}, {1, 1, 2e-6}};
  result.work.nodes = 43008;
  result.work.evaluations = 258048;
  return result;
}

LiteratureMatrix synthetic_comparison(std::size_t count, double scale) {
  const Metric metric = synthetic_metric(count, scale);
  const Eigen::MatrixXd distance = metric.distance.cwiseSqrt();
  return {distance, 1e-4 * distance, metric.norm, 1e-4 * metric.norm};
}

LiteratureResult synthetic_result(LiteratureMetric comparison, std::size_t count) {
  LiteratureResult result;
  result.metric = comparison;
  result.channels = {synthetic_comparison(count, 1), synthetic_comparison(count, 1.5)};
  result.combined = synthetic_comparison(count, 1.25);
  if (comparison == LiteratureMetric::ngan_l2) result.unresolved = {{0, 1, 2e-3}};
  result.work.nodes = 4096;
  result.work.evaluations = 24576;
  return result;
}

/// Of a material by its number: every value another one.
MaterialCurves synthetic_curves(const CurveAngles& angles, std::size_t number) {
  MaterialCurves curves;
  for (std::size_t channel = 0; channel < 2; ++channel) {
    const double base = static_cast<double>(10 * number + channel);
    auto& albedos = curves.albedo.emplace_back();
    for (const double theta : angles.theta) albedos.push_back({base + theta, 1e-5 * (1 + base)});
    auto& slices = curves.reflectance.emplace_back();
    for (const double in : angles.theta_in) {
      auto& slice = slices.emplace_back();
      for (const double out : angles.theta_out) slice.push_back({base + in + 0.1 * (out + 1), 1e-6 * (1 + base)});
    }
  }
  curves.has_delta = number == 1;
  return curves;
}

}  // namespace

StudyResult synthetic_study(std::size_t per_family) {
  StudyResult result;
  Study& study = result.study;
  study.name = "synthetic";
  study.title = "Synthetic study";
  study.comment = "made up, for tests";
  study.references = {"Somebody: Something, 1999", "Ähnliches, 2001"};
  study.channels = {"red", "green"};
  study.channel_weights = {0.25, 0.75};
  study.lightings = {Lighting::point(), Lighting::daylight()};
  study.comparison_metrics = {LiteratureMetric::ngan_l2, LiteratureMetric::log_relative};
  study.approximations = {FamilyFit::linear, FamilyFit::non_negative};
  study.configuration = "[study]\nname = \"synthetic\"\n";
  for (std::size_t i = 0; i < 2 * per_family; ++i) {
    const bool is_phong = i < per_family;
    const double n = static_cast<double>(i + 1);
    Material material = is_phong ? make_material("phong", {{"n", n}}) : make_material("ward", {{"m", 0.5 / n}});
    material.name = (is_phong ? "Phong n=" : "Ward, \"no\" ") + std::to_string(i + 1);
    material.family = is_phong ? "Phong" : "Ward";
    material.terms.front().weight = {0.5, 1.0 / 3};
    study.materials.push_back(std::move(material));
  }
  result.device.platform = "Made-up platform";
  result.device.platform_version = "OpenCL 1.2";
  result.device.name = "Made-up device";
  result.device.version = "OpenCL 1.2";
  result.device.driver = "7.0";
  for (const auto& lighting : study.lightings) {
    result.metrics.push_back(synthetic_result(lighting, study.materials.size()));
    result.embeddings.push_back(classical_scaling(result.metrics.back().combined.distance));
    result.clusterings.push_back(cluster_materials(result.metrics.back().combined));
    for (const bool non_negative : {false, true}) {
      result.residuals.push_back(
          family_residuals(result.metrics.back(), labels(study), non_negative, study.channel_weights));
    }
  }
  for (const auto comparison : study.comparison_metrics) {
    result.comparisons.push_back(synthetic_result(comparison, study.materials.size()));
  }
  result.agreement = metric_agreement(result);
  result.curve_angles = {.theta = {0, 0.5, 1}, .theta_in = {0.25, 0.75}, .theta_out = {-1, -0.25, 0.25, 1}};
  for (std::size_t i = 0; i < study.materials.size(); ++i) {
    result.curves.push_back(synthetic_curves(result.curve_angles, i));
  }
  return result;
}

}  // namespace lobe::test
