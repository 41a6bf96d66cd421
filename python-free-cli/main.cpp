// The `lobe` command: takes the command line apart, runs one command, and turns what is thrown into one line and an
// exit status.
#include <unistd.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <algorithm>
#include <array>
#include <exception>
#include <filesystem>
#include <new>
#include <string>
#include <vector>

#include "core/shell.hpp"
#include "core/text.hpp"
#include "interface/complete.hpp"
#include "interface/help.hpp"
#include "interface/last_words.hpp"
#include "interface/output_file.hpp"
#include "interface/parser.hpp"
#include "interface/reading.hpp"
#include "interface/session.hpp"
#include "interface/terminal.hpp"
#include "lobe/core/error.hpp"

namespace lobe::cli {
namespace {

/// A failure, and the exit status for it.
struct Failure {
  ExitCode code;
  std::string message;
  std::string advice;  ///< added where the message gives none itself
  std::string build_log;
};

/// The file in the same folder whose name is nearest to that of a missing one; empty where none is near.
std::string nearest_file(const std::filesystem::path& missing) {
  std::error_code code;
  const auto folder = missing.has_parent_path() ? missing.parent_path() : std::filesystem::path(".");
  std::vector<std::string> names;
  for (std::filesystem::directory_iterator at(folder, code), end; !code && at != end; at.increment(code)) {
    names.push_back(at->path().filename().string());
  }
  const std::vector<std::string_view> candidates(names.begin(), names.end());
  const std::string near = nearest_word(missing.filename().string(), candidates);
  return near.empty() ? near : (missing.parent_path() / near).string();
}

std::string missing_file_advice(std::string_view message) {
  constexpr std::string_view kBefore = "cannot read ";
  if (message.starts_with(kBefore)) {
    const auto end = message.find(": ");
    const std::string near = nearest_file(message.substr(kBefore.size(), end - kBefore.size()));
    if (!near.empty()) return "did you mean '" + near + "'?";
  }
  return "check the spelling of the path";
}

std::string file_advice(std::string_view message) {
  if (message.find("o such file") != std::string_view::npos) return missing_file_advice(message);
  struct Advice {
    std::string_view cause;
    std::string_view text;
  };
  constexpr std::array kAdvice{Advice{": line ", "mend the file, or take another one"},
                               Advice{": byte ", "mend the file, or take another one"},
                               Advice{"no known format", "'lobe import --help' names those that are read"},
                               Advice{"HDF5", "give a file that lobe has written"},
                               Advice{"directory", "give the path of a file"},
                               Advice{"Permission denied", "check the permissions"},
                               Advice{"Read-only", "choose another place"},
                               Advice{"No space", "free some space on the disk"},
                               Advice{"too large", "raise the limit on file sizes (ulimit -f)"}};
  const auto* found = std::ranges::find_if(
      kAdvice, [&](const Advice& advice) { return message.find(advice.cause) != std::string_view::npos; });
  return std::string(found == kAdvice.end() ? "check the path and its permissions" : found->text);
}

/// Where to read on about a mistake that is explained no further.
std::string usage_advice(std::string_view message, const Command* command) {
  if (message.find(".toml:") != std::string_view::npos) return "see 'lobe help studies'";
  if (message.find("material") != std::string_view::npos || message.find("model") != std::string_view::npos) {
    return "see 'lobe help materials'";
  }
  return command == nullptr ? "see 'lobe --help'" : "see 'lobe " + std::string(command->name) + " --help'";
}

Failure describe_current_exception(const Command* command) {
  try {
    throw;
  } catch (const ArgumentError& error) {
    return {ExitCode::usage, error.what(), usage_advice(error.what(), command), {}};
  } catch (const IoError& error) {
    return {ExitCode::file, error.what(), file_advice(error.what()), {}};
  } catch (const DeviceError& error) {
    return {ExitCode::device, error.what(), "'lobe devices' lists what there is", error.build_log()};
  } catch (const NumericError& error) {
    return {ExitCode::numeric, error.what(), "check the parameters of the material", {}};
  } catch (const std::filesystem::filesystem_error& error) {
    return {ExitCode::file,
            error.path1().string() + ": " + error.code().message(),
            file_advice(error.code().message()),
            {}};
  } catch (const std::bad_alloc&) {
    return {ExitCode::numeric, "out of memory", "use a smaller grid, fewer materials or a larger --tolerance", {}};
  } catch (const std::exception& error) {
    return {ExitCode::numeric, std::string("internal error: ") + error.what(), "please report this", {}};
  }
}

std::string on_one_line(std::string text) {
  const auto ends = [&](std::string_view end) { return text.ends_with(end) && !text.ends_with(",..."); };
  while (ends("\n") || ends(".") || ends(" ")) text.pop_back();
  for (char& c : text) {
    if (c == '\n' || c == '\r' || c == '\t') c = ' ';
  }
  return printable(text);
}

/// Words come into messages, tables and pictures. Values of studies may have several lines.
void require_plain(const std::vector<std::string>& words) {
  bool is_value = false;
  for (const auto& word : words) {
    std::string letters = word;
    if (is_value || word.starts_with("--set=")) {
      std::erase_if(letters, [](char c) { return c == '\n' || c == '\r' || c == '\t'; });
    }
    if (has_control_characters(letters)) {
      throw ArgumentError("'" + printable(word) + "' has control characters; expected a word or a file name without");
    }
    is_value = word == "--set";
  }
}

/// \return the file's path; empty when it could not be written
std::string save_build_log(const std::string& log) {
  std::error_code code;
  const auto directory = std::filesystem::temp_directory_path(code);
  if (code) return {};
  std::string path = (directory / "lobe-build-log-XXXXXX").string();
  const int descriptor = ::mkstemp(path.data());
  if (descriptor < 0) return {};
  const bool is_complete = ::write(descriptor, log.data(), log.size()) == static_cast<ssize_t>(log.size());
  ::close(descriptor);
  return is_complete ? path : std::string();
}

ExitCode report(const Failure& failure, bool is_verbose, std::string_view color) {
  std::string line = on_one_line(failure.message);
  if (line.find("; ") == std::string::npos) line += "; " + failure.advice;
  if (!failure.build_log.empty()) {
    const std::string path = save_build_log(failure.build_log);
    if (!path.empty()) line += "; the compiler's log is in " + path;
  }
  write_error("lobe: " + bold("error:", uses_color(Stream::error, color)) + " " + line + "\n");
  if (is_verbose && !failure.build_log.empty()) write_error(failure.build_log + "\n");
  return failure.code;
}

[[noreturn]] void end_interrupted() {
  const std::string said = InterruptWatch::noted();
  write_error("lobe: interrupted; " + (said.empty() ? "nothing was written" : said) + "\n");
  end_by_caught_signal();
}

/// Where a command may be writing files.
std::vector<std::filesystem::path> written_directories(const Arguments& arguments) {
  std::vector<std::filesystem::path> directories{"."};
  for (const auto* option : {"output", "plot"}) {
    if (!arguments.has(option)) continue;
    directories.emplace_back(arguments.text(option));
    directories.push_back(directories.back().parent_path());
  }
  return directories;
}

ExitCode run_words(const std::vector<std::string>& words) {
  Invocation invocation;
  try {
    if (!words.empty() && words.front() == kCompleteWord) {
      write_output(completion_text(complete(commands(), std::span(words).subspan(1))));
      return ExitCode::success;
    }
    require_plain(words);
    invocation = parse(commands(), words);
    const auto& arguments = invocation.arguments;
    if (arguments.has("help")) {
      write_output(invocation.command == nullptr ? overview(commands())
                                                 : terminal_text(command_page(*invocation.command)));
      return ExitCode::success;
    }
    if (arguments.has("version")) {
      write_output(version_text());
      return ExitCode::success;
    }
    std::string command_line = "lobe";
    for (const auto& word : words) command_line += " " + shell_word(word);
    require_file(*invocation.command, arguments);
    Session session(arguments, std::move(command_line));
    const InterruptWatch watch(written_directories(arguments));
    const ExitCode code = invocation.command->execute(session);
    session.end_progress();
    session.warn_of_missed();
    if (!takes_standard_output(arguments)) {
      write_output(session.output());
    } else if (!arguments.has("quiet")) {
      write_error(session.output());
    }
    session.report_stages();
    return code;
  } catch (const Cancelled&) {
    end_interrupted();
  } catch (...) {
    // Whatever fails from then on may do so because of the signal.
    if (InterruptWatch::interrupted()) end_interrupted();
    return report(describe_current_exception(invocation.command), invocation.arguments.has("verbose"),
                  invocation.arguments.text("color"));
  }
}

}  // namespace
}  // namespace lobe::cli

int main(int argc, char** argv) {
#ifdef __GLIBC__
  // Freed tables go back to the system, so that the memory stated is the memory taken.
  mallopt(M_MMAP_THRESHOLD, 4 << 20);
#endif
  lobe::cli::prepare_streams();
  lobe::cli::prepare_last_words();
  const auto status = static_cast<int>(lobe::cli::run_words({argv + 1, argv + argc}));
  lobe::cli::leave(status);
  return status;
}
