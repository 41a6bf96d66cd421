#pragma once

#include <string>

#include "study/read/study_sources.hpp"

namespace lobe {

/// Changes a value of a study.
/// \param text "KEY=VALUE": keys with dots between, quoted where they have dots themselves: study.tolerance,
///   family.Ward.m, material."a.b".terms.1.scale; entries of lists by their place, from 0. VALUE is TOML; a text needs
///   no quotes where it is nothing else.
/// \throws ArgumentError "--set TEXT: ..." for a key that means nothing, and for what is no value; complaints about the
///   value itself come from reading the study.
void apply_override(StudySources& sources, const std::string& text);

}  // namespace lobe
