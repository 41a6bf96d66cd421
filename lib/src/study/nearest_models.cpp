#include "study/nearest_models.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "core/text.hpp"

namespace lobe {

bool has_nearest_models(const Study& study) {
  const auto files = std::ranges::count_if(study.files, [](const auto& file) { return file.has_value(); });
  return files > 0 && static_cast<std::size_t>(files) < study.materials.size();
}

namespace {

/// How near a model is to a material.
struct Candidate {
  std::size_t model = 0;
  double scale = 1;   ///< that the model is multiplied by
  Estimate distance;  ///< of the material from the scaled model
};

double product(const Eigen::MatrixXd& matrix, std::size_t i, std::size_t j) {
  return matrix(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
}

Candidate as_it_is(const Metric& metric, std::size_t material, std::size_t model) {
  return {model, 1, {product(metric.distance, material, model), product(metric.distance_error, material, model)}};
}

/// The model times the factor s that brings it nearest: s = f.g / g.g, |f - s g|^2 = f.f - (f.g)^2 / g.g.
Candidate scaled(const Metric& metric, std::size_t material, std::size_t model) {
  const double ff = product(metric.gram, material, material);
  const double fg = product(metric.gram, material, model);
  const double gg = product(metric.gram, model, model);
  const double scale = gg > 0 ? std::max(fg / gg, 0.0) : 0;
  const double square = std::max(ff - scale * fg, 0.0);
  const double error = product(metric.gram_error, material, material) +
                       2 * scale * product(metric.gram_error, material, model) +
                       scale * scale * product(metric.gram_error, model, model);
  const double value = std::sqrt(square);
  return {model, scale, {value, value > 0 ? std::min(error / value, std::sqrt(error)) : std::sqrt(error)}};
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
      if (!study.files[j]) all.push_back(candidate_of(metric, material, j));
    }
    std::ranges::stable_sort(all, {}, [](const Candidate& one) { return one.distance.value; });
    const double norm = metric.norm(static_cast<Eigen::Index>(material));
    for (std::size_t k = 0; k < std::min(study.clustering.neighbours, all.size()); ++k) {
      fmt::format_to(std::back_inserter(text), "{},{},{},{},{},{},{},{},{},{}\n",
                     csv_field(study.materials[material].name), by, k + 1,
                     csv_field(study.materials[all[k].model].name), csv_field(study.materials[all[k].model].family),
                     shortest(all[k].scale), shortest(all[k].distance.value), shortest(all[k].distance.error),
                     shortest(all[k].distance.value / norm), is_rank_uncertain(all[k], all) ? "yes" : "no");
    }
  };
  for (std::size_t i = 0; i < study.materials.size(); ++i) {
    if (!study.files[i]) continue;
    add(i, "distance", as_it_is);
    add(i, "scaled", scaled);
  }
  return text;
}

}  // namespace lobe
