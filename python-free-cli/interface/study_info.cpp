#include "interface/study_info.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "core/text.hpp"
#include "interface/memory.hpp"
#include "interface/options.hpp"
#include "interface/table_report.hpp"
#include "lobe/study/study_results.hpp"

namespace lobe::cli {
namespace {

namespace fs = std::filesystem;

using Origins = std::vector<std::pair<std::string, std::string>>;

/// "Ward 8, Phong 4", in the order of the file.
std::string families_text(const std::vector<StudyMaterial>& materials) {
  std::vector<std::pair<std::string, std::size_t>> families;
  for (const auto& material : materials) {
    if (families.empty() || families.back().first != material.family) families.emplace_back(material.family, 0);
    ++families.back().second;
  }
  std::vector<std::string> texts;
  for (const auto& [family, count] : families) texts.push_back(fmt::format("{} {}", family, count));
  return fmt::format("{}: {}", materials.size(), fmt::join(texts, ", "));
}

std::vector<Field> fields_of(const StudySummary& study, const fs::path& path) {
  const StudyProvenance& provenance = study.provenance;
  std::vector<Field> fields{{"study", fmt::format("{} ({})", path.string(), bytes_text(fs::file_size(path)))},
                            {"title", study.title}};
  const auto add = [&](const std::string& name, const std::string& text) {
    if (!text.empty()) fields.push_back({name, text});
  };
  add("comment", study.comment);
  for (const auto reference : split(study.references, '\n')) add("reference", std::string(reference));
  if (!study.materials.empty()) add("materials", families_text(study.materials));
  if (study.channels.size() > 1) add("channels", fmt::format("{}", fmt::join(study.channels, ", ")));
  add("computed", fmt::format("{} by lobe {} ({}) on {}", provenance.created, provenance.software_version,
                              provenance.commit, provenance.device));
  add("command line", provenance.command_line);
  add("tolerance", fmt::format("{}; patch lights {}; comparison metrics {}", shortest(provenance.tolerance),
                               shortest(provenance.patch_tolerance), shortest(provenance.comparison_tolerance)));
  if (provenance.domain_theta_max_deg < 90) {
    add("domain", fmt::format("directions up to {} degrees", shortest(provenance.domain_theta_max_deg)));
  }
  add("precision", provenance.precision);
  add("grid", provenance.grid.value_or(""));
  std::vector<std::string> files;
  for (const auto& text : provenance.texts) files.push_back(text.name);
  add("files", fmt::format("{}", fmt::join(files, ", ")));
  for (const auto& override : provenance.overrides) add("set from outside", override);
  return fields;
}

/// Names and origins below a heading; nothing where there are none.
std::string origins_text(std::string_view heading, const Origins& origins) {
  if (origins.empty()) return "";
  std::vector<std::vector<std::string>> rows{{std::string(heading), "from"}};
  for (const auto& [name, origin] : origins) rows.push_back({name, origin.empty() ? "unknown" : origin});
  return "\n" + format_table(rows, 2, false);
}

Origins of_materials(const StudySummary& study) {
  Origins origins;
  for (const auto& material : study.materials) origins.emplace_back(material.name, material.origin);
  return origins;
}

Json origins_json(std::string_view key, const Origins& origins) {
  Json json = Json::array();
  for (const auto& [name, origin] : origins) {
    json.push_back({{std::string(key), name}, {"origin", origin.empty() ? Json(nullptr) : Json(origin)}});
  }
  return json;
}

Json json_of(const StudySummary& study, const fs::path& path) {
  const StudyProvenance& provenance = study.provenance;
  Json json = json_answer("info");
  json["file"] = path.string();
  json["file_bytes"] = fs::file_size(path);
  json["study"] = study.name;
  json["title"] = study.title;
  json["comment"] = study.comment;
  json["references"] = study.references.empty() ? Json::array() : Json(split(study.references, '\n'));
  json["channels"] = study.channels;
  json["materials"] = origins_json("material", of_materials(study));
  for (std::size_t i = 0; i < study.materials.size(); ++i) json["materials"][i]["family"] = study.materials[i].family;
  json["metrics"] = origins_json("metric", study.metrics);
  json["published"] = origins_json("figure", study.published);
  json["charts"] = origins_json("chart", study.charts);
  json["provenance"] = {{"created", provenance.created},
                        {"software_version", provenance.software_version},
                        {"git_commit", provenance.commit},
                        {"command_line", provenance.command_line},
                        {"device", provenance.device},
                        {"precision", provenance.precision},
                        {"tolerance", provenance.tolerance},
                        {"patch_tolerance", provenance.patch_tolerance},
                        {"comparison_tolerance", provenance.comparison_tolerance},
                        {"domain_theta_max_deg", provenance.domain_theta_max_deg},
                        {"grid", provenance.grid ? Json(*provenance.grid) : Json(nullptr)},
                        {"set", provenance.overrides}};
  json["study_text"] = provenance.configuration;
  json["files"] = Json::array();
  for (const auto& text : provenance.texts) json["files"].push_back({{"name", text.name}, {"text", text.text}});
  return json;
}

}  // namespace

ExitCode describe_study(Session& session, const fs::path& path) {
  const StudySummary study = load_study_summary(path);
  if (session.wants_json()) {
    session.print_json(json_of(study, path));
  } else if (session.arguments().has(option::study)) {
    session.print(study.provenance.configuration);
  } else {
    session.print(fields_text(fields_of(study, path)));
    if (session.arguments().has(option::header_only)) return ExitCode::success;
    session.print(origins_text("metric", study.metrics) + origins_text("material", of_materials(study)) +
                  origins_text("figure", study.published) + origins_text("chart", study.charts));
  }
  return ExitCode::success;
}

}  // namespace lobe::cli
