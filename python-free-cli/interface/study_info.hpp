#pragma once

#include <filesystem>

#include "interface/session.hpp"

namespace lobe::cli {

/// Prints what `lobe run` left: what was computed, by what, and where in the study's files it stands; with --study a
/// study file that says all of it.
ExitCode describe_study(Session& session, const std::filesystem::path& path);

}  // namespace lobe::cli
