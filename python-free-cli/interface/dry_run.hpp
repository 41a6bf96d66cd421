#pragma once

#include <filesystem>

#include "interface/session.hpp"
#include "lobe/study/study.hpp"

namespace lobe::cli {

/// Prints what running a study would take and leave, without running it.
/// \param directory of the results, which need not exist
/// \throws as plan_study()
void dry_run(Session& session, const Study& study, const std::filesystem::path& directory);

}  // namespace lobe::cli
