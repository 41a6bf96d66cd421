#include "study/write/clustering_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <vector>

#include "core/text.hpp"

namespace lobe {

std::string medoids_csv(std::span<const MaterialLabel> materials, const Metric& metric, const Clustering& clustering) {
  const Medoids& medoids = clustering.medoids;
  std::string text = "medoid,material,distance,distance_error,silhouette,silhouette_error\n";
  for (std::size_t k = 0; k < medoids.medoid.size(); ++k) {
    const auto medoid = static_cast<Eigen::Index>(medoids.medoid[k]);
    std::vector<std::size_t> members;
    for (std::size_t i = 0; i < materials.size(); ++i) {
      if (medoids.cluster[i] == k) members.push_back(i);
    }
    const auto distance = [&](std::size_t i) { return metric.distance(static_cast<Eigen::Index>(i), medoid); };
    // A material that coincides with the medoid does not precede it.
    std::stable_sort(members.begin(), members.end(), [&](std::size_t a, std::size_t b) {
      if (b == medoids.medoid[k]) return false;
      return a == medoids.medoid[k] || distance(a) < distance(b);
    });
    for (const auto i : members) {
      const Estimate& silhouette = clustering.silhouette[i];
      fmt::format_to(std::back_inserter(text), "{},{},{},{},{},{}\n", csv_field(materials[medoids.medoid[k]].name),
                     csv_field(materials[i].name), shortest(distance(i)),
                     shortest(metric.distance_error(static_cast<Eigen::Index>(i), medoid)), shortest(silhouette.value),
                     shortest(silhouette.error));
    }
  }
  return text;
}

std::string neighbours_csv(std::span<const MaterialLabel> materials, const Clustering& clustering) {
  std::string text = "material,rank,neighbour,distance,distance_error,rank_uncertain\n";
  for (std::size_t i = 0; i < materials.size(); ++i) {
    std::size_t rank = 0;
    for (const auto& neighbour : clustering.neighbours[i]) {
      fmt::format_to(std::back_inserter(text), "{},{},{},{},{},{}\n", csv_field(materials[i].name), ++rank,
                     csv_field(materials[neighbour.material].name), shortest(neighbour.distance.value),
                     shortest(neighbour.distance.error), neighbour.is_rank_uncertain ? "yes" : "no");
    }
  }
  return text;
}

}  // namespace lobe
