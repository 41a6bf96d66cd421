#include "study/report/report_data.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <vector>

#include "core/shell.hpp"
#include "core/text.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/core/version.hpp"
#include "lobe/metric/unit.hpp"
#include "lobe/model/specification.hpp"
#include "metric/domain.hpp"
#include "metric/lighting_traits.hpp"
#include "plot/png.hpp"
#include "study/write/origin_text.hpp"

namespace lobe {
namespace {

using Json = nlohmann::ordered_json;

/// The number with so many digits, as JSON then shows it.
double with_digits(double value, int digits) {
  return std::isfinite(value) ? std::strtod(fmt::format("{:.{}g}", value, digits).c_str(), nullptr) : value;
}

/// Two digits more than the error leaves certain.
double rounded(const Estimate& estimate) {
  constexpr double kMostDigits = 17;
  if (!(estimate.error > 0) || !std::isfinite(estimate.error)) return estimate.value;
  const double ratio = std::abs(estimate.value) / estimate.error;
  const double digits = ratio > 1 ? std::floor(std::log10(ratio)) + 3 : 3;
  return with_digits(estimate.value, static_cast<int>(std::min(digits, kMostDigits)));
}

double rounded_error(double error) {
  return with_digits(error, 2);
}

/// Values and errors of a list, under two keys.
void add_estimates(Json& json, const std::string& key, const std::vector<Estimate>& estimates) {
  Json values = Json::array();
  Json errors = Json::array();
  for (const Estimate& estimate : estimates) {
    values.push_back(rounded(estimate));
    errors.push_back(rounded_error(estimate.error));
  }
  json[key] = std::move(values);
  json[key + "_error"] = std::move(errors);
}

std::vector<Estimate> lower_triangle(const Eigen::MatrixXd& values, const Eigen::MatrixXd& errors) {
  std::vector<Estimate> estimates;
  for (Eigen::Index i = 1; i < values.rows(); ++i) {
    for (Eigen::Index j = 0; j < i; ++j) estimates.push_back({values(i, j), errors(i, j)});
  }
  return estimates;
}

std::vector<Estimate> entries(const Eigen::VectorXd& values, const Eigen::VectorXd& errors) {
  std::vector<Estimate> estimates;
  for (Eigen::Index i = 0; i < values.size(); ++i) estimates.push_back({values(i), errors(i)});
  return estimates;
}

std::vector<std::string> families_of(const StudyResult& result) {
  std::vector<std::string> families;
  for (const auto& material : result.study.materials) {
    if (std::ranges::find(families, material.family()) == families.end()) families.push_back(material.family());
  }
  return families;
}

/// Which of a study's numbers commands compute again, and how.
class Commands {
 public:
  explicit Commands(const StudyResult& result) : study_(result.study), states_grid_(result.provenance.states_grid) {
    // 'lobe distance' weighs channels alike.
    const auto& weights = study_.channel_weights;
    const double equal = 1 / static_cast<double>(std::max<std::size_t>(weights.size(), 1));
    const bool is_equal = std::ranges::all_of(weights, [&](double weight) { return std::abs(weight - equal) < 1e-14; });
    has_formulas_ = true;
    for (const auto& material : study_.materials) {
      const Material* formula = material.formula();
      has_formulas_ = has_formulas_ && formula != nullptr;
      const auto text = formula != nullptr ? specification(*formula) : std::nullopt;
      operands_.push_back(text && is_equal ? std::optional(shell_word(*text)) : std::nullopt);
      curve_operands_.push_back(text ? std::optional(shell_word(*text)) : std::nullopt);
    }
  }

  /// A material as a word of commands that measure pairs; null if there is no such word.
  [[nodiscard]] Json operand(std::size_t material) const { return json_of(operands_[material]); }
  /// A material as a word of commands on one material; null if there is no such word.
  [[nodiscard]] Json curve_operand(std::size_t material) const { return json_of(curve_operands_[material]); }

  /// Options of commands that measure; null if only 'lobe run' gives the same numbers.
  [[nodiscard]] Json arguments(const Lighting& lighting) const {
    // Only 'lobe run' gives these numbers for files; older results do not record grids.
    if (!has_formulas_ || !states_grid_ || !lighting.is_told_by_name()) return nullptr;
    const double tolerance = formula_tolerance(lighting, metric_options(study_));
    std::string text = fmt::format("--lighting {} --tolerance {}", shell_word(lighting.name()), shortest(tolerance));
    if (const double degrees = degrees_of_domain(study_.domain_theta_max); degrees < 90) {
      text += fmt::format(" --domain-theta-max {}", shortest(degrees));
    }
    if (study_.grid) text += fmt::format(" --grid {} --allow-unresolved", shell_word(study_.grid->name()));
    if (study_.precision == Precision::single_precision) text += " --precision single";
    return text;
  }

 private:
  static Json json_of(const std::optional<std::string>& text) { return text ? Json(*text) : Json(nullptr); }

  const Study& study_;
  bool states_grid_;
  bool has_formulas_ = false;
  std::vector<std::optional<std::string>> operands_;
  std::vector<std::optional<std::string>> curve_operands_;
};

Json text_or_null(const std::string& text) {
  return text.empty() ? Json(nullptr) : Json(text);
}

Json materials_json(const Study& study, const std::vector<std::string>& families, const Commands& commands) {
  Json list = Json::array();
  for (std::size_t i = 0; i < study.materials.size(); ++i) {
    const StudyMaterial& material = study.materials[i];
    const auto family = std::ranges::find(families, material.family()) - families.begin();
    list.push_back({{"name", material.name()},
                    {"family", family},
                    {"file", material.file() != nullptr ? Json(material.file()->name) : Json(nullptr)},
                    {"origin", text_or_null(origin_text(study.origins.materials, i))},
                    {"operand", commands.operand(i)},
                    {"curve_operand", commands.curve_operand(i)}});
  }
  return list;
}

/// Addresses of pictures, null where there is none.
Json spheres_json(const ReportSpheres& spheres) {
  Json list = Json::array();
  for (const auto& sphere : spheres) {
    const auto address = [&] {
      return "data:image/png;base64," + base64(png_file(sphere->size, sphere->size, sphere->rgb));
    };
    list.push_back(sphere ? Json(address()) : Json(nullptr));
  }
  return list;
}

Json tree_json(const Dendrogram& tree) {
  Json list = Json::array();
  for (const Merge& merge : tree.merges) {
    list.push_back({merge.first, merge.second, rounded(merge.height), rounded_error(merge.height.error), merge.size});
  }
  return list;
}

Json map_json(const Embedding& embedding) {
  // Pixels need no more.
  constexpr int kDigits = 6;
  Json json{{"explained_share", with_digits(embedding.explained_share, kDigits)}, {"points", Json::array()}};
  for (Eigen::Index i = 0; i < embedding.coordinates.rows(); ++i) {
    Json point = Json::array();
    for (Eigen::Index axis = 0; axis < 2; ++axis) {
      const bool has_axis = axis < embedding.coordinates.cols();
      point.push_back(has_axis ? with_digits(embedding.coordinates(i, axis), kDigits) : 0);
    }
    json["points"].push_back(std::move(point));
  }
  return json;
}

Json residuals_json(const FamilyResiduals& residuals) {
  Json json{{"fit", to_string(residuals.non_negative ? FamilyFit::non_negative : FamilyFit::linear)},
            {"families", residuals.families},
            {"rows", Json::array()}};
  for (Eigen::Index i = 0; i < residuals.relative_residual.rows(); ++i) {
    Json row;
    add_estimates(row, "residual",
                  entries(residuals.relative_residual.row(i), residuals.relative_residual_error.row(i)));
    json["rows"].push_back(std::move(row));
  }
  return json;
}

/// Tree and map of distances.
void add_views(Json& json, const Dendrogram& tree, const std::vector<std::size_t>& leaf_order) {
  json["leaf_order"] = leaf_order;
  json["merges"] = tree_json(tree);
}

Json lighting_json(const StudyResult& result, std::size_t index, const Commands& commands) {
  const MetricResult& metric = result.metrics[index];
  const Metric& combined = metric.combined;
  Json json{{"name", metric.lighting.name()},
            {"is_lighting", true},
            {"definition", metric.lighting.definition()},
            {"origin", text_or_null(origin_text(result.study.origins.lightings, index))},
            {"unit", norm_unit(metric.lighting, UnitStyle::udunits)},
            {"unresolved_pairs", metric.unresolved.size()},
            {"arguments", commands.arguments(metric.lighting)}};
  add_estimates(json, "distance", lower_triangle(combined.distance, combined.distance_error));
  add_estimates(json, "norm", entries(combined.norm, combined.norm_error));
  const Clustering& clustering = result.clusterings[index];
  add_views(json, clustering.tree, clustering.leaf_order);
  json["medoids"] = clustering.medoids.medoid;
  json["cluster"] = clustering.medoids.cluster;
  json["mean_silhouette"] = rounded(clustering.mean_silhouette);
  json["mean_silhouette_error"] = rounded_error(clustering.mean_silhouette.error);
  json["map"] = map_json(result.embeddings[index]);
  json["approximations"] = Json::array();
  const std::size_t fits = result.study.approximations.size();
  for (std::size_t k = 0; k < fits; ++k) {
    json["approximations"].push_back(residuals_json(result.residuals.at(index * fits + k)));
  }
  return json;
}

Json literature_json(const StudyResult& result, std::size_t index) {
  const LiteratureResult& found = result.comparisons[index];
  const LiteratureMatrix& combined = found.combined;
  const std::string_view unit = unit_of(found.metric);
  Json json{{"name", to_string(found.metric)},
            {"is_lighting", false},
            {"definition", ""},
            {"origin", text_or_null(origin_text(result.study.origins.comparison_metrics, index))},
            {"unit", unit.empty() ? "1" : unit},
            {"unresolved_pairs", found.unresolved.size()},
            {"arguments", nullptr}};
  add_estimates(json, "distance", lower_triangle(combined.distance, combined.distance_error));
  add_estimates(json, "norm", entries(combined.size, combined.size_error));
  const Dendrogram tree = average_linkage(combined.distance, combined.distance_error);
  add_views(json, tree, optimal_leaf_order(tree, combined.distance));
  const int dimensions = std::min(2, static_cast<int>(combined.size.size()));
  json["map"] = map_json(classical_scaling(combined.distance, dimensions));
  json["approximations"] = Json::array();
  return json;
}

Json degrees_json(const std::vector<double>& radians) {
  Json json = Json::array();
  // From degrees through radians and back.
  for (const double angle : radians) json.push_back(with_digits(to_degrees(angle), 12));
  return json;
}

Json curves_json(const StudyResult& result) {
  if (result.curves.empty()) return nullptr;
  constexpr int kDigits = 4;  // of values that are drawn only
  Json json{{"theta", degrees_json(result.curve_angles.theta)},
            {"theta_in", degrees_json(result.curve_angles.theta_in)},
            {"theta_out", degrees_json(result.curve_angles.theta_out)},
            {"materials", Json::array()}};
  for (const MaterialCurves& curves : result.curves) {
    Json material{{"has_delta", curves.has_delta}, {"channels", Json::array()}};
    for (std::size_t c = 0; c < curves.albedo.size(); ++c) {
      Json channel;
      add_estimates(channel, "albedo", curves.albedo[c]);
      channel["reflectance"] = Json::array();
      for (const auto& slice : curves.reflectance[c]) {
        Json values = Json::array();
        for (const Estimate& value : slice) values.push_back(with_digits(value.value, kDigits));
        channel["reflectance"].push_back(std::move(values));
      }
      material["channels"].push_back(std::move(channel));
    }
    // A material with one channel has equal channels here; one is enough.
    auto& channels = material["channels"];
    if (std::ranges::all_of(channels, [&](const Json& channel) { return channel == channels.front(); })) {
      while (channels.size() > 1) channels.erase(channels.size() - 1);
    }
    json["materials"].push_back(std::move(material));
  }
  return json;
}

Json matrix_json(const Eigen::MatrixXd& matrix) {
  constexpr int kDigits = 4;
  Json rows = Json::array();
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    Json row = Json::array();
    for (const double entry : matrix.row(i)) row.push_back(with_digits(entry, kDigits));
    rows.push_back(std::move(row));
  }
  return rows;
}

Json agreement_json(const MetricAgreement& agreement) {
  if (agreement.metrics.empty()) return nullptr;
  return {{"metrics", agreement.metrics},
          {"spearman", matrix_json(agreement.all_pairs.spearman)},
          {"kendall", matrix_json(agreement.all_pairs.kendall)}};
}

Json provenance_json(const StudyResult& result) {
  const StudyProvenance& provenance = result.provenance;
  const Study& study = result.study;
  const DeviceInfo& device = result.device;
  const std::string grid = study.grid ? study.grid->name() : "";
  return {{"created", provenance.created},
          {"command_line", provenance.command_line},
          {"software", fmt::format("lobe {} ({})", provenance.software_version, provenance.commit)},
          {"device", device.name},
          {"device_version", device.version},
          {"platform", fmt::format("{}, {}", device.platform, device.platform_version)},
          {"driver", device.driver},
          {"hdf5", provenance.hdf5_version},
          {"precision", study.precision == Precision::single_precision ? "single" : "double"},
          {"tolerance", study.tolerance},
          {"patch_tolerance", study.patch_tolerance},
          {"comparison_tolerance", study.comparison_tolerance},
          {"domain_theta_max_deg", degrees_of_domain(study.domain_theta_max)},
          {"grid", provenance.states_grid ? Json(grid) : Json(nullptr)},
          {"overrides", study.overrides},
          {"configuration", study.configuration},
          {"report", fmt::format("lobe {} ({})", version(), commit())}};
}

/// JSON within HTML: no character that could end the element, or that a script takes for the end of a line.
std::string safe_text(const Json& json) {
  const std::string text = json.dump(-1, ' ', true, Json::error_handler_t::replace);
  std::string safe;
  safe.reserve(text.size());
  for (const char c : text) {
    if (c == '<') {
      safe += "\\u003c";
    } else {
      safe += c;
    }
  }
  return safe;
}

}  // namespace

std::string report_data(const StudyResult& result, const ReportSpheres& spheres) {
  const Study& study = result.study;
  const auto families = families_of(result);
  const Commands commands(result);
  std::vector<std::string> family_words;
  for (const auto& family : families) family_words.push_back(shell_word(family));
  Json data{{"schema", "lobe-report/1"},
            {"name", study.name},
            {"title", study.title},
            {"comment", study.comment},
            {"references", fmt::format("{}", fmt::join(study.references, "\n"))},
            {"families", families},
            {"family_words", family_words},
            {"study_file", study.name + ".toml"},
            {"study_file_word", shell_word(study.name + ".toml")},
            {"materials", materials_json(study, families, commands)},
            {"spheres", spheres_json(spheres)},
            {"channels", study.channels},
            {"channel_weights", study.channel_weights},
            {"measures", Json::array()}};
  for (std::size_t i = 0; i < result.metrics.size(); ++i)
    data["measures"].push_back(lighting_json(result, i, commands));
  for (std::size_t i = 0; i < result.comparisons.size(); ++i) data["measures"].push_back(literature_json(result, i));
  data["agreement"] = agreement_json(result.agreement);
  data["curves"] = curves_json(result);
  std::vector<std::string> degrees;
  for (const double angle : result.curve_angles.theta) {
    degrees.push_back(shortest(with_digits(to_degrees(angle), 12)));
  }
  data["albedo_arguments"] =
      fmt::format("--theta {} --tolerance {}", fmt::join(degrees, ","), shortest(kCurveAlbedoTolerance));
  data["published_figures"] = result.published.size();
  data["charts"] = result.charts.size();
  data["provenance"] = provenance_json(result);
  return safe_text(data);
}

}  // namespace lobe
