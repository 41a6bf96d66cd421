#include "interface/study_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace lobe::cli {
namespace {

/// Families that best represent the materials of other families.
struct BestFamilies {
  std::vector<std::size_t> materials;  ///< that the family represents better than all others, beyond the errors
  std::vector<double> mean;            ///< of the relative residuals that are known
  std::size_t undecided = 0;           ///< materials that two families represent as well within the errors
};

BestFamilies best_families(const FamilyResiduals& residuals, std::span<const StudyMaterial> materials) {
  const std::size_t families = residuals.families.size();
  BestFamilies best{std::vector<std::size_t>(families), std::vector<double>(families)};
  std::vector<std::size_t> known(families);
  for (std::size_t target = 0; target < materials.size(); ++target) {
    const auto at = [&](std::size_t family) {
      const auto row = static_cast<Eigen::Index>(target);
      const auto column = static_cast<Eigen::Index>(family);
      return Estimate{residuals.relative_residual(row, column), residuals.relative_residual_error(row, column)};
    };
    std::vector<std::size_t> others;
    for (std::size_t f = 0; f < families; ++f) {
      if (residuals.families[f] == materials[target].family() || std::isnan(at(f).value)) continue;
      others.push_back(f);
      best.mean[f] += at(f).value;
      ++known[f];
    }
    if (others.empty()) continue;
    const auto nearest = *std::ranges::min_element(others, {}, [&](std::size_t f) { return at(f).value; });
    const double limit = at(nearest).value + at(nearest).error;
    const bool is_clear =
        std::ranges::none_of(others, [&](std::size_t f) { return f != nearest && at(f).value - at(f).error <= limit; });
    ++(is_clear ? best.materials[nearest] : best.undecided);
  }
  for (std::size_t f = 0; f < families; ++f) best.mean[f] /= static_cast<double>(known[f]);
  return best;
}

Json correlations_json(const RankAgreement& agreement, Eigen::Index i, Eigen::Index j) {
  return {{"spearman", to_json(agreement.spearman(i, j))}, {"kendall", to_json(agreement.kendall(i, j))}};
}

}  // namespace

Json clusters_json(const Study& study, const Clustering& clustering) {
  const Medoids& medoids = clustering.medoids;
  Json json{{"count", medoids.medoid.size()},
            {"chosen_by", clustering.candidates.empty() ? "study" : "silhouette"},
            {"mean_silhouette", to_json(clustering.mean_silhouette.value)},
            {"mean_silhouette_error", to_json(clustering.mean_silhouette.error)},
            {"cophenetic_correlation", to_json(clustering.cophenetic_correlation.value)},
            {"cophenetic_correlation_error", to_json(clustering.cophenetic_correlation.error)},
            {"medoids", Json::array()}};
  for (std::size_t k = 0; k < medoids.medoid.size(); ++k) {
    json["medoids"].push_back({{"material", study.materials.at(medoids.medoid[k]).name()},
                               {"materials", std::ranges::count(medoids.cluster, k)}});
  }
  return json;
}

/// A line per lighting: the materials that stand for all, with the sizes of their clusters.
std::string medoid_lines(const StudyResult& result) {
  std::string text;
  for (std::size_t i = 0; i < result.metrics.size(); ++i) {
    const Clustering& clustering = result.clusterings.at(i);
    const Medoids& medoids = clustering.medoids;
    std::vector<std::string> names;
    for (std::size_t k = 0; k < medoids.medoid.size(); ++k) {
      names.push_back(fmt::format("{} ({})", result.study.materials.at(medoids.medoid[k]).name(),
                                  std::ranges::count(medoids.cluster, k)));
    }
    text += fmt::format("{}: {} clusters{}, mean silhouette {:.3f} ± {:.1g}; medoids: {}\n",
                        result.metrics[i].lighting.name(), medoids.medoid.size(),
                        clustering.candidates.empty() ? "" : " by silhouette", clustering.mean_silhouette.value,
                        clustering.mean_silhouette.error, fmt::join(names, ", "));
  }
  return text;
}

Json unresolved_json(const Study& study, std::span<const Unresolved> unresolved) {
  Json json = Json::array();
  for (const auto& pair : unresolved) {
    json.push_back({{"first", study.materials.at(pair.first).name()},
                    {"second", study.materials.at(pair.second).name()},
                    {"relative_error", to_json(pair.relative_error)}});
  }
  return json;
}

Json approximations_json(const StudyResult& result, std::size_t lighting) {
  const auto& fits = result.study.approximations;
  Json json = Json::array();
  for (std::size_t k = 0; k < fits.size(); ++k) {
    const FamilyResiduals& residuals = result.residuals.at(lighting * fits.size() + k);
    const BestFamilies best = best_families(residuals, result.study.materials);
    Json families = Json::array();
    for (std::size_t f = 0; f < residuals.families.size(); ++f) {
      families.push_back({{"family", residuals.families[f]},
                          {"materials", best.materials[f]},
                          {"mean_relative_residual", to_json(best.mean[f])}});
    }
    json.push_back(
        {{"approximation", to_string(fits[k])}, {"families", std::move(families)}, {"undecided", best.undecided}});
  }
  return json;
}

std::string approximation_lines(const StudyResult& result) {
  const auto& fits = result.study.approximations;
  std::string text;
  for (std::size_t i = 0; i < result.residuals.size(); ++i) {
    const FamilyResiduals& residuals = result.residuals[i];
    const BestFamilies best = best_families(residuals, result.study.materials);
    std::vector<std::string> shares;
    for (std::size_t f = 0; f < residuals.families.size(); ++f) {
      shares.push_back(fmt::format("{} {}", residuals.families[f], best.materials[f]));
    }
    text += fmt::format("{}: materials of other families best represented ({}) by {}, undecided {}\n",
                        residuals.lighting.name(), to_string(fits[i % fits.size()]), fmt::join(shares, ", "),
                        best.undecided);
  }
  return text;
}

Json comparisons_json(const StudyResult& result) {
  Json json = Json::array();
  for (const auto& comparison : result.comparisons) {
    json.push_back({{"metric", to_string(comparison.metric)},
                    {"origin", to_string(result.study.origins.comparison_metrics.at(json.size()))},
                    {"tolerance", result.study.comparison_tolerance},
                    {"nodes", comparison.work.nodes},
                    {"evaluations", comparison.work.evaluations},
                    {"unresolved", unresolved_json(result.study, comparison.unresolved)}});
  }
  return json;
}

Json agreement_json(const MetricAgreement& agreement) {
  Json json = Json::array();
  for (std::size_t i = 0; i < agreement.metrics.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const auto row = static_cast<Eigen::Index>(i);
      const auto column = static_cast<Eigen::Index>(j);
      Json entry{{"metric", agreement.metrics[i]},
                 {"other", agreement.metrics[j]},
                 {"all_pairs", correlations_json(agreement.all_pairs, row, column)}};
      if (agreement.within_families.spearman.size() > 0) {
        entry["within_families"] = correlations_json(agreement.within_families, row, column);
      }
      json.push_back(std::move(entry));
    }
  }
  return json;
}

std::string agreement_lines(const MetricAgreement& agreement) {
  std::string text;
  const auto& rho = agreement.all_pairs.spearman;
  for (Eigen::Index i = 0; i < rho.rows(); ++i) {
    Eigen::Index nearest = -1;
    for (Eigen::Index j = 0; j < rho.cols(); ++j) {
      if (j == i || std::isnan(rho(i, j))) continue;
      if (nearest < 0 || rho(i, j) > rho(i, nearest)) nearest = j;
    }
    if (nearest < 0) continue;
    text += fmt::format("{}: ranks pairs most as {} does, Spearman {:.3f}, Kendall {:.3f}\n",
                        agreement.metrics[static_cast<std::size_t>(i)],
                        agreement.metrics[static_cast<std::size_t>(nearest)], rho(i, nearest),
                        agreement.all_pairs.kendall(i, nearest));
  }
  return text;
}

Json published_json(const StudyResult& result) {
  Json json = Json::array();
  for (std::size_t i = 0; i < result.published.size(); ++i) {
    const PublishedFigure& figure = result.study.published[i];
    const PublishedCheck& check = result.published[i];
    json.push_back({{"table", figure.table},
                    {"figure", figure.label},
                    {"origin", to_string(result.study.origins.published.at(i))},
                    {"printed", figure.printed},
                    {"corrected", figure.corrected},
                    {"value", to_json(check.value)},
                    {"deviation", to_json(check.deviation)},
                    {"agrees", check.agrees},
                    {"as_expected", check.is_as_expected}});
  }
  return json;
}

std::string published_lines(const StudyResult& result) {
  if (result.published.empty()) return "";
  const auto& checks = result.published;
  std::string text =
      fmt::format("published figures: {} of {} agree with the values computed, {} of {} are as expected\n",
                  std::ranges::count_if(checks, &PublishedCheck::agrees), checks.size(),
                  std::ranges::count_if(checks, &PublishedCheck::is_as_expected), checks.size());
  for (std::size_t i = 0; i < checks.size(); ++i) {
    if (checks[i].is_as_expected) continue;
    const PublishedFigure& figure = result.study.published[i];
    text += fmt::format("missed: {}, {}: printed {}{}, computed {}\n", figure.table, figure.label, figure.printed,
                        figure.corrected.empty() ? "" : ", corrected " + figure.corrected,
                        format_estimate(checks[i].value));
  }
  return text;
}

}  // namespace lobe::cli
