#pragma once

#include <string>

#include "lobe/study/study.hpp"

namespace lobe {

/// Whether there is anything to agree on: two metrics or more, and more than one pair of materials.
[[nodiscard]] bool has_agreement(const Study& study);

/// Whether there is, within families: several of them, of which one has more than one pair.
[[nodiscard]] bool has_agreement_within_families(const Study& study);

/// Rank correlations between all metrics of a result, by their combined distances; empty without has_agreement().
[[nodiscard]] MetricAgreement metric_agreement(const StudyResult& result);

/// NAME.agreement.csv: a line per pair of metrics.
[[nodiscard]] std::string agreement_csv(const MetricAgreement& agreement);

}  // namespace lobe
