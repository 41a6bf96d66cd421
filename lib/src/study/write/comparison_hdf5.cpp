#include "study/write/comparison_hdf5.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "study/write/origin_text.hpp"
#include "study/write/unresolved_hdf5.hpp"

namespace lobe {
namespace {

struct LiteratureQuantity {
  std::string name;
  std::string long_name;
  bool is_pairwise = false;
  bool has_error = false;  ///< in NAME_error
  Eigen::MatrixXd (*values)(const LiteratureMatrix&);
};

const std::array<LiteratureQuantity, 4>& literature_quantities() {
  static const std::array<LiteratureQuantity, 4> list = {{
      {"distance", "distances", true, true, [](const LiteratureMatrix& m) { return m.distance; }},
      {"distance_error", "error estimates of the distances", true, false,
       [](const LiteratureMatrix& m) { return m.distance_error; }},
      {"size", "distances from black", false, true, [](const LiteratureMatrix& m) { return Eigen::MatrixXd(m.size); }},
      {"size_error", "error estimates of the distances from black", false, false,
       [](const LiteratureMatrix& m) { return Eigen::MatrixXd(m.size_error); }},
  }};
  return list;
}

void append(std::vector<double>& values, const Eigen::MatrixXd& matrix) {
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) values.push_back(matrix(i, j));
  }
}

void write_matrices(hid_t group, LiteratureMetric comparison, std::span<const LiteratureMatrix> matrices,
                    const ComparisonAxes& axes, bool by_channel) {
  const std::string suffix = by_channel ? "_by_channel" : "";
  const std::string_view unit = unit_of(comparison).empty() ? "1" : unit_of(comparison);
  for (const auto& quantity : literature_quantities()) {
    std::vector<double> values;
    for (const auto& matrix : matrices) append(values, quantity.values(matrix));
    std::vector<const hdf5::Dataset*> along;
    if (by_channel) along.push_back(&axes.channel);
    along.push_back(&axes.material);
    if (quantity.is_pairwise) along.push_back(&axes.material_other);
    const auto dataset = hdf5::create_dataset(group, quantity.name + suffix, values, along);
    hdf5::write_attributes(dataset.id(),
                           {{"long_name", quantity.long_name + " by " + std::string(to_string(comparison)) +
                                              (by_channel ? ", each channel by itself" : "")},
                            {"units", unit}});
    if (quantity.has_error) {
      hdf5::write_attribute(dataset.id(), "ancillary_variables", quantity.name + "_error" + suffix);
    }
  }
}

void write_correlations(hid_t group, const std::string& suffix, const std::string& pairs,
                        const RankAgreement& agreement, std::span<const hdf5::Dataset* const> along) {
  const auto write = [&](const std::string& name, const std::string& meaning, const Eigen::MatrixXd& matrix) {
    std::vector<double> values;
    append(values, matrix);
    const auto dataset = hdf5::create_dataset(group, name + suffix, values, along);
    hdf5::write_attributes(dataset.id(), {{"long_name", meaning + " of the distances of " + pairs}, {"units", "1"}});
  };
  write("spearman", "Spearman's rho", agreement.spearman);
  write("kendall", "Kendall's tau-b", agreement.kendall);
}

}  // namespace

void write_comparisons(hid_t root, const StudyResult& result, const ComparisonAxes& axes) {
  if (result.comparisons.empty()) return;
  const auto comparisons = hdf5::create_group(root, "comparison");
  hdf5::write_attribute(comparisons.id(), "comment", "distances as other publications define them");
  for (std::size_t i = 0; i < result.comparisons.size(); ++i) {
    const auto& comparison = result.comparisons[i];
    const auto group = hdf5::create_group(comparisons.id(), std::string(to_string(comparison.metric)));
    if (const auto origin = origin_text(result.study.origins.comparison_metrics, i); !origin.empty()) {
      hdf5::write_attribute(group.id(), "origin", origin);
    }
    hdf5::write_attribute(group.id(), "nodes", static_cast<std::int64_t>(comparison.work.nodes));
    hdf5::write_attribute(group.id(), "evaluations", static_cast<std::int64_t>(comparison.work.evaluations));
    write_matrices(group.id(), comparison.metric, {&comparison.combined, 1}, axes, false);
    if (comparison.channels.size() > 1) {
      write_matrices(group.id(), comparison.metric, comparison.channels, axes, true);
    }
    write_unresolved(group.id(), comparison.unresolved, labels(result.study), "distance");
  }
}

void write_agreement(hid_t root, const MetricAgreement& agreement) {
  if (agreement.metrics.empty()) return;
  const auto group = hdf5::create_group(root, "agreement");
  hdf5::write_attribute(group.id(), "comment", "how alike metrics rank pairs of materials by their distances");
  const auto metric = hdf5::create_text_axis(group.id(), "metric", agreement.metrics);
  hdf5::write_attribute(metric.id(), "long_name", "lighting or comparison metric");
  const auto other = hdf5::create_text_axis(group.id(), "metric_other", agreement.metrics);
  hdf5::write_attribute(other.id(), "long_name", "the other metric");
  const hdf5::Dataset* const along[] = {&metric, &other};
  write_correlations(group.id(), "", "all pairs of materials", agreement.all_pairs, along);
  if (agreement.within_families.spearman.size() == 0) return;
  write_correlations(group.id(), "_within_families", "the pairs within each family, mean over families",
                     agreement.within_families, along);
}

}  // namespace lobe
