#include "study/write/study_hdf5.hpp"

#include <fmt/format.h>

#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include "hdf5/file_digest.hpp"
#include "hdf5/hdf5.hpp"
#include "hdf5/hdf5_output.hpp"
#include "lobe/core/error.hpp"
#include "lobe/core/version.hpp"
#include "lobe/metric/unit.hpp"
#include "metric/domain.hpp"
#include "study/write/chart_hdf5.hpp"
#include "study/write/clustering_hdf5.hpp"
#include "study/write/comparison_hdf5.hpp"
#include "study/write/curves_hdf5.hpp"
#include "study/write/origin_text.hpp"
#include "study/write/published_hdf5.hpp"
#include "study/write/residual_hdf5.hpp"
#include "study/write/unresolved_hdf5.hpp"

namespace lobe {
namespace {

/// One result: a dataset over the materials or over pairs of them.
struct Quantity {
  std::string name;
  std::string long_name;
  bool is_squared = false;  ///< a product; else the square root of one
  bool is_pairwise = false;
  std::string error;  ///< name of the dataset that holds this one's error estimates
  Eigen::MatrixXd (*values)(const Metric&);
};

const std::array<Quantity, 6>& quantities() {
  static const std::array<Quantity, 6> list = {{
      {"gram", "scalar products", true, true, "gram_error", [](const Metric& m) { return m.gram; }},
      {"gram_error", "error estimates of the scalar products", true, true, "",
       [](const Metric& m) { return m.gram_error; }},
      {"norm", "norms", false, false, "norm_error", [](const Metric& m) { return Eigen::MatrixXd(m.norm); }},
      {"norm_error", "error estimates of the norms", false, false, "",
       [](const Metric& m) { return Eigen::MatrixXd(m.norm_error); }},
      {"distance", "distances", false, true, "distance_error", [](const Metric& m) { return m.distance; }},
      {"distance_error", "error estimates of the distances", false, true, "",
       [](const Metric& m) { return m.distance_error; }},
  }};
  return list;
}

/// Axes that the groups share; they stand in the root group.
struct Axes {
  hdf5::Dataset material;
  hdf5::Dataset material_other;
  hdf5::Dataset channel;
  hdf5::Dataset axis;
  hdf5::Dataset component;
  std::optional<hdf5::Dataset> basis_family;  ///< where there are approximations
};

void append_row_major(std::vector<double>& values, const Eigen::MatrixXd& matrix) {
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) values.push_back(matrix(i, j));
  }
}

void write_metrics(hid_t group, const Lighting& lighting, std::span<const Metric> metrics, const Axes& axes,
                   bool by_channel) {
  const std::string suffix = by_channel ? "_by_channel" : "";
  for (const auto& quantity : quantities()) {
    std::vector<double> values;
    for (const auto& metric : metrics) append_row_major(values, quantity.values(metric));
    std::vector<const hdf5::Dataset*> along;
    if (by_channel) along.push_back(&axes.channel);
    along.push_back(&axes.material);
    if (quantity.is_pairwise) along.push_back(&axes.material_other);
    const auto dataset = hdf5::create_dataset(group, quantity.name + suffix, values, along);
    hdf5::write_attribute(dataset.id(), "long_name",
                          fmt::format("{} under {} lighting{}", quantity.long_name, lighting.name(),
                                      by_channel ? ", each channel by itself" : ""));
    hdf5::write_attribute(dataset.id(), "units",
                          std::string(quantity.is_squared ? product_unit(lighting, UnitStyle::udunits)
                                                          : norm_unit(lighting, UnitStyle::udunits)));
    if (!quantity.error.empty()) {
      hdf5::write_attribute(dataset.id(), "ancillary_variables", quantity.error + suffix);
    }
  }
}

void write_embedding(hid_t group, const Lighting& lighting, const Embedding& embedding, const Axes& axes) {
  std::vector<double> values;
  append_row_major(values, embedding.coordinates);
  const hdf5::Dataset* const along[] = {&axes.material, &axes.axis};
  const auto coordinates = hdf5::create_dataset(group, "embedding", values, along);
  hdf5::write_attributes(coordinates.id(), {{"long_name", "coordinates by classical scaling of the distances"},
                                            {"units", std::string(norm_unit(lighting, UnitStyle::udunits))}});
  hdf5::write_attribute(coordinates.id(), "explained_share", embedding.explained_share);
  hdf5::write_attribute(coordinates.id(), "comment",
                        "explained_share: kept eigenvalues over the sum of the positive ones");
  const hdf5::Dataset* const component[] = {&axes.component};
  const std::span<const double> all(embedding.eigenvalues.data(),
                                    static_cast<std::size_t>(embedding.eigenvalues.size()));
  const auto eigenvalues = hdf5::create_dataset(group, "eigenvalue", all, component);
  hdf5::write_attributes(eigenvalues.id(),
                         {{"long_name", "eigenvalues of the doubly centred squared distances, falling"},
                          {"units", std::string(product_unit(lighting, UnitStyle::udunits))}});
}

/// The largest angle of products, where it is not the horizon.
void write_domain(hid_t group, double theta_max) {
  if (theta_max == MetricOptions{}.theta_max) return;
  hdf5::write_attribute(group, "domain_theta_max_deg", degrees_of_domain(theta_max));
}

/// How products were computed, where it is not by formulas.
void write_route(hid_t group, Route route, const std::optional<HemisphereGrid>& grid) {
  if (route == Route::formulas) return;
  hdf5::write_attribute(group, "route", std::string(to_string(route)));
  if (grid) hdf5::write_attribute(group, "route_grid", grid->name());
}

void write_lighting(hid_t root, const StudyResult& result, std::size_t index, const Axes& axes) {
  const MetricResult& metric = result.metrics[index];
  const auto group = hdf5::create_group(root, metric.lighting.stem());
  hdf5::write_attributes(group.id(), {{"comment", metric.lighting.definition()}, {"lighting", metric.lighting.name()}});
  if (const auto origin = origin_text(result.study.origins.lightings, index); !origin.empty()) {
    hdf5::write_attribute(group.id(), "origin", origin);
  }
  hdf5::write_attribute(group.id(), "nodes", static_cast<std::int64_t>(metric.work.nodes));
  hdf5::write_attribute(group.id(), "evaluations", static_cast<std::int64_t>(metric.work.evaluations));
  write_domain(group.id(), metric.theta_max);
  write_route(group.id(), metric.route, metric.grid);
  write_metrics(group.id(), metric.lighting, {&metric.combined, 1}, axes, false);
  if (metric.channels.size() > 1) write_metrics(group.id(), metric.lighting, metric.channels, axes, true);
  write_embedding(group.id(), metric.lighting, result.embeddings[index], axes);
  write_clustering(group.id(), result.study, result.clusterings[index], axes.material,
                   std::string(norm_unit(metric.lighting, UnitStyle::udunits)));
  for (std::size_t k = 0; k < result.study.approximations.size(); ++k) {
    const FamilyResiduals& residuals = result.residuals.at(index * result.study.approximations.size() + k);
    write_residuals(group.id(), result.study.approximations[k], residuals, axes.material, axes.basis_family.value());
  }
  write_unresolved(group.id(), metric.unresolved, labels(result.study), "product");
}

/// The study's files as they are, and what was set besides.
void write_texts(hid_t group, const Study& study) {
  if (!study.texts.empty()) {
    std::vector<std::string> names;
    std::vector<std::string> texts;
    for (const auto& text : study.texts) {
      names.push_back(text.name);
      texts.push_back(text.text);
    }
    const auto axis = hdf5::create_text_axis(group, "study_file", names);
    hdf5::write_attribute(axis.id(), "long_name", "file of the study, the one that was run first");
    const auto text = hdf5::create_text_dataset(group, "study_text", texts, axis);
    hdf5::write_attribute(text.id(), "long_name", "its text");
  }
  if (!study.overrides.empty()) {
    const auto axis = hdf5::create_text_axis(group, "override", study.overrides);
    hdf5::write_attribute(axis.id(), "long_name", "value set from outside the files, by --set");
  }
}

void write_provenance(hid_t root, const StudyResult& result, const std::string& command_line) {
  const auto group = hdf5::create_group(root, "provenance");
  const DeviceInfo& device = result.device;
  hdf5::write_attributes(group.id(),
                         {{"software", "lobe"},
                          {"software_version", version()},
                          {"git_commit", commit()},
                          {"hdf5_version", hdf5_version()},
                          {"command_line", command_line},
                          {"effective_config", result.study.configuration},
                          {"opencl_platform", device.platform},
                          {"opencl_platform_version", device.platform_version},
                          {"opencl_device", device.name},
                          {"opencl_device_version", device.version},
                          {"opencl_driver", device.driver},
                          {"opencl_self_test", "passed by every kernel before its first use"},
                          {"grid", result.study.grid ? result.study.grid->name() : ""},
                          {"precision", result.study.precision == Precision::double_precision ? "double" : "single"}});
  hdf5::write_attribute(group.id(), "tolerance", result.study.tolerance);
  hdf5::write_attribute(group.id(), "patch_tolerance", result.study.patch_tolerance);
  hdf5::write_attribute(group.id(), "comparison_tolerance", result.study.comparison_tolerance);
  if (count_files(result.study) > 0) {
    hdf5::write_attribute(group.id(), "function_tolerance", result.study.function_tolerance);
  }
  write_domain(group.id(), result.study.domain_theta_max);
  write_texts(group.id(), result.study);
}

Axes write_axes(hid_t root, const StudyResult& result) {
  const Study& study = result.study;
  std::vector<std::string> names;
  for (const auto& material : study.materials) names.push_back(material.name());
  const auto axis_count = result.embeddings.empty() ? 0 : result.embeddings.front().coordinates.cols();
  Axes axes{hdf5::create_text_axis(root, "material", names),
            hdf5::create_text_axis(root, "material_other", names),
            hdf5::create_text_axis(root, "channel", study.channels),
            hdf5::create_index_axis(root, "axis", static_cast<std::size_t>(axis_count)),
            hdf5::create_index_axis(root, "component", names.size()),
            {}};
  hdf5::write_attribute(axes.material.id(), "long_name", "name of the material");
  hdf5::write_attribute(axes.material_other.id(), "long_name", "name of the other material of a pair");
  hdf5::write_attribute(axes.channel.id(), "long_name", "name of the channel");
  hdf5::write_attribute(axes.axis.id(), "long_name", "axis of the embedding, by falling eigenvalue");
  hdf5::write_attribute(axes.component.id(), "long_name", "number of the eigenvalue");
  if (!result.residuals.empty()) {
    axes.basis_family = hdf5::create_text_axis(root, "basis_family", result.residuals.front().families);
    hdf5::write_attribute(axes.basis_family->id(), "long_name", "family that approximates");
  }
  return axes;
}

/// JSON of a material: its formula, or what its file says.
std::string material_text(const StudyResult& result, std::size_t i) {
  const StudyMaterial& material = result.study.materials[i];
  if (i < result.files.size() && !result.files[i].empty()) return result.files[i];
  if (material.formula() != nullptr) return to_json(*material.formula());
  throw ArgumentError("material '" + material.name() +
                      "' has no formula; expected what its file says in StudyResult::files");
}

void write_materials(hid_t root, const StudyResult& result, const Axes& axes) {
  const Study& study = result.study;
  std::vector<std::string> families;
  std::vector<std::string> json;
  for (std::size_t i = 0; i < study.materials.size(); ++i) {
    families.push_back(study.materials[i].family());
    json.push_back(material_text(result, i));
  }
  const auto family = hdf5::create_text_dataset(root, "family", families, axes.material);
  hdf5::write_attribute(family.id(), "long_name", "family of the material");
  const auto text = hdf5::create_text_dataset(root, "material_json", json, axes.material);
  hdf5::write_attribute(text.id(), "long_name",
                        "terms of the material with models, parameters and weights, or its file, as JSON");
  if (!study.origins.materials.empty()) {
    const auto origins = origin_texts(study.origins.materials, study.materials.size());
    const auto origin = hdf5::create_text_dataset(root, "origin", origins, axes.material);
    hdf5::write_attribute(origin.id(), "long_name", kOriginMeaning);
  }
  const hdf5::Dataset* const along[] = {&axes.channel};
  const auto weight = hdf5::create_dataset(root, "channel_weight", study.channel_weights, along);
  hdf5::write_attributes(weight.id(), {{"long_name", "weight of the channel in the products"}, {"units", "1"}});
}

void write_results(hid_t root, const StudyResult& result) {
  const Axes axes = write_axes(root, result);
  write_materials(root, result, axes);
  for (std::size_t i = 0; i < result.metrics.size(); ++i) write_lighting(root, result, i, axes);
  write_comparisons(root, result, {axes.material, axes.material_other, axes.channel});
  write_agreement(root, result.agreement);
  write_curves(root, result, axes.material, axes.channel);
}

std::string joined(std::span<const std::string> lines) {
  std::string text;
  for (const auto& line : lines) text += (text.empty() ? "" : "\n") + line;
  return text;
}

}  // namespace

std::string study_table(const StudyResult& result, const std::string& command_line, const std::string& created) {
  const Study& study = result.study;
  std::string image = hdf5::file_image([&](hid_t root) {
    hdf5::write_attributes(root, {{"Conventions", "CF-1.10, ACDD-1.3"},
                                  {"title", study.title},
                                  {"history", created + ": " + command_line},
                                  {"source", fmt::format("lobe {} ({})", version(), commit())},
                                  {"references", joined(study.references)},
                                  {"comment", study.comment},
                                  {"date_created", created},
                                  {"lobe_schema", kStudySchema}});
    // A study may have nothing but published figures and charts.
    if (!study.materials.empty()) write_results(root, result);
    write_published(root, result);
    write_charts(root, result);
    write_provenance(root, result, command_line);
  });
  return image + digest_of(image);
}

}  // namespace lobe
