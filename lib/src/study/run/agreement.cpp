#include "study/run/agreement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <string_view>
#include <vector>

#include "core/text.hpp"

namespace lobe {

bool has_agreement(const Study& study) {
  return study.lightings.size() + study.comparison_metrics.size() > 1 && study.materials.size() > 2;
}

bool has_agreement_within_families(const Study& study) {
  std::map<std::string_view, int> sizes;
  for (const auto& material : study.materials) ++sizes[material.family()];
  return has_agreement(study) && sizes.size() > 1 &&
         std::ranges::any_of(sizes, [](const auto& entry) { return entry.second > 2; });
}

MetricAgreement metric_agreement(const StudyResult& result) {
  MetricAgreement agreement;
  if (!has_agreement(result.study)) return agreement;
  std::vector<Eigen::MatrixXd> distances;
  for (const auto& metric : result.metrics) {
    agreement.metrics.push_back(metric.lighting.name());
    distances.push_back(metric.combined.distance);
  }
  for (const auto& comparison : result.comparisons) {
    agreement.metrics.emplace_back(to_string(comparison.metric));
    distances.push_back(comparison.combined.distance);
  }
  std::vector<std::string> families;
  for (const auto& material : result.study.materials) families.push_back(material.family());
  agreement.all_pairs = rank_agreement(distances);
  if (has_agreement_within_families(result.study)) {
    agreement.within_families = rank_agreement_within(distances, families);
  }
  return agreement;
}

std::string agreement_csv(const MetricAgreement& agreement) {
  std::string text = "metric,other,spearman,kendall,spearman_within_families,kendall_within_families\n";
  const auto number = [](const Eigen::MatrixXd& matrix, Eigen::Index i, Eigen::Index j) {
    return matrix.size() == 0 || std::isnan(matrix(i, j)) ? std::string() : shortest(matrix(i, j));
  };
  for (std::size_t i = 0; i < agreement.metrics.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const auto row = static_cast<Eigen::Index>(i);
      const auto column = static_cast<Eigen::Index>(j);
      fmt::format_to(std::back_inserter(text), "{},{},{},{},{},{}\n", csv_field(agreement.metrics[i]),
                     csv_field(agreement.metrics[j]), number(agreement.all_pairs.spearman, row, column),
                     number(agreement.all_pairs.kendall, row, column),
                     number(agreement.within_families.spearman, row, column),
                     number(agreement.within_families.kendall, row, column));
    }
  }
  return text;
}

}  // namespace lobe
