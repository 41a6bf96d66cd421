#pragma once

#include <string>

#include "lobe/study/study.hpp"

namespace lobe {

/// Published figures beside their values: table, figure, printed, corrected, value, error, deviation, agrees, expected.
[[nodiscard]] std::string published_csv(const StudyResult& result);

/// The same as a page for people (Markdown): a table per title, with what it says of each printed figure.
[[nodiscard]] std::string published_page(const StudyResult& result);

}  // namespace lobe
