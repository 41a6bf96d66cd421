#include "lobe/study/report_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "core/text.hpp"
#include "lobe/core/error.hpp"
#include "report_files.hpp"
#include "study/report/report_data.hpp"

namespace lobe {
namespace {

std::string scripts() {
  std::string text;
  for (const std::string_view script :
       {report_files::d3, report_files::numbers_js, report_files::study_js, report_files::colours_js,
        report_files::matrix_js, report_files::tree_js, report_files::map_js, report_files::curves_js,
        report_files::tables_js, report_files::page_js}) {
    text += fmt::format("<script>\n{}</script>\n", script);
  }
  return text;
}

}  // namespace

std::string report_page(const StudyResult& result, const ReportSpheres& spheres) {
  const Study& study = result.study;
  if (study.materials.empty()) {
    throw ArgumentError("study '" + study.name + "' has no materials; expected one with distances");
  }
  if (!spheres.empty() && spheres.size() != study.materials.size()) {
    throw ArgumentError(
        fmt::format("{} spheres for {} materials; expected one each", spheres.size(), study.materials.size()));
  }
  const std::array<std::pair<std::string_view, std::string>, 5> parts{{
      {"{{title}}", escaped_markup(study.title.empty() ? study.name : study.title)},
      {"{{style}}", std::string(report_files::page_css)},
      {"{{licence}}", escaped_markup(report_files::d3_licence)},
      {"{{data}}", report_data(result, spheres)},
      {"{{scripts}}", scripts()},
  }};
  std::string page;
  std::string_view rest = report_files::page_html;
  for (std::size_t mark = rest.find("{{"); mark != std::string_view::npos; mark = rest.find("{{")) {
    const std::string_view found = rest.substr(mark);
    const auto* part = std::ranges::find_if(parts, [&](const auto& entry) { return found.starts_with(entry.first); });
    page += rest.substr(0, mark);
    page += part->second;
    rest = found.substr(part->first.size());
  }
  page += rest;
  return page;
}

}  // namespace lobe
