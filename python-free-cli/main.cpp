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

#include "help.hpp"
#include "lobe/error.hpp"
#include "parser.hpp"
#include "session.hpp"
#include "terminal.hpp"

namespace lobe::cli {
namespace {

/// What went wrong, and with what exit status that ends.
struct Failure {
  ExitCode code;
  std::string message;
  std::string advice;  ///< added where the message gives none itself
  std::string build_log;
};

std::string file_advice(std::string_view message) {
  struct Advice {
    std::string_view cause;
    std::string_view text;
  };
  constexpr std::array kAdvice{Advice{"No such file", "check the spelling of the path"},
                               Advice{": line ", "mend the file, or take another one"},
                               Advice{": byte ", "mend the file, or take another one"},
                               Advice{"no known format", "'lobe import --help' names those that are read"},
                               Advice{"HDF5", "give a table that lobe has written"},
                               Advice{"directory", "give the path of a file"},
                               Advice{"Permission denied", "check the permissions"},
                               Advice{"Read-only", "choose another place"},
                               Advice{"No space", "free some space on the disk"},
                               Advice{"too large", "raise the limit on file sizes (ulimit -f)"}};
  const auto* found = std::ranges::find_if(
      kAdvice, [&](const Advice& advice) { return message.find(advice.cause) != std::string_view::npos; });
  return std::string(found == kAdvice.end() ? "check the path and its permissions" : found->text);
}

Failure describe_current_exception() {
  try {
    throw;
  } catch (const ArgumentError& error) {
    return {ExitCode::usage, error.what(), "see 'lobe --help'", {}};
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
  while (!text.empty() && (text.back() == '\n' || text.back() == '.' || text.back() == ' ')) text.pop_back();
  for (char& c : text) {
    if (c == '\n' || c == '\r' || c == '\t') c = ' ';
  }
  return text;
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

std::string quoted_for_shell(const std::string& word) {
  constexpr std::string_view kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=:,./@%";
  if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

ExitCode run_words(const std::vector<std::string>& words) {
  Invocation invocation;
  try {
    invocation = parse(commands(), words);
    const auto& arguments = invocation.arguments;
    if (arguments.has("help")) {
      write_output(invocation.command == nullptr ? help_text(commands()) : help_text(*invocation.command));
      return ExitCode::success;
    }
    if (arguments.has("version")) {
      write_output(version_text());
      return ExitCode::success;
    }
    std::string command_line = "lobe";
    for (const auto& word : words) command_line += " " + quoted_for_shell(word);
    Session session(arguments, std::move(command_line));
    const ExitCode code = invocation.command->execute(session);
    session.end_progress();
    write_output(session.output());
    return code;
  } catch (const Cancelled&) {
    write_error("lobe: interrupted; nothing was written\n");
    end_by_caught_signal();
  } catch (...) {
    return report(describe_current_exception(), invocation.arguments.has("verbose"),
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
  return static_cast<int>(lobe::cli::run_words({argv + 1, argv + argc}));
}
