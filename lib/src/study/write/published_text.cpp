#include "study/write/published_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/text.hpp"
#include "study/write/origin_text.hpp"

namespace lobe {
namespace {

/// With three digits more than were printed.
std::string value_text(const PublishedFigure& figure, const PublishedCheck& check) {
  constexpr int kFurther = 3;
  const double units = std::abs(check.value.value) / unit_of_last_digit(figure.printed);
  const int printed = units >= 1 ? static_cast<int>(std::floor(std::log10(units))) + 1 : 0;
  return fmt::format("{:.{}g}", check.value.value, printed + kFurther);
}

std::string verdict(const PublishedFigure& figure, const PublishedCheck& check) {
  if (!check.is_as_expected) return "**missed**";
  return figure.corrected.empty() ? "right" : fmt::format("should be {}", figure.corrected);
}

/// Rounded, and without the sign of a zero.
double hundredths(double value) {
  return std::round(100 * value) / 100 + 0.0;
}

/// Bars would end a cell.
std::string cell(std::string_view text) {
  return fmt::format("{}", fmt::join(split(text, '|'), "\\|"));
}

}  // namespace

std::string published_csv(const StudyResult& result) {
  std::string text = "table,figure,printed,corrected,value,error,deviation,agrees,as_expected,origin\n";
  for (std::size_t i = 0; i < result.published.size(); ++i) {
    const PublishedFigure& figure = result.study.published[i];
    const PublishedCheck& check = result.published[i];
    fmt::format_to(std::back_inserter(text), "{},{},{},{},{},{},{},{},{},{}\n", csv_field(figure.table),
                   csv_field(figure.label), figure.printed, figure.corrected, shortest(check.value.value),
                   shortest(check.value.error), shortest(check.deviation), check.agrees ? "yes" : "no",
                   check.is_as_expected ? "yes" : "no", csv_field(origin_text(result.study.origins.published, i)));
  }
  return text;
}

std::string published_page(const StudyResult& result) {
  const Study& study = result.study;
  const auto& checks = result.published;
  const auto agreeing = std::ranges::count_if(checks, &PublishedCheck::agrees);
  std::string text = fmt::format("# {}\n\n", study.title.empty() ? study.name : study.title);
  if (!study.comment.empty()) text += fmt::format("{}\n\n", study.comment);
  for (const auto& reference : study.references) text += fmt::format("* {}\n", reference);
  if (!study.references.empty()) text += "\n";
  fmt::format_to(std::back_inserter(text),
                 "Printed figures: {}, of which {} agree with the values computed here. Deviations are in units of the "
                 "last printed\ndigit; a figure agrees when the value rounds to it.\n",
                 checks.size(), agreeing);
  for (std::size_t i = 0; i < checks.size(); ++i) {
    const PublishedFigure& figure = study.published[i];
    if (i == 0 || study.published[i - 1].table != figure.table) {
      fmt::format_to(std::back_inserter(text),
                     "\n## {}\n\n| figure | printed | computed | deviation | the printed figure is |\n"
                     "|---|---|---|---|---|\n",
                     figure.table);
    }
    fmt::format_to(std::back_inserter(text), "| {} | {} | {} | {:.2f} | {} |\n", cell(figure.label), figure.printed,
                   value_text(figure, checks[i]), hundredths(checks[i].deviation), verdict(figure, checks[i]));
  }
  return text;
}

}  // namespace lobe
