#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>

#include "interface/session.hpp"
#include "lobe/study/study.hpp"

namespace lobe::cli {

/// Prints what running a study would take and leave, without running it.
/// \param directory of the results, which need not exist
/// \param existing file of the study that the run would not replace without --force; empty if there is none
/// \param ranks of which the plan is to tell; none: of one process alone
/// \throws as plan_study() and plan_ranks()
void dry_run(Session& session, const Study& study, const std::filesystem::path& directory,
             const std::filesystem::path& existing, std::optional<std::size_t> ranks);

}  // namespace lobe::cli
