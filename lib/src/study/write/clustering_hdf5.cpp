#include "study/write/clustering_hdf5.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace lobe {
namespace {

using Integers = std::vector<std::int32_t>;

Integers integers(const std::vector<std::size_t>& values) {
  Integers result;
  for (const auto value : values) result.push_back(static_cast<std::int32_t>(value));
  return result;
}

void write_integers(hid_t group, const std::string& name, const Integers& values,
                    std::span<const hdf5::Dataset* const> axes, std::string_view meaning) {
  const auto dataset = hdf5::create_integer_dataset(group, name, values, axes);
  hdf5::write_attribute(dataset.id(), "long_name", meaning);
}

/// A quantity NAME and, beside it, its error estimates NAME_error.
void write_estimates(hid_t group, const std::string& name, const std::vector<Estimate>& estimates,
                     std::span<const hdf5::Dataset* const> axes, std::string_view meaning, std::string_view unit) {
  std::vector<double> values;
  std::vector<double> errors;
  for (const auto& estimate : estimates) {
    values.push_back(estimate.value);
    errors.push_back(estimate.error);
  }
  const auto dataset = hdf5::create_dataset(group, name, values, axes);
  hdf5::write_attributes(dataset.id(),
                         {{"long_name", meaning}, {"units", unit}, {"ancillary_variables", name + "_error"}});
  const auto error = hdf5::create_dataset(group, name + "_error", errors, axes);
  hdf5::write_attributes(error.id(),
                         {{"long_name", "error estimates of the " + std::string(meaning)}, {"units", unit}});
}

void write_tree(hid_t group, const Clustering& clustering, const hdf5::Dataset& material, const std::string& unit) {
  const Dendrogram& tree = clustering.tree;
  const hdf5::Dataset* const by_material[] = {&material};
  write_integers(group, "leaf_order", integers(clustering.leaf_order), by_material,
                 "materials in the optimal order of the tree's leaves, as places along material from 0");
  write_integers(group, "tree_cluster", integers(clustering.tree_cluster), by_material,
                 "number, from 0, of the cluster when the tree is cut into as many as there are medoids");
  if (tree.merges.empty()) return;
  const auto merge = hdf5::create_index_axis(group, "merge", tree.merges.size());
  hdf5::write_attribute(merge.id(), "long_name", "merge of two clusters, by rising height");
  const std::array<std::string, 4> names{"first", "second", "height", "size"};
  const auto column = hdf5::create_text_axis(group, "linkage_column", names);
  hdf5::write_attribute(column.id(), "long_name", "columns of linkage");
  std::vector<double> values;
  std::vector<double> errors;
  for (const auto& entry : tree.merges) {
    values.insert(values.end(), {static_cast<double>(entry.first), static_cast<double>(entry.second),
                                 entry.height.value, static_cast<double>(entry.size)});
    errors.push_back(entry.height.error);
  }
  const hdf5::Dataset* const along[] = {&merge, &column};
  const auto linkage = hdf5::create_dataset(group, "linkage", values, along);
  hdf5::write_attributes(linkage.id(), {{"long_name", "agglomerative clustering of the distances by average linkage"},
                                        {"comment",
                                         "first, second: clusters that become one, materials from 0, then merges; "
                                         "height in " +
                                             unit + "; as in scipy.cluster.hierarchy"},
                                        {"ancillary_variables", "linkage_height_error"}});
  hdf5::write_attribute(linkage.id(), "cophenetic_correlation", clustering.cophenetic_correlation.value);
  hdf5::write_attribute(linkage.id(), "cophenetic_correlation_error", clustering.cophenetic_correlation.error);
  const hdf5::Dataset* const by_merge[] = {&merge};
  const auto error = hdf5::create_dataset(group, "linkage_height_error", errors, by_merge);
  hdf5::write_attributes(error.id(), {{"long_name", "error estimates of the heights"}, {"units", unit}});
}

void write_medoids(hid_t group, const Study& study, const Clustering& clustering, const hdf5::Dataset& material) {
  std::vector<std::string> names;
  for (const auto index : clustering.medoids.medoid) names.push_back(study.materials[index].name());
  const auto medoid = hdf5::create_text_axis(group, "medoid", names);
  hdf5::write_attribute(medoid.id(), "long_name", "materials that stand for all, by k-medoids of the distances");
  const hdf5::Dataset* const by_material[] = {&material};
  write_integers(group, "cluster", integers(clustering.medoids.cluster), by_material,
                 "nearest medoid, as place along medoid from 0");
  write_estimates(group, "silhouette", clustering.silhouette, by_material,
                  "silhouette of the material in its medoid's cluster", "1");
  hdf5::write_attribute(medoid.id(), "mean_silhouette", clustering.mean_silhouette.value);
  hdf5::write_attribute(medoid.id(), "mean_silhouette_error", clustering.mean_silhouette.error);
  hdf5::write_attribute(medoid.id(), "chosen_by", clustering.candidates.empty() ? "study" : "silhouette");
  if (clustering.candidates.empty()) return;
  std::vector<double> counts;
  std::vector<Estimate> silhouettes;
  for (const auto& candidate : clustering.candidates) {
    counts.push_back(static_cast<double>(candidate.clusters));
    silhouettes.push_back(candidate.silhouette);
  }
  const auto count = hdf5::create_number_axis(group, "cluster_count", counts);
  hdf5::write_attributes(count.id(), {{"long_name", "numbers of clusters that were tried"}, {"units", "1"}});
  const hdf5::Dataset* const by_count[] = {&count};
  write_estimates(group, "silhouette_by_count", silhouettes, by_count, "mean silhouettes by number of clusters", "1");
}

void write_neighbours(hid_t group, const Clustering& clustering, const hdf5::Dataset& material,
                      const std::string& unit) {
  const std::size_t count = clustering.neighbours.front().size();
  if (count == 0) return;
  const auto rank = hdf5::create_index_axis(group, "rank", count);
  hdf5::write_attribute(rank.id(), "long_name", "neighbours of a material by rising distance");
  Integers neighbour;
  std::vector<Estimate> distances;
  Integers is_uncertain;
  for (const auto& list : clustering.neighbours) {
    for (const auto& entry : list) {
      neighbour.push_back(static_cast<std::int32_t>(entry.material));
      distances.push_back(entry.distance);
      is_uncertain.push_back(entry.is_rank_uncertain ? 1 : 0);
    }
  }
  const hdf5::Dataset* const along[] = {&material, &rank};
  write_integers(group, "neighbour", neighbour, along, "nearest other materials, as places along material from 0");
  write_estimates(group, "neighbour_distance", distances, along, "distances of the neighbours", unit);
  write_integers(group, "neighbour_rank_uncertain", is_uncertain, along,
                 "1 where another material is as near within the errors of both, else 0");
}

}  // namespace

void write_clustering(hid_t group, const Study& study, const Clustering& clustering, const hdf5::Dataset& material,
                      const std::string& unit) {
  write_tree(group, clustering, material, unit);
  write_medoids(group, study, clustering, material);
  write_neighbours(group, clustering, material, unit);
}

}  // namespace lobe
