#include "last_words.hpp"

#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <cstring>

#include "exit_code.hpp"

namespace lobe::cli {
namespace {

volatile std::sig_atomic_t is_leaving = 0;

void say(const char* text) {
  [[maybe_unused]] const auto written = ::write(STDERR_FILENO, text, std::strlen(text));
}

/// Only what a signal handler may do.
void end_as_device() {
  if (is_leaving != 0) return;
  is_leaving = 1;
  const char* cache = std::getenv("POCL_CACHE_DIR");
  say("lobe: error: a library ended the process, most likely the OpenCL driver; check that its kernel cache "
      "(POCL_CACHE_DIR, here '");
  say(cache != nullptr ? cache : "~/.cache/pocl");
  say("') has room and may be written, and that 'ld' is installed\n");
  std::_Exit(static_cast<int>(ExitCode::device));
}

void on_abort(int /*signal*/) {
  end_as_device();
}

}  // namespace

void prepare_last_words() {
  std::atexit(end_as_device);
  std::signal(SIGABRT, on_abort);
}

void leave() {
  is_leaving = 1;
  std::signal(SIGABRT, SIG_DFL);
}

}  // namespace lobe::cli
