#pragma once

#include <filesystem>

#include "lobe/study/study.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// Whether a file holds results of `lobe run`, of this version or another.
/// \throws IoError for a file whose bytes have changed since it was written
[[nodiscard]] bool is_study_results(const std::filesystem::path& path);

/// Reads the results that `lobe run` wrote as NAME.h5 (docs/file-formats.md): everything that the file holds. Written
/// again, they give the same file. The file does not hold stages, missed tolerances, costs of medoids, how published
/// figures are computed, and how charts are drawn. Materials from files, and formulas with models that this version
/// does not know, have no terms. Parts of studies have no origins unless the file states all of them.
/// \throws IoError "cannot read FILE: ..." for files that hold no such results, are of a newer version, or damaged
[[nodiscard]] StudyResult load_study_results(const std::filesystem::path& path);

/// Reads results as load_study_results() does, but only the study, its provenance and the device, none of the numbers.
/// \throws IoError as load_study_results()
[[nodiscard]] StudyResult load_study_summary(const std::filesystem::path& path);

}  // namespace lobe
