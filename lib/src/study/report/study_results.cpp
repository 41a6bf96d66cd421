#include "lobe/study/study_results.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "core/text.hpp"
#include "hdf5/file_digest.hpp"
#include "hdf5/hdf5_input.hpp"
#include "lobe/core/error.hpp"
#include "study/write/study_hdf5.hpp"

namespace lobe {
namespace {

constexpr const char* kSchemaStem = "lobe-study/";

using Shape = std::vector<hsize_t>;

/// Reads a group whose datasets run along materials, channels and what they have of their own.
class StudyReader {
 public:
  explicit StudyReader(const std::filesystem::path& path) : file_(path) {
    check_schema();
    results_.name = path.stem().string();
    results_.title = file_.line("/", "title");
    results_.comment = file_.text("/", "comment");
    results_.references = file_.text("/", "references");
    read_provenance();
  }

  StudySummary summary() {
    StudySummary found{results_.name, results_.title, results_.comment, results_.references, {}, {}, {}, {}, {}, {}};
    if (file_.has("/material")) {
      read_materials();
      found.materials = results_.materials;
      found.channels = results_.channels;
    }
    for (const auto& name : file_.groups("/")) {
      const std::string group = "/" + name;
      if (file_.has(group + "/gram")) found.metrics.emplace_back(lighting_name(group, name), origin(group));
    }
    for (const auto& name : groups("/comparison")) found.metrics.emplace_back(name, origin("/comparison/" + name));
    if (file_.has("/published/figure")) {
      const auto figures = file_.texts("/published/figure");
      const auto tables = texts("/published/table", figures.size());
      const auto origins = texts("/published/origin", figures.size());
      for (std::size_t i = 0; i < figures.size(); ++i) {
        found.published.emplace_back(tables[i] + ", " + figures[i], origins[i]);
      }
    }
    for (const auto& name : groups("/charts")) found.charts.emplace_back(name, origin("/charts/" + name));
    found.provenance = std::move(results_.provenance);
    return found;
  }

  StudyResults read() {
    if (!file_.has("/material")) file_.refuse("the study has no materials; expected one with distances");
    read_materials();
    for (const auto& name : file_.groups("/")) {
      if (file_.has("/" + name + "/gram")) read_lighting("/" + name, name);
    }
    for (const auto& name : groups("/comparison")) read_comparison("/comparison/" + name, name);
    read_agreement();
    read_curves();
    if (file_.has("/published/value")) {
      const Shape shape = file_.shape("/published/value");
      if (shape.size() != 1) file_.refuse("dataset /published/value is no list");
      results_.published_figures = shape.front();
    }
    results_.charts = groups("/charts").size();
    return std::move(results_);
  }

 private:
  void check_schema() const {
    if (!file_.has_attribute("/", "lobe_schema")) file_.refuse("it is no study of lobe; expected what 'lobe run' left");
    const std::string schema = file_.text("/", "lobe_schema");
    if (schema == kStudySchema) return;
    if (!schema.starts_with(kSchemaStem)) {
      file_.refuse("its schema is '" + schema + "'; expected " + kStudySchema + ", which 'lobe run' writes");
    }
    file_.refuse("its schema is '" + schema + "', of another version of lobe; expected " + kStudySchema);
  }

  [[nodiscard]] std::size_t count() const { return results_.materials.size(); }
  [[nodiscard]] Shape by_material() const { return {count()}; }

  [[nodiscard]] std::vector<std::string> groups(const std::string& parent) const {
    return file_.has(parent) ? file_.groups(parent) : std::vector<std::string>();
  }

  /// As many texts; empty ones where the dataset is missing.
  [[nodiscard]] std::vector<std::string> texts(const std::string& dataset, std::size_t count) const {
    if (!file_.has(dataset)) return std::vector<std::string>(count);
    auto found = file_.texts(dataset);
    if (found.size() != count) {
      file_.refuse("dataset " + dataset + " has " + std::to_string(found.size()) + " texts; expected " +
                   std::to_string(count));
    }
    return found;
  }

  [[nodiscard]] std::vector<std::string> names_of(const std::string& dataset) const {
    auto names = file_.texts(dataset);
    if (std::ranges::any_of(names, has_control_characters)) {
      file_.refuse("dataset " + dataset + " has a name of several lines or with tabs; expected one line each");
    }
    return names;
  }

  /// Where the study asks for what a group holds; older files do not say.
  [[nodiscard]] std::string origin(const std::string& group) const {
    return file_.has_attribute(group, "origin") ? file_.text(group, "origin") : std::string();
  }

  /// Older files name a lighting by its group alone.
  [[nodiscard]] std::string lighting_name(const std::string& group, const std::string& stem) const {
    return file_.has_attribute(group, "lighting") ? file_.text(group, "lighting") : stem;
  }

  void read_materials() {
    results_.channels = names_of("/channel");
    results_.channel_weights = file_.read("/channel_weight", Shape{results_.channels.size()});
    const auto names = names_of("/material");
    const auto families = names_of("/family");
    const auto json = file_.texts("/material_json");
    if (names.empty() || families.size() != names.size() || json.size() != names.size()) {
      file_.refuse("/material, /family and /material_json differ in length");
    }
    const auto origins = texts("/origin", names.size());
    for (std::size_t i = 0; i < names.size(); ++i) {
      results_.materials.push_back({names[i], families[i], json[i], origins[i]});
    }
  }

  [[nodiscard]] Eigen::VectorXd vector(const std::string& dataset) const {
    file_.require_shape(dataset, by_material());
    Eigen::VectorXd values(static_cast<Eigen::Index>(count()));
    file_.read(dataset, by_material(), {values.data(), count()});
    return values;
  }

  [[nodiscard]] Eigen::MatrixXd matrix(const std::string& dataset, std::size_t rows, std::size_t columns) const {
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    file_.require_shape(dataset, Shape{rows, columns});
    RowMajor values(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(columns));
    file_.read(dataset, Shape{rows, columns}, {values.data(), rows * columns});
    return values;
  }

  /// Sizes and distances: finite, and not below 0.
  void require_numbers(const Eigen::MatrixXd& values, const std::string& dataset) const {
    for (Eigen::Index k = 0; k < values.size(); ++k) {
      const double value = values.data()[k];
      if (std::isfinite(value) && value >= 0) continue;
      file_.refuse("dataset " + dataset + " has " + shortest(value) + "; expected finite numbers of at least 0");
    }
  }

  /// Whole numbers below a limit.
  [[nodiscard]] std::vector<std::size_t> numbers(const std::string& dataset, const Shape& shape,
                                                 std::size_t limit) const {
    std::vector<std::size_t> numbers;
    for (const double value : file_.read(dataset, shape)) {
      if (!(value >= 0 && value < static_cast<double>(limit) && value == std::floor(value))) {
        file_.refuse("dataset " + dataset + " has a number out of range; expected whole numbers below " +
                     std::to_string(limit));
      }
      numbers.push_back(static_cast<std::size_t>(value));
    }
    return numbers;
  }

  [[nodiscard]] std::vector<Estimate> estimates(const std::string& dataset, const Shape& shape) const {
    const auto values = file_.read(dataset, shape);
    const auto errors = file_.read(dataset + "_error", shape);
    std::vector<Estimate> estimates;
    for (std::size_t i = 0; i < values.size(); ++i) estimates.push_back({values[i], errors[i]});
    return estimates;
  }

  [[nodiscard]] Estimate estimate(const std::string& object, const std::string& attribute) const {
    return {file_.number(object, attribute.c_str()), file_.number(object, (attribute + "_error").c_str())};
  }

  /// Reads the data that lightings and comparison metrics share.
  /// \param norm name of the dataset of distances from black
  [[nodiscard]] StudyDistances distances(const std::string& group, const std::string& norm) const {
    StudyDistances found;
    found.origin = origin(group);
    found.unit = file_.text(group + "/distance", "units");
    found.norm = vector(group + "/" + norm);
    found.norm_error = vector(group + "/" + norm + "_error");
    found.distance = matrix(group + "/distance", count(), count());
    found.distance_error = matrix(group + "/distance_error", count(), count());
    require_numbers(found.norm, group + "/" + norm);
    require_numbers(found.distance, group + "/distance");
    found.unresolved_pairs = static_cast<std::size_t>(std::max(0.0, file_.number(group, "unresolved_pairs")));
    return found;
  }

  void read_lighting(const std::string& group, const std::string& stem) {
    StudyDistances found = distances(group, "norm");
    found.name = lighting_name(group, stem);
    found.definition = file_.text(group, "comment");
    found.embedding = embedding(group);
    found.clustering = clustering(group);
    for (const bool non_negative : {false, true}) {
      const std::string kind = group + (non_negative ? "/non_negative" : "/linear");
      if (file_.has(kind + "_residual")) found.residuals.push_back(residuals(kind, non_negative));
    }
    results_.distances.push_back(std::move(found));
  }

  void read_comparison(const std::string& group, const std::string& name) {
    StudyDistances found = distances(group, "size");
    found.name = name;
    found.is_lighting = false;
    results_.distances.push_back(std::move(found));
  }

  [[nodiscard]] Embedding embedding(const std::string& group) const {
    const Shape shape = file_.shape(group + "/embedding");
    Embedding found;
    found.coordinates =
        matrix(group + "/embedding", count(), shape.size() == 2 ? std::min<hsize_t>(shape[1], count()) : 0);
    found.eigenvalues = vector(group + "/eigenvalue");
    found.explained_share = file_.number(group + "/embedding", "explained_share");
    return found;
  }

  [[nodiscard]] Clustering clustering(const std::string& group) const {
    Clustering found;
    found.tree = tree(group);
    found.leaf_order = numbers(group + "/leaf_order", by_material(), count());
    std::vector<bool> is_seen(count(), false);
    for (const auto leaf : found.leaf_order) is_seen[leaf] = true;
    if (!std::ranges::all_of(is_seen, std::identity{})) {
      file_.refuse("dataset " + group + "/leaf_order is no order of the materials");
    }
    found.tree_cluster = numbers(group + "/tree_cluster", by_material(), count());
    if (count() > 1) found.cophenetic_correlation = estimate(group + "/linkage", "cophenetic_correlation");
    read_medoids(group, found);
    found.neighbours.resize(count());
    if (file_.has(group + "/neighbour")) read_neighbours(group, found);
    return found;
  }

  [[nodiscard]] Dendrogram tree(const std::string& group) const {
    Dendrogram found;
    if (count() < 2) return found;
    const std::size_t merges = count() - 1;
    const Eigen::MatrixXd linkage = matrix(group + "/linkage", merges, 4);
    const auto errors = file_.read(group + "/linkage_height_error", Shape{merges});
    std::vector<bool> is_taken(count() + merges, false);
    for (std::size_t i = 0; i < merges; ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      Merge merge;
      for (const Eigen::Index column : {0, 1}) {
        const double number = linkage(row, column);
        // Clusters are there before they are merged, and merged once.
        const bool is_cluster = number >= 0 && number < static_cast<double>(count() + i);
        if (!is_cluster || is_taken[static_cast<std::size_t>(number)]) {
          file_.refuse("dataset " + group + "/linkage is no tree of the materials");
        }
        is_taken[static_cast<std::size_t>(number)] = true;
        (column == 0 ? merge.first : merge.second) = static_cast<std::size_t>(number);
      }
      merge.height = {linkage(row, 2), errors[i]};
      merge.size = static_cast<std::size_t>(std::max(0.0, linkage(row, 3)));
      found.merges.push_back(merge);
    }
    return found;
  }

  void read_medoids(const std::string& group, Clustering& found) const {
    for (const auto& name : file_.texts(group + "/medoid")) {
      const auto at = std::ranges::find(results_.materials, name, &StudyMaterial::name);
      if (at == results_.materials.end()) file_.refuse(group + "/medoid has '" + name + "', which is no material");
      found.medoids.medoid.push_back(static_cast<std::size_t>(at - results_.materials.begin()));
    }
    found.medoids.cluster = numbers(group + "/cluster", by_material(), found.medoids.medoid.size());
    found.silhouette = estimates(group + "/silhouette", by_material());
    found.mean_silhouette = estimate(group + "/medoid", "mean_silhouette");
    if (!file_.has(group + "/cluster_count")) return;
    const Shape shape = file_.shape(group + "/cluster_count");
    const auto counts = numbers(group + "/cluster_count", shape, count() + 1);
    const auto silhouettes = estimates(group + "/silhouette_by_count", shape);
    for (std::size_t i = 0; i < counts.size(); ++i) found.candidates.push_back({counts[i], silhouettes[i]});
  }

  void read_neighbours(const std::string& group, Clustering& found) const {
    const Shape shape = file_.shape(group + "/neighbour");
    if (shape.size() != 2 || shape[0] != count()) file_.refuse("dataset " + group + "/neighbour is not by material");
    const auto neighbours = numbers(group + "/neighbour", shape, count());
    const auto distances = estimates(group + "/neighbour_distance", shape);
    const auto is_uncertain = numbers(group + "/neighbour_rank_uncertain", shape, 2);
    for (std::size_t i = 0; i < neighbours.size(); ++i) {
      found.neighbours[i / shape[1]].push_back({neighbours[i], distances[i], is_uncertain[i] != 0});
    }
  }

  [[nodiscard]] FamilyResiduals residuals(const std::string& kind, bool non_negative) const {
    FamilyResiduals found;
    found.non_negative = non_negative;
    for (const auto& material : results_.materials) found.targets.push_back(material.name);
    found.families = file_.texts("/basis_family");
    const std::size_t families = found.families.size();
    found.relative_residual = matrix(kind + "_residual", count(), families);
    found.relative_residual_error = matrix(kind + "_residual_error", count(), families);
    found.rank = matrix(kind + "_rank", count(), families).cast<int>();
    return found;
  }

  void read_agreement() {
    if (!file_.has("/agreement")) return;
    MetricAgreement& agreement = results_.agreement;
    agreement.metrics = file_.texts("/agreement/metric");
    const std::size_t metrics = agreement.metrics.size();
    const auto read = [&](const std::string& suffix) {
      return RankAgreement{matrix("/agreement/spearman" + suffix, metrics, metrics),
                           matrix("/agreement/kendall" + suffix, metrics, metrics)};
    };
    agreement.all_pairs = read("");
    if (file_.has("/agreement/spearman_within_families")) agreement.within_families = read("_within_families");
  }

  void read_curves() {
    if (!file_.has("/curves")) return;
    CurveAngles& angles = results_.curve_angles;
    for (const auto& [name, values] :
         {std::pair("/curves/theta", &angles.theta), std::pair("/curves/theta_in", &angles.theta_in),
          std::pair("/curves/theta_out", &angles.theta_out)}) {
      const Shape shape = file_.shape(name);
      if (shape.size() != 1) file_.refuse("dataset " + std::string(name) + " is no list of angles");
      *values = file_.read(name, shape);
    }
    const std::size_t channels = results_.channels.size();
    const auto albedos = estimates("/curves/albedo", Shape{count(), channels, angles.theta.size()});
    const auto reflectances =
        estimates("/curves/reflectance", Shape{count(), channels, angles.theta_in.size(), angles.theta_out.size()});
    const auto deltas = numbers("/curves/has_delta", by_material(), 2);
    auto albedo = albedos.begin();
    auto reflectance = reflectances.begin();
    const auto take = [](auto& from, std::size_t length) {
      const auto first = from;
      from += static_cast<std::ptrdiff_t>(length);
      return std::vector<Estimate>(first, from);
    };
    for (std::size_t i = 0; i < count(); ++i) {
      MaterialCurves& curves = results_.curves.emplace_back();
      for (std::size_t c = 0; c < channels; ++c) {
        curves.albedo.push_back(take(albedo, angles.theta.size()));
        auto& slices = curves.reflectance.emplace_back();
        for (std::size_t k = 0; k < angles.theta_in.size(); ++k) {
          slices.push_back(take(reflectance, angles.theta_out.size()));
        }
      }
      curves.has_delta = deltas[i] != 0;
    }
  }

  void read_provenance() {
    constexpr const char* kGroup = "/provenance";
    const auto text = [&](const char* name) { return file_.text(kGroup, name); };
    StudyProvenance& provenance = results_.provenance;
    provenance.software_version = text("software_version");
    provenance.commit = text("git_commit");
    provenance.hdf5_version = text("hdf5_version");
    provenance.command_line = text("command_line");
    provenance.created = file_.text("/", "date_created");
    provenance.configuration = text("effective_config");
    provenance.platform = text("opencl_platform");
    provenance.platform_version = text("opencl_platform_version");
    provenance.device = text("opencl_device");
    provenance.device_version = text("opencl_device_version");
    provenance.driver = text("opencl_driver");
    provenance.precision = text("precision");
    provenance.tolerance = file_.number(kGroup, "tolerance");
    provenance.patch_tolerance = file_.number(kGroup, "patch_tolerance");
    provenance.comparison_tolerance = file_.number(kGroup, "comparison_tolerance");
    if (file_.has_attribute(kGroup, "domain_theta_max_deg")) {
      provenance.domain_theta_max_deg = file_.number(kGroup, "domain_theta_max_deg");
    }
    if (file_.has_attribute(kGroup, "grid")) provenance.grid = text("grid");
    if (file_.has("/provenance/study_file")) {
      const auto names = file_.texts("/provenance/study_file");
      const auto contents = texts("/provenance/study_text", names.size());
      for (std::size_t i = 0; i < names.size(); ++i) provenance.texts.push_back({names[i], contents[i]});
    }
    if (file_.has("/provenance/override")) provenance.overrides = file_.texts("/provenance/override");
  }

  hdf5::InputFile file_;
  StudyResults results_;
};

}  // namespace

bool is_study_results(const std::filesystem::path& path) {
  require_sound(path);
  try {
    const hdf5::InputFile file(path);
    return file.has_attribute("/", "lobe_schema") && file.text("/", "lobe_schema").starts_with(kSchemaStem);
  } catch (const IoError&) {
    return false;
  }
}

StudySummary load_study_summary(const std::filesystem::path& path) {
  return StudyReader(path).summary();
}

StudyResults load_study_results(const std::filesystem::path& path) {
  return StudyReader(path).read();
}

}  // namespace lobe
