#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "interface/report.hpp"
#include "lobe/study/study.hpp"

namespace lobe::cli {

/// Report of `lobe run` on results, as text and as JSON. Lines are complete; none where the study asks for none.

[[nodiscard]] Json clusters_json(const Study& study, const Clustering& clustering);
/// A line per lighting: the materials that stand for all, with the sizes of their clusters.
[[nodiscard]] std::string medoid_lines(const StudyResult& result);

[[nodiscard]] Json unresolved_json(const Study& study, std::span<const Unresolved> unresolved);

/// How well families represent the materials of other families under a lighting, per kind of approximation.
[[nodiscard]] Json approximations_json(const StudyResult& result, std::size_t lighting);
/// A line per lighting and kind: how many materials of other families each family represents best.
[[nodiscard]] std::string approximation_lines(const StudyResult& result);

[[nodiscard]] Json comparisons_json(const StudyResult& result);
[[nodiscard]] Json agreement_json(const MetricAgreement& agreement);
/// A line per metric: which other one ranks pairs most as it does.
[[nodiscard]] std::string agreement_lines(const MetricAgreement& agreement);

[[nodiscard]] Json published_json(const StudyResult& result);
/// How many published figures agree, and a line for each that is not what the study expects.
[[nodiscard]] std::string published_lines(const StudyResult& result);

}  // namespace lobe::cli
