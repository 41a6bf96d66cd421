#pragma once

#include <string>

#include "lobe/study.hpp"

namespace lobe {

/// The bytes of NAME.h5, schema lobe-study/1 (docs/file-formats.md).
/// \param result a study with named channels, and one metric and one embedding per lighting
/// \param command_line recorded in `history` and /provenance
/// \param created time of writing as ISO 8601 text; with the same results and texts the bytes are the same
[[nodiscard]] std::string study_table(const StudyResult& result, const std::string& command_line,
                                      const std::string& created);

/// Now, or what SOURCE_DATE_EPOCH says (reproducible-builds.org), as ISO 8601 text in UTC.
/// \throws ArgumentError when that variable is no whole number of seconds.
[[nodiscard]] std::string time_of_writing();

}  // namespace lobe
