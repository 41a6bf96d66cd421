// The `lobe` command: takes the command line apart, runs one command, and turns what is thrown into one line and an
// exit status.
#include <dlfcn.h>
#include <unistd.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <algorithm>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include "core/text.hpp"
#include "interface/complete.hpp"
#include "interface/failure.hpp"
#include "interface/help.hpp"
#include "interface/last_words.hpp"
#include "interface/options.hpp"
#include "interface/output_file.hpp"
#include "interface/parser.hpp"
#include "interface/ranks.hpp"
#include "interface/reading.hpp"
#include "interface/session.hpp"
#include "interface/terminal.hpp"
#include "lobe/core/error.hpp"

namespace lobe::cli {
namespace {

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

/// OpenBLAS, which the solver of linear programs may bring along, begins threads when it is loaded, and they keep their
/// processors busy for a tenth of a second, most of what a short command takes. It begins them anew where it needs
/// them.
void end_idle_threads_of_blas() {
  using Shutdown = int (*)();
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): what dlsym() returns
  const auto shutdown = reinterpret_cast<Shutdown>(::dlsym(RTLD_DEFAULT, "blas_thread_shutdown_"));
  if (shutdown != nullptr) shutdown();
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
  std::string line = failure.line;
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
  for (const Text& written : {option::output, option::plot}) {
    if (!arguments.is_given(written)) continue;
    directories.emplace_back(arguments.text(written));
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
    if (arguments.has(option::help)) {
      write_output(invocation.command == nullptr ? overview(commands())
                                                 : terminal_text(command_page(*invocation.command)));
      return ExitCode::success;
    }
    if (arguments.has(option::version)) {
      write_output(version_text());
      return ExitCode::success;
    }
    require_file(*invocation.command, arguments);
    Session session(arguments, words);
    const InterruptWatch watch(written_directories(arguments));
    const ExitCode code = invocation.command->execute(session);
    session.end_progress();
    session.warn_of_missed();
    session.warn_of_memory();
    if (!takes_standard_output(arguments)) {
      write_output(session.output());
    } else if (!arguments.has(option::quiet)) {
      write_error(session.output());
    }
    session.report_stages();
    return code;
  } catch (const Cancelled&) {
    end_interrupted();
  } catch (...) {
    // Whatever fails from then on may do so because of the signal.
    if (InterruptWatch::interrupted()) end_interrupted();
    return report(describe_current_exception(invocation.command), invocation.arguments.has(option::verbose),
                  invocation.arguments.text(option::color));
  }
}

}  // namespace
}  // namespace lobe::cli

int main(int argc, char** argv) {
#ifdef __GLIBC__
  // Freed tables go back to the system, so that the memory stated is the memory taken.
  mallopt(M_MMAP_THRESHOLD, 4 << 20);
#endif
  lobe::cli::end_idle_threads_of_blas();
  lobe::cli::prepare_streams();
  lobe::cli::prepare_last_words();
  const std::vector<std::string> words(argv + 1, argv + argc);
  if (lobe::cli::is_silent_rank(words)) lobe::cli::be_silent();
  const auto status = static_cast<int>(lobe::cli::run_words(words));
  lobe::cli::leave(status);
  if (lobe::cli::leaves_threads_behind()) {
    lobe::cli::Session::let_go();
    lobe::cli::end_at_once();
  }
  return status;
}
