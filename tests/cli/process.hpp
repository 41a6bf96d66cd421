#pragma once

#include <chrono>
#include <csignal>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace lobe::test {

/// How a process is started, besides its words.
struct Surroundings {
  std::filesystem::path directory = {};                               ///< empty: the test's own
  std::vector<std::pair<std::string, std::string>> environment = {};  ///< set on top of the test's own
  std::filesystem::path output = {};                     ///< where its standard output goes; empty: captured
  std::optional<unsigned long> largest_file_bytes = {};  ///< a limit on what it writes into one file
  std::chrono::milliseconds interrupt_after = {};        ///< when it gets `signal`; zero: never
  std::filesystem::path interrupt_when = {};             ///< instead: as soon as this file is there
  int signal = SIGINT;
  bool on_terminal = false;  ///< its standard error is a terminal
};

/// How a process ended and what it said.
struct Outcome {
  int status = -1;  ///< exit status; 128 + the signal's number when a signal ended it, as shells have it
  std::string output;
  std::string error;
  std::chrono::milliseconds after_signal = {};  ///< from the signal to the end
};

/// Runs a program by its path, with arguments.
[[nodiscard]] Outcome run_program(const std::vector<std::string>& words, const Surroundings& surroundings = {});

/// Runs `lobe` with these arguments.
[[nodiscard]] Outcome run_lobe(const std::vector<std::string>& arguments, const Surroundings& surroundings = {});

/// Runs a line by a shell that finds `lobe`.
[[nodiscard]] Outcome run_line(const std::string& line, const Surroundings& surroundings = {});

}  // namespace lobe::test
