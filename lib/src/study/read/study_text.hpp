#pragma once

#include <string>

#include "study/read/study_sources.hpp"

namespace lobe {

/// A study file that says by itself what a study's files and overrides say together. What it has of files stays
/// outside.
/// \param name stem of the output files, which else is that of the file
[[nodiscard]] std::string study_text(const StudySources& sources, const std::string& name);

}  // namespace lobe
