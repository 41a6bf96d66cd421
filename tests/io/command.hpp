#pragma once

#include <string>

namespace lobe::test {

struct CommandResult {
  int status = 0;  ///< of the shell: 127 where the program is missing
  std::string output;
};

/// Runs a shell command and collects its standard output.
[[nodiscard]] CommandResult run_command(const std::string& command);

/// True where a program stands in PATH.
[[nodiscard]] bool has_program(const std::string& name);

}  // namespace lobe::test
