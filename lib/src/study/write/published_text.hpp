#pragma once

#include <string>

#include "lobe/study/study.hpp"

namespace lobe {

/// Published figures beside their values: table, figure, printed, corrected, value, error, deviation, agrees, expected.
[[nodiscard]] std::string published_csv(const StudyResult& result);

/// Writes published figures as a page for people (Markdown): a table per title, with the result for each printed
/// figure.
[[nodiscard]] std::string published_page(const StudyResult& result);

}  // namespace lobe
