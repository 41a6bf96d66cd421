#include "interface/study_info.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "core/text.hpp"
#include "interface/measuring.hpp"
#include "interface/memory.hpp"
#include "interface/options.hpp"
#include "interface/table_report.hpp"
#include "lobe/study/study_results.hpp"

namespace lobe::cli {
namespace {

namespace fs = std::filesystem;

using Origins = std::vector<std::pair<std::string, std::string>>;

/// "Ward 8, Phong 4", in the order of the file.
std::string families_text(std::span<const StudyMaterial> materials) {
  std::vector<std::pair<std::string, std::size_t>> families;
  for (const auto& material : materials) {
    if (families.empty() || families.back().first != material.family()) families.emplace_back(material.family(), 0);
    ++families.back().second;
  }
  std::vector<std::string> texts;
  for (const auto& [family, count] : families) texts.push_back(fmt::format("{} {}", family, count));
  return fmt::format("{}: {}", materials.size(), fmt::join(texts, ", "));
}

std::string precision_text(const Study& study) {
  return study.precision == Precision::single_precision ? "single" : "double";
}

std::vector<Field> fields_of(const StudyResult& result, const fs::path& path) {
  const StudyProvenance& provenance = result.provenance;
  const Study& study = result.study;
  std::vector<Field> fields{{"study", fmt::format("{} ({})", path.string(), bytes_text(fs::file_size(path)))},
                            {"title", study.title}};
  const auto add = [&](const std::string& name, const std::string& text) {
    if (!text.empty()) fields.push_back({name, text});
  };
  add("comment", study.comment);
  for (const auto& reference : study.references) add("reference", reference);
  if (!study.materials.empty()) add("materials", families_text(study.materials));
  if (study.channels.size() > 1) add("channels", fmt::format("{}", fmt::join(study.channels, ", ")));
  add("computed", fmt::format("{} by lobe {} ({}) on {}", provenance.created, provenance.software_version,
                              provenance.commit, result.device.name));
  add("command line", provenance.command_line);
  add("tolerance", fmt::format("{}; patch lights {}; comparison metrics {}", shortest(study.tolerance),
                               shortest(study.patch_tolerance), shortest(study.comparison_tolerance)));
  if (const auto degrees = domain_degrees(study.domain_theta_max)) {
    add("domain", fmt::format("directions up to {} degrees", shortest(*degrees)));
  }
  add("precision", precision_text(study));
  if (study.grid) add("grid", study.grid->name());
  std::vector<std::string> files;
  for (const auto& text : study.texts) files.push_back(text.name);
  add("files", fmt::format("{}", fmt::join(files, ", ")));
  for (const auto& override : study.overrides) add("set from outside", override);
  return fields;
}

/// Names of parts with the texts of their origins, empty where unknown.
template <typename Parts, typename Name>
Origins with_origins(const Parts& parts, const std::vector<Origin>& origins, const Name& name) {
  Origins named;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    named.emplace_back(name(parts[i]), i < origins.size() ? to_string(origins[i]) : std::string());
  }
  return named;
}

Origins of_materials(const Study& study) {
  return with_origins(study.materials, study.origins.materials,
                      [](const StudyMaterial& material) { return material.name(); });
}

/// Lightings, then comparison metrics.
Origins of_metrics(const Study& study) {
  Origins all =
      with_origins(study.lightings, study.origins.lightings, [](const Lighting& lighting) { return lighting.name(); });
  const auto more = with_origins(study.comparison_metrics, study.origins.comparison_metrics,
                                 [](LiteratureMetric metric) { return std::string(to_string(metric)); });
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

Origins of_figures(const Study& study) {
  return with_origins(study.published, study.origins.published,
                      [](const PublishedFigure& figure) { return figure.table + ", " + figure.label; });
}

Origins of_charts(const Study& study) {
  return with_origins(study.charts, study.origins.charts, [](const Chart& chart) { return chart.name; });
}

/// Names and origins below a heading; nothing where there are none.
std::string origins_text(std::string_view heading, const Origins& origins) {
  if (origins.empty()) return "";
  std::vector<std::vector<std::string>> rows{{std::string(heading), "from"}};
  for (const auto& [name, origin] : origins) rows.push_back({name, origin.empty() ? "unknown" : origin});
  return "\n" + format_table(rows, 2, false);
}

Json origins_json(std::string_view key, const Origins& origins) {
  Json json = Json::array();
  for (const auto& [name, origin] : origins) {
    json.push_back({{std::string(key), name}, {"origin", origin.empty() ? Json(nullptr) : Json(origin)}});
  }
  return json;
}

Json json_of(const StudyResult& result, const fs::path& path) {
  const StudyProvenance& provenance = result.provenance;
  const Study& study = result.study;
  Json json = json_answer("info");
  json["file"] = path.string();
  json["file_bytes"] = fs::file_size(path);
  json["study"] = study.name;
  json["title"] = study.title;
  json["comment"] = study.comment;
  json["references"] = study.references;
  json["channels"] = study.channels;
  json["materials"] = origins_json("material", of_materials(study));
  for (std::size_t i = 0; i < study.materials.size(); ++i) json["materials"][i]["family"] = study.materials[i].family();
  json["metrics"] = origins_json("metric", of_metrics(study));
  json["published"] = origins_json("figure", of_figures(study));
  json["charts"] = origins_json("chart", of_charts(study));
  const std::string grid = study.grid ? study.grid->name() : "";
  json["provenance"] = {{"created", provenance.created},
                        {"software_version", provenance.software_version},
                        {"git_commit", provenance.commit},
                        {"command_line", provenance.command_line},
                        {"device", result.device.name},
                        {"precision", precision_text(study)},
                        {"tolerance", study.tolerance},
                        {"patch_tolerance", study.patch_tolerance},
                        {"comparison_tolerance", study.comparison_tolerance},
                        {"domain_theta_max_deg", domain_degrees(study.domain_theta_max).value_or(90)},
                        {"grid", provenance.states_grid ? Json(grid) : Json(nullptr)},
                        {"set", study.overrides}};
  json["study_text"] = study.configuration;
  json["files"] = Json::array();
  for (const auto& text : study.texts) json["files"].push_back({{"name", text.name}, {"text", text.text}});
  return json;
}

}  // namespace

ExitCode describe_study(Session& session, const fs::path& path) {
  const StudyResult result = load_study_summary(path);
  const Study& study = result.study;
  if (session.wants_json()) {
    session.print_json(json_of(result, path));
  } else if (session.arguments().has(option::study)) {
    session.print(study.configuration);
  } else {
    session.print(fields_text(fields_of(result, path)));
    if (session.arguments().has(option::header_only)) return ExitCode::success;
    session.print(origins_text("metric", of_metrics(study)) + origins_text("material", of_materials(study)) +
                  origins_text("figure", of_figures(study)) + origins_text("chart", of_charts(study)));
  }
  return ExitCode::success;
}

}  // namespace lobe::cli
