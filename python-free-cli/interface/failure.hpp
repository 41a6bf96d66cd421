#pragma once

#include <string>

#include "interface/command.hpp"
#include "interface/exit_code.hpp"

namespace lobe::cli {

/// What went wrong, and with what exit status that ends.
struct Failure {
  ExitCode code;
  std::string line;  ///< for people: the problem, and what can be done
  std::string build_log = {};
};

/// Describes the exception that is being handled. What the library says is taken as it is; this is the one place that
/// adds what only the command knows: its options, and where to read on.
/// \param command that failed; null: `lobe` itself
[[nodiscard]] Failure describe_current_exception(const Command* command);

}  // namespace lobe::cli
