#pragma once

#include <filesystem>

#include "interface/session.hpp"
#include "lobe/study/study.hpp"

namespace lobe::cli {

/// Prints what running a study would take and leave, without running it.
/// \param directory of the results, which need not exist
/// \param existing file of the study that the run would not replace without --force; empty if there is none
/// \throws as plan_study()
void dry_run(Session& session, const Study& study, const std::filesystem::path& directory,
             const std::filesystem::path& existing);

}  // namespace lobe::cli
