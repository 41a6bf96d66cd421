#pragma once

#include <span>
#include <string>

#include "command.hpp"

namespace lobe::cli {

/// The text of `lobe --help`.
[[nodiscard]] std::string help_text(std::span<const Command> commands);

/// The text of `lobe COMMAND --help`; ends with examples that can be copied.
[[nodiscard]] std::string help_text(const Command& command);

/// The text of `lobe --version`.
[[nodiscard]] std::string version_text();

}  // namespace lobe::cli
