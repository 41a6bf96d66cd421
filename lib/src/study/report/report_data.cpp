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
#include "lobe/core/error.hpp"
#include "lobe/core/version.hpp"
#include "lobe/model/specification.hpp"
#include "metric/lighting_traits.hpp"

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

std::vector<std::string> families_of(const StudyResults& results) {
  std::vector<std::string> families;
  for (const auto& material : results.materials) {
    if (std::ranges::find(families, material.family) == families.end()) families.push_back(material.family);
  }
  return families;
}

/// The material in its JSON; none for files.
std::optional<Material> formula_of(const StudyMaterial& material) {
  const Json json = Json::parse(material.json, nullptr, false);
  if (!json.is_object() || !json.contains("terms")) return {};
  try {
    return material_from_json(material.json);
  } catch (const ArgumentError&) {
    return {};  // of a model that this version does not know
  }
}

/// Which of a study's numbers commands compute again, and how.
class Commands {
 public:
  explicit Commands(const StudyResults& results) : provenance_(results.provenance) {
    // 'lobe distance' weighs channels alike.
    const auto& weights = results.channel_weights;
    const double equal = 1 / static_cast<double>(std::max<std::size_t>(weights.size(), 1));
    const bool is_equal = std::ranges::all_of(weights, [&](double weight) { return std::abs(weight - equal) < 1e-14; });
    has_formulas_ = true;
    for (const auto& material : results.materials) {
      const auto formula = formula_of(material);
      has_formulas_ = has_formulas_ && formula.has_value();
      const auto text = formula ? specification(*formula) : std::nullopt;
      operands_.push_back(text && is_equal ? std::optional(shell_word(*text)) : std::nullopt);
      curve_operands_.push_back(text ? std::optional(shell_word(*text)) : std::nullopt);
    }
  }

  /// A material as a word of commands that measure pairs; null if there is no such word.
  [[nodiscard]] Json operand(std::size_t material) const { return json_of(operands_[material]); }
  /// A material as a word of commands on one material; null if there is no such word.
  [[nodiscard]] Json curve_operand(std::size_t material) const { return json_of(curve_operands_[material]); }

  /// Options of commands that measure; null if only 'lobe run' gives the same numbers.
  [[nodiscard]] Json arguments(const StudyDistances& distances) const {
    // Only 'lobe run' gives these numbers for files; older results do not record grids.
    if (!distances.is_lighting || !has_formulas_ || !provenance_.grid) return nullptr;
    try {
      const Lighting lighting = parse_lighting(distances.name);
      const double tolerance = traits_of(lighting).has_patch_tolerance
                                   ? std::max(provenance_.tolerance, provenance_.patch_tolerance)
                                   : provenance_.tolerance;
      std::string text = fmt::format("--lighting {} --tolerance {}", shell_word(distances.name), shortest(tolerance));
      if (provenance_.domain_theta_max_deg < 90) {
        text += fmt::format(" --domain-theta-max {}", shortest(provenance_.domain_theta_max_deg));
      }
      if (!provenance_.grid->empty())
        text += fmt::format(" --grid {} --allow-unresolved", shell_word(*provenance_.grid));
      if (provenance_.precision == "single") text += " --precision single";
      return text;
    } catch (const ArgumentError&) {
      return nullptr;
    }
  }

 private:
  static Json json_of(const std::optional<std::string>& text) { return text ? Json(*text) : Json(nullptr); }

  const StudyProvenance& provenance_;
  bool has_formulas_ = false;
  std::vector<std::optional<std::string>> operands_;
  std::vector<std::optional<std::string>> curve_operands_;
};

Json materials_json(const StudyResults& results, const std::vector<std::string>& families, const Commands& commands) {
  Json list = Json::array();
  for (std::size_t i = 0; i < results.materials.size(); ++i) {
    const StudyMaterial& material = results.materials[i];
    const auto family = std::ranges::find(families, material.family) - families.begin();
    const Json details = Json::parse(material.json, nullptr, false);
    const bool is_file = details.is_object() && details.contains("file");
    list.push_back({{"name", material.name},
                    {"family", family},
                    {"file", is_file ? details["file"] : Json(nullptr)},
                    {"origin", material.origin.empty() ? Json(nullptr) : Json(material.origin)},
                    {"operand", commands.operand(i)},
                    {"curve_operand", commands.curve_operand(i)}});
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

Json distances_json(const StudyDistances& distances, const Commands& commands) {
  Json json{{"name", distances.name},
            {"is_lighting", distances.is_lighting},
            {"definition", distances.definition},
            {"origin", distances.origin.empty() ? Json(nullptr) : Json(distances.origin)},
            {"unit", distances.unit},
            {"unresolved_pairs", distances.unresolved_pairs},
            {"arguments", commands.arguments(distances)}};
  add_estimates(json, "distance", lower_triangle(distances.distance, distances.distance_error));
  add_estimates(json, "norm", entries(distances.norm, distances.norm_error));
  if (distances.clustering) {
    const Clustering& clustering = *distances.clustering;
    json["leaf_order"] = clustering.leaf_order;
    json["merges"] = tree_json(clustering.tree);
    json["medoids"] = clustering.medoids.medoid;
    json["cluster"] = clustering.medoids.cluster;
    json["mean_silhouette"] = rounded(clustering.mean_silhouette);
    json["mean_silhouette_error"] = rounded_error(clustering.mean_silhouette.error);
  } else {
    const Dendrogram tree = average_linkage(distances.distance, distances.distance_error);
    json["leaf_order"] = optimal_leaf_order(tree, distances.distance);
    json["merges"] = tree_json(tree);
  }
  const int dimensions = std::min(2, static_cast<int>(distances.norm.size()));
  json["map"] =
      map_json(distances.embedding ? *distances.embedding : classical_scaling(distances.distance, dimensions));
  json["approximations"] = Json::array();
  for (const auto& residuals : distances.residuals) json["approximations"].push_back(residuals_json(residuals));
  return json;
}

Json degrees_json(const std::vector<double>& radians) {
  Json json = Json::array();
  // From degrees through radians and back.
  for (const double angle : radians) json.push_back(with_digits(to_degrees(angle), 12));
  return json;
}

Json curves_json(const StudyResults& results) {
  if (results.curves.empty()) return nullptr;
  constexpr int kDigits = 4;  // of values that are drawn only
  Json json{{"theta", degrees_json(results.curve_angles.theta)},
            {"theta_in", degrees_json(results.curve_angles.theta_in)},
            {"theta_out", degrees_json(results.curve_angles.theta_out)},
            {"materials", Json::array()}};
  for (const MaterialCurves& curves : results.curves) {
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

Json provenance_json(const StudyProvenance& provenance) {
  return {{"created", provenance.created},
          {"command_line", provenance.command_line},
          {"software", fmt::format("lobe {} ({})", provenance.software_version, provenance.commit)},
          {"device", provenance.device},
          {"device_version", provenance.device_version},
          {"platform", fmt::format("{}, {}", provenance.platform, provenance.platform_version)},
          {"driver", provenance.driver},
          {"hdf5", provenance.hdf5_version},
          {"precision", provenance.precision},
          {"tolerance", provenance.tolerance},
          {"patch_tolerance", provenance.patch_tolerance},
          {"comparison_tolerance", provenance.comparison_tolerance},
          {"domain_theta_max_deg", provenance.domain_theta_max_deg},
          {"grid", provenance.grid ? Json(*provenance.grid) : Json(nullptr)},
          {"overrides", provenance.overrides},
          {"configuration", provenance.configuration},
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

std::string report_data(const StudyResults& results) {
  const auto families = families_of(results);
  const Commands commands(results);
  std::vector<std::string> family_words;
  for (const auto& family : families) family_words.push_back(shell_word(family));
  Json data{{"schema", "lobe-report/1"},
            {"name", results.name},
            {"title", results.title},
            {"comment", results.comment},
            {"references", results.references},
            {"families", families},
            {"family_words", family_words},
            {"study_file", results.name + ".toml"},
            {"study_file_word", shell_word(results.name + ".toml")},
            {"materials", materials_json(results, families, commands)},
            {"channels", results.channels},
            {"channel_weights", results.channel_weights},
            {"measures", Json::array()}};
  for (const auto& distances : results.distances) data["measures"].push_back(distances_json(distances, commands));
  data["agreement"] = agreement_json(results.agreement);
  data["curves"] = curves_json(results);
  std::vector<std::string> degrees;
  for (const double angle : results.curve_angles.theta) {
    degrees.push_back(shortest(with_digits(to_degrees(angle), 12)));
  }
  data["albedo_arguments"] =
      fmt::format("--theta {} --tolerance {}", fmt::join(degrees, ","), shortest(kCurveAlbedoTolerance));
  data["published_figures"] = results.published_figures;
  data["charts"] = results.charts;
  data["provenance"] = provenance_json(results.provenance);
  return safe_text(data);
}

}  // namespace lobe
