#include "study/run/kept_units.hpp"

#include <cstddef>

#include "metric/lighting_traits.hpp"
#include "study/run/checkpoint_records.hpp"
#include "study/run/study_identity.hpp"
#include "study/run/study_units.hpp"

namespace lobe {

KeptNames::KeptNames(const Study& study) {
  for (const auto& lighting : study.lightings) {
    if (traits_of(lighting).is_by_tables) special_.emplace(record_name(lighting), "");
  }
  for (std::size_t i = 0; i < study.published.size(); ++i) {
    special_.emplace(figure_name(i), figure_name(i) + ", " + part_digest(study.published[i]));
  }
  for (std::size_t i = 0; i < study.charts.size(); ++i) {
    const std::string digest = part_digest(study.charts[i]);
    for (std::size_t k = 0; k < study.charts[i].curves.size(); ++k) {
      special_.emplace(chart_curve_name(i, k), chart_curve_name(i, k) + ", " + digest);
    }
  }
}

std::string KeptNames::of(const std::string& unit) const {
  const auto found = special_.find(unit);
  return found == special_.end() ? unit : found->second;
}

}  // namespace lobe
