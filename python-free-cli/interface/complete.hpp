#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "interface/command.hpp"

namespace lobe::cli {

/// The hidden first word by which the shells' scripts (completions/) ask for completions.
inline constexpr std::string_view kCompleteWord = "__complete";

/// A word that may stand where the cursor is.
struct Candidate {
  std::string word;
  std::string help = {};
};

/// Completions at the cursor.
struct Completion {
  enum class Paths { none, files, directories };
  std::vector<Candidate> candidates = {};
  Paths paths = Paths::none;  ///< paths that the shell adds itself
  std::string ending = {};    ///< ending of the files: ".toml"; empty: any
};

/// Completes a command line by the option tables, the catalogue and the lists of lightings, grids and formats.
/// \param words what stands after `lobe`, the last one, perhaps empty, up to the cursor
[[nodiscard]] Completion complete(std::span<const Command> commands, std::span<const std::string> words);

/// For the scripts: a line "none", "files" or "directories", with the ending behind a tab; then a line for each
/// candidate, with its help behind a tab.
[[nodiscard]] std::string completion_text(const Completion& completion);

}  // namespace lobe::cli
