#include "cli/process.hpp"

#include <fcntl.h>
#include <pty.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <stdexcept>
#include <thread>
#include <utility>

namespace lobe::test {
namespace {

/// A nameless file that takes what the child writes.
using Catcher = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

std::string content(const Catcher& catcher) {
  std::string text;
  std::rewind(catcher.get());
  for (int c = std::fgetc(catcher.get()); c != EOF; c = std::fgetc(catcher.get())) text += static_cast<char>(c);
  return text;
}

/// The child's side, from fork to exec.
[[noreturn]] void become(const std::vector<std::string>& words, const Surroundings& surroundings, int output,
                         int error) {
  if (!surroundings.output.empty()) output = ::open(surroundings.output.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
  if (::dup2(output, STDOUT_FILENO) < 0 || ::dup2(error, STDERR_FILENO) < 0) std::_Exit(125);
  if (surroundings.largest_file_bytes) {
    const rlimit limit{*surroundings.largest_file_bytes, *surroundings.largest_file_bytes};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  for (const auto& [name, value] : surroundings.environment) ::setenv(name.c_str(), value.c_str(), 1);
  if (!surroundings.directory.empty() && ::chdir(surroundings.directory.c_str()) != 0) std::_Exit(125);
  std::vector<std::string> copies = words;
  std::vector<char*> pointers;
  for (auto& word : copies) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  ::execv(pointers.front(), pointers.data());
  std::_Exit(125);
}

/// The side of a terminal that is looked at, and what was written on it.
class Screen {
 public:
  Screen() {
    if (::openpty(&own_, &child_, nullptr, nullptr, nullptr) != 0) throw std::runtime_error("cannot open a terminal");
    ::fcntl(own_, F_SETFD, FD_CLOEXEC);
  }
  ~Screen() {
    if (child_ >= 0) ::close(child_);
    if (reader_.joinable()) reader_.join();
    ::close(own_);
  }
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;

  [[nodiscard]] int child() const { return child_; }
  /// After the fork: reads until nobody writes any more.
  void look() {
    ::close(std::exchange(child_, -1));
    reader_ = std::thread([this] {
      std::array<char, 4096> buffer{};
      for (ssize_t count = 0; (count = ::read(own_, buffer.data(), buffer.size())) > 0;) {
        text_.append(buffer.data(), static_cast<std::size_t>(count));
      }
    });
  }
  [[nodiscard]] std::string text() {
    reader_.join();
    return text_;
  }

 private:
  int own_ = -1;
  int child_ = -1;
  std::thread reader_;
  std::string text_;
};

Outcome run(const std::vector<std::string>& words, const Surroundings& surroundings) {
  using Clock = std::chrono::steady_clock;
  const Catcher output(std::tmpfile(), std::fclose);
  const Catcher error(std::tmpfile(), std::fclose);
  if (!output || !error) throw std::runtime_error("cannot make a temporary file");
  std::optional<Screen> screen;
  if (surroundings.on_terminal) screen.emplace();
  const pid_t child = ::fork();
  if (child < 0) throw std::runtime_error("cannot fork");
  if (child == 0) become(words, surroundings, ::fileno(output.get()), screen ? screen->child() : ::fileno(error.get()));
  if (screen) screen->look();
  if (!surroundings.interrupt_when.empty()) {
    const auto is_over = [child] {
      siginfo_t info{};
      return ::waitid(P_PID, static_cast<id_t>(child), &info, WEXITED | WNOHANG | WNOWAIT) == 0 && info.si_pid != 0;
    };
    while (!std::filesystem::exists(surroundings.interrupt_when) && !is_over()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    ::kill(child, surroundings.signal);
  }
  if (surroundings.interrupt_after.count() > 0) {
    std::this_thread::sleep_for(surroundings.interrupt_after);
    ::kill(child, surroundings.signal);
  }
  const auto signalled = Clock::now();
  int state = 0;
  ::waitpid(child, &state, 0);
  return {.status = WIFSIGNALED(state) ? 128 + WTERMSIG(state) : WEXITSTATUS(state),
          .output = content(output),
          .error = screen ? screen->text() : content(error),
          .after_signal = std::chrono::duration_cast<std::chrono::milliseconds>(Clock::now() - signalled)};
}

}  // namespace

Outcome run_program(const std::vector<std::string>& words, const Surroundings& surroundings) {
  return run(words, surroundings);
}

Outcome run_lobe(const std::vector<std::string>& arguments, const Surroundings& surroundings) {
  std::vector<std::string> words{LOBE_COMMAND};
  words.insert(words.end(), arguments.begin(), arguments.end());
  return run(words, surroundings);
}

Outcome run_line(const std::string& line, const Surroundings& surroundings) {
  const char* path = std::getenv("PATH");
  Surroundings with_path = surroundings;
  with_path.environment.emplace_back("PATH", std::filesystem::path(LOBE_COMMAND).parent_path().string() + ":" +
                                                 (path == nullptr ? "/usr/bin:/bin" : path));
  return run({"/bin/sh", "-c", line}, with_path);
}

}  // namespace lobe::test
