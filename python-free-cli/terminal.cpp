#include "terminal.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <system_error>

#include "exit_code.hpp"
#include "lobe/error.hpp"

namespace lobe::cli {
namespace {

volatile std::sig_atomic_t caught_signal = 0;

extern "C" void remember_signal(int signal) {
  caught_signal = signal;
}

/// \return 0 or the error number
int write_all(int descriptor, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(descriptor, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return errno;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  return 0;
}

void set_handler(int signal, void (*handler)(int), int flags) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = flags;
  sigemptyset(&action.sa_mask);
  sigaction(signal, &action, nullptr);
}

}  // namespace

void prepare_streams() {
  for (int descriptor = 0; descriptor <= 2; ++descriptor) {
    // open() takes the lowest free descriptor, which is this one.
    if (::fcntl(descriptor, F_GETFD) < 0) static_cast<void>(::open("/dev/null", O_RDWR));
  }
  set_handler(SIGPIPE, SIG_IGN, 0);
  set_handler(SIGXFSZ, SIG_IGN, 0);
}

bool is_terminal(Stream stream) {
  return ::isatty(stream == Stream::output ? STDOUT_FILENO : STDERR_FILENO) != 0;
}

bool uses_color(Stream stream, std::string_view choice) {
  if (choice == "always") return true;
  if (choice == "never" || !is_terminal(stream)) return false;
  const char* no_color = std::getenv("NO_COLOR");
  if (no_color != nullptr && *no_color != '\0') return false;
  const char* terminal = std::getenv("TERM");
  return terminal != nullptr && std::string_view(terminal) != "dumb";
}

std::string bold(std::string_view text, bool color) {
  return color ? "\x1b[1m" + std::string(text) + "\x1b[0m" : std::string(text);
}

void write_output(std::string_view text) {
  const int code = write_all(STDOUT_FILENO, text);
  if (code != 0 && code != EPIPE) {
    throw IoError("cannot write to standard output: " + std::error_code(code, std::generic_category()).message());
  }
}

void write_error(std::string_view text) {
  static_cast<void>(write_all(STDERR_FILENO, text));
}

InterruptWatch::InterruptWatch() {
  for (const int signal : {SIGINT, SIGTERM}) set_handler(signal, remember_signal, static_cast<int>(SA_RESETHAND));
}

InterruptWatch::~InterruptWatch() {
  for (const int signal : {SIGINT, SIGTERM}) set_handler(signal, SIG_DFL, 0);
}

bool InterruptWatch::interrupted() {
  return caught_signal != 0;
}

void end_by_caught_signal() {
  const int signal = caught_signal == 0 ? SIGINT : caught_signal;
  set_handler(signal, SIG_DFL, 0);
  static_cast<void>(std::raise(signal));
  std::_Exit(static_cast<int>(ExitCode::interrupted));
}

}  // namespace lobe::cli
