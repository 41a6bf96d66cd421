#include "lobe/study/study_results.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <span>
#include <type_traits>
#include <utility>

#include "core/text.hpp"
#include "hdf5/file_digest.hpp"
#include "hdf5/hdf5_input.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"
#include "study/read/origin.hpp"
#include "study/write/study_hdf5.hpp"

namespace lobe {
namespace {

constexpr const char* kSchemaStem = "lobe-study/";

using Shape = std::vector<hsize_t>;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// The material of a text; without terms for formulas with models that this version does not know.
Material material_of(const std::string& json) {
  try {
    return material_from_json(json);
  } catch (const ArgumentError&) {
    return {};
  }
}

/// The name of a file in a material's JSON; empty for formulas.
std::string file_in(const std::string& json) {
  const auto details = nlohmann::json::parse(json, nullptr, false);
  const bool has_file = details.is_object() && details.contains("file") && details["file"].is_string();
  return has_file ? details["file"].get<std::string>() : std::string();
}

/// A material of results: name and family alone for formulas with models that this version does not know.
StudyMaterial study_material(const std::string& json, MaterialLabel label) {
  if (const std::string file = file_in(json); !file.empty()) return {std::move(label), MaterialFile{file, file, {}}};
  Material formula = material_of(json);
  if (formula.terms.empty()) return StudyMaterial(std::move(label));
  formula.name = label.name;
  formula.family = label.family;
  return formula;
}

/// Reads a group whose datasets run along materials, channels and what they have of their own.
class StudyReader {
 public:
  explicit StudyReader(const std::filesystem::path& path) : file_(path) {
    check_schema();
    study_.name = path.stem().string();
    study_.title = file_.line("/", "title");
    study_.comment = file_.text("/", "comment");
    const std::string references = file_.text("/", "references");
    if (!references.empty()) {
      for (const auto line : split(references, '\n')) study_.references.emplace_back(line);
    }
    read_provenance();
    if (file_.has("/material")) read_materials();
    for (const auto& name : file_.groups("/")) {
      if (!file_.has("/" + name + "/gram")) continue;
      lighting_groups_.push_back("/" + name);
      study_.lightings.push_back(lighting("/" + name, name));
    }
    for (const auto& name : groups("/comparison")) {
      literature_groups_.push_back("/comparison/" + name);
      study_.comparison_metrics.push_back(known(literature_groups_.back(), parse_literature_metric, name));
    }
    for (const auto& name : groups("/charts")) {
      chart_groups_.push_back("/charts/" + name);
      study_.charts.push_back(chart(chart_groups_.back(), name));
    }
    if (file_.has("/published/figure")) read_figures();
    study_.origins.lightings = origins(lighting_groups_);
    study_.origins.comparison_metrics = origins(literature_groups_);
    study_.origins.charts = origins(chart_groups_);
    const auto is_unknown = [](const std::vector<Origin>& curves) { return curves.empty(); };
    if (std::ranges::any_of(study_.origins.curves, is_unknown)) study_.origins.curves.clear();
  }

  StudyResult summary() { return std::move(result_); }

  StudyResult read() {
    for (std::size_t i = 0; i < lighting_groups_.size(); ++i) read_lighting(lighting_groups_[i], study_.lightings[i]);
    for (std::size_t i = 0; i < literature_groups_.size(); ++i) {
      read_comparison(literature_groups_[i], study_.comparison_metrics[i]);
    }
    read_agreement();
    read_curves();
    if (file_.has("/published/figure")) read_checks();
    for (std::size_t i = 0; i < chart_groups_.size(); ++i) read_values(chart_groups_[i], study_.charts[i]);
    return std::move(result_);
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

  [[nodiscard]] std::size_t count() const { return study_.materials.size(); }
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

  /// Refuses names and texts of a group that this version does not know.
  template <typename Parse>
  [[nodiscard]] std::invoke_result_t<const Parse&, const std::string&> known(const std::string& group,
                                                                             const Parse& parse,
                                                                             const std::string& text) const {
    try {
      return parse(text);
    } catch (const ArgumentError& error) {
      file_.refuse(group + ": " + error.what());
    }
  }

  /// Origins of the parts in these groups; none where one of them is not stated, as in older files.
  [[nodiscard]] std::vector<Origin> origins(std::span<const std::string> parts) const {
    std::vector<Origin> found;
    for (const auto& group : parts) {
      if (!file_.has_attribute(group, "origin")) return {};
      found.push_back(read_origin(file_.text(group, "origin")));
    }
    return found;
  }

  /// Origins in a dataset along one axis, as above.
  [[nodiscard]] std::vector<Origin> origins(const std::string& dataset, std::size_t count) const {
    std::vector<Origin> found;
    for (const auto& text : texts(dataset, count)) {
      if (text.empty()) return {};
      found.push_back(read_origin(text));
    }
    return found;
  }

  /// Older files name a lighting by its group alone.
  [[nodiscard]] Lighting lighting(const std::string& group, const std::string& stem) const {
    const std::string name = file_.has_attribute(group, "lighting") ? file_.line(group, "lighting") : stem;
    try {
      return parse_lighting(name);
    } catch (const ArgumentError&) {
      return Lighting::recorded(name, file_.line(group, "comment"));
    }
  }

  void read_materials() {
    study_.channels = names_of("/channel");
    study_.channel_weights = file_.read("/channel_weight", Shape{study_.channels.size()});
    const auto names = names_of("/material");
    const auto families = names_of("/family");
    const auto json = file_.texts("/material_json");
    if (names.empty() || families.size() != names.size() || json.size() != names.size()) {
      file_.refuse("/material, /family and /material_json differ in length");
    }
    study_.origins.materials = origins("/origin", names.size());
    for (std::size_t i = 0; i < names.size(); ++i) {
      StudyMaterial material = study_material(json[i], {names[i], families[i]});
      if (material.formula() == nullptr) {
        result_.files.resize(names.size());
        result_.files[i] = json[i];
      }
      study_.materials.push_back(std::move(material));
    }
  }

  [[nodiscard]] Eigen::VectorXd vector(const std::string& dataset) const {
    file_.require_shape(dataset, by_material());
    Eigen::VectorXd values(static_cast<Eigen::Index>(count()));
    file_.read(dataset, by_material(), {values.data(), count()});
    return values;
  }

  [[nodiscard]] Eigen::MatrixXd matrix(const std::string& dataset, std::size_t rows, std::size_t columns) const {
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

  [[nodiscard]] std::uint64_t whole_number(const std::string& group, const char* attribute) const {
    const double number = file_.number(group, attribute);
    if (!(number >= 0 && number < 0x1p53)) {
      file_.refuse(group + ": " + attribute + " is " + shortest(number) + "; expected a whole number of at least 0");
    }
    return static_cast<std::uint64_t>(number);
  }

  [[nodiscard]] WorkDone work(const std::string& group) const {
    WorkDone found;
    found.nodes = whole_number(group, "nodes");
    found.evaluations = whole_number(group, "evaluations");
    return found;
  }

  /// Index of the material with a name.
  [[nodiscard]] std::size_t index_of(const std::string& name, const std::string& dataset) const {
    const auto at = std::ranges::find(study_.materials, name, &StudyMaterial::name);
    if (at == study_.materials.end()) file_.refuse(dataset + " has '" + name + "', which is no material");
    return static_cast<std::size_t>(at - study_.materials.begin());
  }

  [[nodiscard]] std::vector<Unresolved> unresolved(const std::string& group) const {
    if (!file_.has(group + "/unresolved_first")) return {};
    const auto first = file_.texts(group + "/unresolved_first");
    const auto second = texts(group + "/unresolved_second", first.size());
    const auto errors = file_.read(group + "/unresolved_error", Shape{first.size()});
    std::vector<Unresolved> found;
    for (std::size_t i = 0; i < first.size(); ++i) {
      found.push_back({index_of(first[i], group + "/unresolved_first"),
                       index_of(second[i], group + "/unresolved_second"), errors[i]});
    }
    return found;
  }

  /// A quantity of all channels: n x n, or n x 1.
  [[nodiscard]] std::vector<Eigen::MatrixXd> by_channel(const std::string& dataset, std::size_t columns) const {
    Shape shape{study_.channels.size(), count()};
    if (columns > 1) shape.push_back(columns);
    const auto values = file_.read(dataset, shape);
    std::vector<Eigen::MatrixXd> found;
    for (std::size_t c = 0; c < study_.channels.size(); ++c) {
      found.emplace_back(Eigen::Map<const RowMajor>(values.data() + c * count() * columns,
                                                    static_cast<Eigen::Index>(count()),
                                                    static_cast<Eigen::Index>(columns)));
    }
    return found;
  }

  /// Products of all channels together, or one after the other.
  [[nodiscard]] Metric metric(const std::string& group) const {
    const auto square = [&](const char* name) { return matrix(group + name, count(), count()); };
    Metric found;
    found.gram = square("/gram");
    found.gram_error = square("/gram_error");
    found.norm = vector(group + "/norm");
    found.norm_error = vector(group + "/norm_error");
    found.distance = square("/distance");
    found.distance_error = square("/distance_error");
    require_numbers(found.norm, group + "/norm");
    require_numbers(found.distance, group + "/distance");
    return found;
  }

  void read_lighting(const std::string& group, const Lighting& lighting) {
    MetricResult found{.lighting = lighting,
                       .combined = metric(group),
                       .channels = {},
                       .unresolved = unresolved(group),
                       .work = work(group),
                       .theta_max = study_.domain_theta_max};
    if (file_.has(group + "/gram_by_channel")) read_channels(group, found);
    if (file_.has_attribute(group, "route")) found.route = route(group);
    if (file_.has_attribute(group, "route_grid")) {
      found.grid = known(group, HemisphereGrid::parse, file_.line(group, "route_grid"));
    }
    result_.metrics.push_back(std::move(found));
    result_.embeddings.push_back(embedding(group));
    result_.clusterings.push_back(clustering(group));
    std::vector<FamilyFit> fits;
    for (const FamilyFit fit : {FamilyFit::linear, FamilyFit::non_negative}) {
      const bool non_negative = fit == FamilyFit::non_negative;
      const std::string kind = group + (non_negative ? "/non_negative" : "/linear");
      if (!file_.has(kind + "_residual")) continue;
      fits.push_back(fit);
      result_.residuals.push_back(residuals(kind, non_negative));
    }
    if (result_.metrics.size() == 1) study_.approximations = fits;
    if (fits != study_.approximations) {
      file_.refuse(group + " has approximations by other families than the lightings before; expected the same kinds");
    }
  }

  void read_channels(const std::string& group, MetricResult& found) const {
    const auto pairs = [&](const char* name) { return by_channel(group + name, count()); };
    const auto list = [&](const char* name) { return by_channel(group + name, 1); };
    const auto gram = pairs("/gram_by_channel");
    const auto gram_error = pairs("/gram_error_by_channel");
    const auto norm = list("/norm_by_channel");
    const auto norm_error = list("/norm_error_by_channel");
    const auto distance = pairs("/distance_by_channel");
    const auto distance_error = pairs("/distance_error_by_channel");
    for (std::size_t c = 0; c < gram.size(); ++c) {
      found.channels.push_back({gram[c], gram_error[c], norm[c], norm_error[c], distance[c], distance_error[c]});
    }
  }

  [[nodiscard]] Route route(const std::string& group) const {
    const std::string name = file_.line(group, "route");
    for (const Route route : {Route::formulas, Route::functions, Route::tables}) {
      if (to_string(route) == name) return route;
    }
    file_.refuse(group + ": route is '" + name + "'; expected formulas, functions or tables");
  }

  void read_comparison(const std::string& group, LiteratureMetric metric) {
    const auto square = [&](const char* name) { return matrix(group + name, count(), count()); };
    LiteratureResult found;
    found.metric = metric;
    found.combined = {square("/distance"), square("/distance_error"), vector(group + "/size"),
                      vector(group + "/size_error")};
    require_numbers(found.combined.size, group + "/size");
    require_numbers(found.combined.distance, group + "/distance");
    if (file_.has(group + "/distance_by_channel")) {
      const auto distance = by_channel(group + "/distance_by_channel", count());
      const auto distance_error = by_channel(group + "/distance_error_by_channel", count());
      const auto size = by_channel(group + "/size_by_channel", 1);
      const auto size_error = by_channel(group + "/size_error_by_channel", 1);
      for (std::size_t c = 0; c < distance.size(); ++c) {
        found.channels.push_back({distance[c], distance_error[c], size[c], size_error[c]});
      }
    }
    found.unresolved = unresolved(group);
    found.work = work(group);
    result_.comparisons.push_back(std::move(found));
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
      found.medoids.medoid.push_back(index_of(name, group + "/medoid"));
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
    for (const auto& material : study_.materials) found.targets.push_back(material.name());
    found.families = file_.texts("/basis_family");
    const std::size_t families = found.families.size();
    found.relative_residual = matrix(kind + "_residual", count(), families);
    found.relative_residual_error = matrix(kind + "_residual_error", count(), families);
    found.rank = matrix(kind + "_rank", count(), families).cast<int>();
    return found;
  }

  void read_agreement() {
    if (!file_.has("/agreement")) return;
    MetricAgreement& agreement = result_.agreement;
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
    CurveAngles& angles = result_.curve_angles;
    for (const auto& [name, values] :
         {std::pair("/curves/theta", &angles.theta), std::pair("/curves/theta_in", &angles.theta_in),
          std::pair("/curves/theta_out", &angles.theta_out)}) {
      const Shape shape = file_.shape(name);
      if (shape.size() != 1) file_.refuse("dataset " + std::string(name) + " is no list of angles");
      *values = file_.read(name, shape);
    }
    const std::size_t channels = study_.channels.size();
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
      MaterialCurves& curves = result_.curves.emplace_back();
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

  /// Figures, without what computes them.
  void read_figures() {
    const auto labels = file_.texts("/published/figure");
    const auto list = [&](const char* name) { return texts(std::string("/published/") + name, labels.size()); };
    const auto tables = list("table");
    const auto quantities = list("quantity");
    const auto materials = list("material_json");
    const auto printed = list("printed");
    const auto corrected = list("corrected");
    for (std::size_t i = 0; i < labels.size(); ++i) {
      PublishedFigure& figure = study_.published.emplace_back();
      figure.table = tables[i];
      figure.label = labels[i];
      figure.quantity = known("/published", parse_published_quantity, quantities[i]);
      figure.material = material_of(materials[i]);
      figure.printed = printed[i];
      figure.corrected = corrected[i];
    }
    study_.origins.published = origins("/published/origin", labels.size());
  }

  void read_checks() {
    const Shape shape{study_.published.size()};
    const auto values = estimates("/published/value", shape);
    const auto deviations = file_.read("/published/deviation", shape);
    const auto agrees = numbers("/published/agrees", shape, 2);
    const auto as_expected = numbers("/published/as_expected", shape, 2);
    for (std::size_t i = 0; i < values.size(); ++i) {
      result_.published.push_back({values[i], deviations[i], agrees[i] != 0, as_expected[i] != 0});
    }
  }

  /// A list of numbers of any length.
  [[nodiscard]] std::vector<double> list(const std::string& dataset) const {
    const Shape shape = file_.shape(dataset);
    if (shape.size() != 1) file_.refuse("dataset " + dataset + " is no list");
    return file_.read(dataset, shape);
  }

  /// A chart, without how it is drawn.
  [[nodiscard]] Chart chart(const std::string& group, const std::string& name) {
    Chart found;
    found.name = name;
    found.title = file_.line(group, "title");
    found.quantity = known(group, parse_chart_quantity, file_.line(group, "quantity"));
    if (!is_over_angle(found.quantity)) found.parameter = file_.line(group + "/x", "long_name");
    found.x = list(group + "/x");
    const auto labels = file_.texts(group + "/curve");
    const auto materials = texts(group + "/material_json", labels.size());
    std::vector<double> theta_in(labels.size(), 0);
    if (is_over_viewer(found.quantity)) theta_in = file_.read(group + "/theta_in", Shape{labels.size()});
    for (std::size_t i = 0; i < labels.size(); ++i) {
      found.curves.push_back({labels[i], {material_of(materials[i])}, theta_in[i]});
    }
    if (file_.has_attribute(group + "/value", "unit_json")) {
      found.unit = material_of(file_.text(group + "/value", "unit_json"));
    }
    study_.origins.curves.push_back(origins(group + "/origin", labels.size()));
    return found;
  }

  void read_values(const std::string& group, const Chart& chart) {
    const auto values = estimates(group + "/value", Shape{chart.curves.size(), chart.x.size()});
    ChartValues& found = result_.charts.emplace_back();
    for (std::size_t i = 0; i < chart.curves.size(); ++i) {
      const auto first = values.begin() + static_cast<std::ptrdiff_t>(i * chart.x.size());
      found.emplace_back(first, first + static_cast<std::ptrdiff_t>(chart.x.size()));
    }
  }

  void read_provenance() {
    constexpr const char* kGroup = "/provenance";
    const auto text = [&](const char* name) { return file_.text(kGroup, name); };
    const auto number = [&](const char* name) { return file_.number(kGroup, name); };
    StudyProvenance& provenance = result_.provenance;
    provenance.software_version = text("software_version");
    provenance.commit = text("git_commit");
    provenance.hdf5_version = text("hdf5_version");
    provenance.command_line = text("command_line");
    provenance.created = file_.text("/", "date_created");
    DeviceInfo& device = result_.device;
    device.platform = text("opencl_platform");
    device.platform_version = text("opencl_platform_version");
    device.name = text("opencl_device");
    device.version = text("opencl_device_version");
    device.driver = text("opencl_driver");
    study_.configuration = text("effective_config");
    if (text("precision") == "single") study_.precision = Precision::single_precision;
    study_.tolerance = number("tolerance");
    study_.patch_tolerance = number("patch_tolerance");
    study_.comparison_tolerance = number("comparison_tolerance");
    if (file_.has_attribute(kGroup, "function_tolerance")) study_.function_tolerance = number("function_tolerance");
    if (file_.has_attribute(kGroup, "domain_theta_max_deg")) {
      study_.domain_theta_max = number("domain_theta_max_deg") * kDegree;
    }
    provenance.states_grid = file_.has_attribute(kGroup, "grid");
    const std::string grid = provenance.states_grid ? text("grid") : "";
    if (!grid.empty()) study_.grid = known(kGroup, HemisphereGrid::parse, grid);
    if (file_.has("/provenance/study_file")) {
      const auto names = file_.texts("/provenance/study_file");
      const auto contents = texts("/provenance/study_text", names.size());
      for (std::size_t i = 0; i < names.size(); ++i) study_.texts.push_back({names[i], contents[i]});
    }
    if (file_.has("/provenance/override")) study_.overrides = file_.texts("/provenance/override");
  }

  hdf5::InputFile file_;
  StudyResult result_;
  Study& study_ = result_.study;
  std::vector<std::string> lighting_groups_;
  std::vector<std::string> literature_groups_;
  std::vector<std::string> chart_groups_;
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

StudyResult load_study_results(const std::filesystem::path& path) {
  return StudyReader(path).read();
}

StudyResult load_study_summary(const std::filesystem::path& path) {
  return StudyReader(path).summary();
}

}  // namespace lobe
