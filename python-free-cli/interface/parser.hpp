#pragma once

#include <span>
#include <string>
#include <vector>

#include "interface/command.hpp"

namespace lobe::cli {

/// A command line taken apart.
struct Invocation {
  const Command* command = nullptr;  ///< none: `lobe` itself, with --help or --version
  Arguments arguments;
};

/// Takes a command line apart by the option tables. With --help or --version among the arguments nothing is missed and
/// nothing else is checked.
/// \param words the arguments after the program's name
/// \throws ArgumentError for anything that the tables do not allow, with the nearest word that they do.
[[nodiscard]] Invocation parse(std::span<const Command> commands, const std::vector<std::string>& words);

}  // namespace lobe::cli
