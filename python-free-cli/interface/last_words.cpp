#include "interface/last_words.hpp"

#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>

#include "interface/exit_code.hpp"

namespace lobe::cli {
namespace {

std::atomic<int> is_leaving = 0;
std::atomic<int> end_status = 0;
std::atomic<bool> has_threads_left = false;

void say(const char* text) {
  [[maybe_unused]] const auto written = ::write(STDERR_FILENO, text, std::strlen(text));
}

void end_as_device() {
  if (is_leaving.exchange(1) != 0) return;
  const char* cache = std::getenv("POCL_CACHE_DIR");
  say("lobe: error: a library ended the process, most likely the OpenCL driver; check that its kernel cache "
      "(POCL_CACHE_DIR, here '");
  say(cache != nullptr ? cache : "~/.cache/pocl");
  say("') has room and may be written, and that 'ld' is installed\n");
  std::_Exit(static_cast<int>(ExitCode::device));
}

[[noreturn]] void end_as_internal_error() {
  is_leaving = 1;
  say("lobe: error: internal error: an exception that nothing caught; please report this\n");
  std::_Exit(static_cast<int>(ExitCode::numeric));
}

}  // namespace

void prepare_last_words() {
  std::atexit(end_as_device);
  std::set_terminate(end_as_internal_error);
}

void leave(int status) {
  end_status = status;
  is_leaving = 1;
}

void leave_threads_behind() {
  has_threads_left = true;
}

bool leaves_threads_behind() {
  return has_threads_left;
}

void end_at_once() {
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  if (is_leaving == 0) return;
  std::fflush(nullptr);
  std::_Exit(end_status);
#endif
}

}  // namespace lobe::cli

/// In place of libc's for the libraries. A handler of SIGABRT would not do: LLVM takes that signal when a kernel is
/// linked, and does not pass it on.
extern "C" void abort() noexcept {
  lobe::cli::end_as_device();
  std::signal(SIGABRT, SIG_DFL);
  std::raise(SIGABRT);
  std::_Exit(128 + SIGABRT);
}
