#include "interface/terminal.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <semaphore.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <ctime>
#include <mutex>
#include <system_error>
#include <utility>

#include "interface/exit_code.hpp"
#include "lobe/core/error.hpp"
#include "lobe/core/files.hpp"

namespace lobe::cli {
namespace {

constexpr long kPatience = 700'000'000;  // ns

volatile std::sig_atomic_t caught_signal = 0;
sem_t signal_came;
std::vector<std::filesystem::path> absent_before;  // of the watched directories
std::mutex note_mutex;
std::string what_to_say;
bool output_is_closed = false;
std::atomic<bool> is_silent = false;
sem_t watch_ended;

extern "C" void remember_signal(int signal) {
  const int code = errno;
  caught_signal = signal;
  sem_post(&signal_came);
  errno = code;
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
    if (::fcntl(descriptor, F_GETFD) >= 0) continue;
    if (descriptor == STDOUT_FILENO) output_is_closed = true;
    // open() takes the lowest free descriptor, which is this one.
    static_cast<void>(::open("/dev/null", O_RDWR));
  }
  set_handler(SIGPIPE, SIG_IGN, 0);
  set_handler(SIGXFSZ, SIG_IGN, 0);
}

bool is_terminal(Stream stream) {
  return ::isatty(stream == Stream::output ? STDOUT_FILENO : STDERR_FILENO) != 0;
}

bool can_redraw(Stream stream) {
  const char* terminal = std::getenv("TERM");
  return is_terminal(stream) && terminal != nullptr && std::string_view(terminal) != "dumb";
}

std::size_t columns(Stream stream) {
  winsize size{};
  const int descriptor = stream == Stream::output ? STDOUT_FILENO : STDERR_FILENO;
  return ::ioctl(descriptor, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

bool uses_color(Stream stream, std::string_view choice) {
  if (choice == "always") return true;
  if (choice == "never" || !can_redraw(stream)) return false;
  const char* no_color = std::getenv("NO_COLOR");
  return no_color == nullptr || *no_color == '\0';
}

std::string bold(std::string_view text, bool color) {
  return color ? "\x1b[1m" + std::string(text) + "\x1b[0m" : std::string(text);
}

void be_silent() {
  is_silent = true;
}

void write_output(std::string_view text) {
  if (is_silent) return;
  if (output_is_closed && !text.empty()) throw IoError("cannot write to standard output: it is closed");
  const int code = write_all(STDOUT_FILENO, text);
  if (code != 0 && code != EPIPE) {
    const std::error_code error(code, std::generic_category());
    throw IoError("cannot write to standard output: " + error.message(), {.fault = fault_of(error)});
  }
}

void write_error(std::string_view text) {
  if (is_silent) return;
  static_cast<void>(write_all(STDERR_FILENO, text));
}

void write_over(std::string_view line) {
  // State of the thread that works, and of the one that ends it.
  static std::atomic<std::size_t> width = 0;
  const std::size_t before = width.exchange(line.size());
  if (before == 0 && line.empty()) return;
  std::string text = "\r" + std::string(line);
  if (before > line.size()) text.append(before - line.size(), ' ');
  if (line.empty()) text += '\r';
  write_error(text);
}

InterruptWatch::InterruptWatch(const std::vector<std::filesystem::path>& directories) {
  std::error_code ignored;
  for (const auto& directory : directories) {
    if (!directory.empty() && !std::filesystem::exists(directory, ignored)) absent_before.push_back(directory);
  }
  sem_init(&signal_came, 0, 0);
  sem_init(&watch_ended, 0, 0);
  thread_ = std::thread([this] { end_what_goes_on(); });
  for (const int signal : {SIGINT, SIGTERM}) {
    // Who started the process with the signal ignored (nohup, a shell's background) wants it to stay so.
    struct sigaction before {};
    sigaction(signal, nullptr, &before);
    // Restarted: compilers and readers take an interrupted call for a failure.
    if (before.sa_handler != SIG_IGN) set_handler(signal, remember_signal, static_cast<int>(SA_RESETHAND | SA_RESTART));
  }
}

InterruptWatch::~InterruptWatch() {
  for (const int signal : {SIGINT, SIGTERM}) {
    struct sigaction now {};
    sigaction(signal, nullptr, &now);
    if (now.sa_handler == remember_signal) set_handler(signal, SIG_DFL, 0);
  }
  sem_post(&watch_ended);
  sem_post(&signal_came);
  thread_.join();
}

void InterruptWatch::note(std::string text) {
  const std::lock_guard lock(note_mutex);
  what_to_say = std::move(text);
}

std::string InterruptWatch::noted() {
  const std::lock_guard lock(note_mutex);
  return what_to_say;
}

void InterruptWatch::end_what_goes_on() {
  while (sem_wait(&signal_came) != 0) {
  }
  timespec until{};
  clock_gettime(CLOCK_REALTIME, &until);
  until.tv_nsec += kPatience;
  until.tv_sec += until.tv_nsec / 1'000'000'000;
  until.tv_nsec %= 1'000'000'000;
  int waited = 0;
  do {
    waited = sem_timedwait(&watch_ended, &until);
  } while (waited != 0 && errno == EINTR);
  if (waited == 0) return;
  remove_unfinished();
  for (const auto& directory : absent_before) {
    // Only what is empty goes: a directory made for results that never came.
    std::error_code ignored;
    if (std::filesystem::is_directory(directory, ignored)) std::filesystem::remove(directory, ignored);
  }
  const std::string said = noted();
  write_over("");
  write_error(fmt::format("lobe: interrupted; {}\n", said.empty() ? "unfinished files were removed" : said));
  end_by_caught_signal();
}

bool InterruptWatch::interrupted() {
  return caught_signal != 0;
}

void end_by_caught_signal() {
  remove_unfinished();  // locks, too: nothing else is destroyed
  const int signal = caught_signal == 0 ? SIGINT : caught_signal;
  set_handler(signal, SIG_DFL, 0);
  static_cast<void>(std::raise(signal));
  std::_Exit(static_cast<int>(ExitCode::interrupted));
}

}  // namespace lobe::cli
