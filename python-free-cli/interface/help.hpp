#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "interface/command.hpp"
#include "interface/page.hpp"

namespace lobe::cli {

/// The text of `lobe --help`, which fits one screen: commands by purpose and where to read on.
[[nodiscard]] std::string overview(std::span<const Command> commands);

/// The manual page lobe(1): the overview, and what all commands share.
[[nodiscard]] Page lobe_page(std::span<const Command> commands);

/// The text of `lobe COMMAND --help`, and the manual page of the command.
[[nodiscard]] Page command_page(const Command& command);

/// A manual page and the name of its file.
struct ManualPage {
  std::string file;  ///< "lobe-run.1"
  std::string text;
};

/// lobe(1), one of each command and of each topic.
[[nodiscard]] std::vector<ManualPage> manual(std::span<const Command> commands);

/// The text of `lobe --version`.
[[nodiscard]] std::string version_text();

}  // namespace lobe::cli
