#pragma once

#include <string>

#include "lobe/study/study.hpp"

namespace lobe {

inline constexpr const char* kStudySchema = "lobe-study/1";

/// The bytes of NAME.h5, schema lobe-study/1 (docs/file-formats.md).
/// \param result a study with named channels, and one metric, embedding and clustering per lighting
/// \param command_line recorded in `history` and /provenance
/// \param created time of writing as ISO 8601 text; with the same results and texts the bytes are the same
[[nodiscard]] std::string study_table(const StudyResult& result, const std::string& command_line,
                                      const std::string& created);

}  // namespace lobe
