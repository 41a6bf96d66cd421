#include "study/run/nearest_models.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "core/text.hpp"

namespace lobe {

bool has_nearest_models(const Study& study) {
  const std::size_t files = count_files(study);
  return files > 0 && files < study.materials.size();
}

namespace {

/// How near a model is to a material.
struct Candidate {
  std::size_t model = 0;
  double scale = 1;   ///< that the model is multiplied by
  Estimate distance;  ///< of the material from the scaled model
};

double entry(const Eigen::MatrixXd& matrix, std::size_t i, std::size_t j) {
  return matrix(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
}

Candidate as_it_is(const Metric& metric, std::size_t material, std::size_t model) {
  return {model, 1, {entry(metric.distance, material, model), entry(metric.distance_error, material, model)}};
}

/// The model times the factor s >= 0 that brings it nearest: s = f.g / g.g, |f - s g| = |f| sin(angle of f and g),
/// whose angle is that of the chord where products would cancel.
Candidate scaled(const Metric& metric, std::size_t material, std::size_t model) {
  const auto i = static_cast<Eigen::Index>(material);
  const Estimate between = angle(metric, material, model);
  const double scale = entry(metric.gram, material, model) / entry(metric.gram, model, model);
  if (!(scale > 0)) return {model, 0, {metric.norm(i), metric.norm_error(i)}};
  if (std::isnan(between.value)) {
    // A norm that is not above its error: all that is known is that nothing is farther than 0 is.
    const double square = metric.norm(i) * metric.norm(i) - scale * entry(metric.gram, material, model);
    return {model, scale, {std::sqrt(std::max(square, 0.0)), metric.norm(i) + metric.norm_error(i)}};
  }
  const double sine = std::sin(between.value);
  return {model,
          scale,
          {metric.norm(i) * sine, metric.norm_error(i) * sine + metric.norm(i) * std::min(between.error, 1.0)}};
}

/// Some model of another rank is as near within the errors of both.
bool is_rank_uncertain(const Candidate& one, const std::vector<Candidate>& all) {
  return std::ranges::any_of(all, [&](const Candidate& other) {
    return other.model != one.model &&
           !(std::abs(other.distance.value - one.distance.value) > other.distance.error + one.distance.error);
  });
}

}  // namespace

std::string nearest_models_csv(const Study& study, const Metric& metric) {
  std::string text = "material,by,rank,model,family,scale,distance,distance_error,relative_distance,rank_uncertain\n";
  const auto add = [&](std::size_t material, std::string_view by, auto&& candidate_of) {
    std::vector<Candidate> all;
    for (std::size_t j = 0; j < study.materials.size(); ++j) {
      if (study.materials[j].file() == nullptr) all.push_back(candidate_of(metric, material, j));
    }
    std::ranges::stable_sort(all, {}, [](const Candidate& one) { return one.distance.value; });
    const double norm = metric.norm(static_cast<Eigen::Index>(material));
    for (std::size_t k = 0; k < std::min(study.clustering.neighbours, all.size()); ++k) {
      fmt::format_to(
          std::back_inserter(text), "{},{},{},{},{},{},{},{},{},{}\n", csv_field(study.materials[material].name()), by,
          k + 1, csv_field(study.materials[all[k].model].name()), csv_field(study.materials[all[k].model].family()),
          shortest(all[k].scale), shortest(all[k].distance.value), shortest(all[k].distance.error),
          norm > 0 ? shortest(all[k].distance.value / norm) : "", is_rank_uncertain(all[k], all) ? "yes" : "no");
    }
  };
  for (std::size_t i = 0; i < study.materials.size(); ++i) {
    if (study.materials[i].file() == nullptr) continue;
    add(i, "distance", as_it_is);
    add(i, "scaled", scaled);
  }
  return text;
}

}  // namespace lobe
