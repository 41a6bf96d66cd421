#include "cli/view_server.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <httplib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <filesystem>

namespace lobe::test {
namespace {

/// The first line that a pipe gives; empty at its end.
std::string first_line(int pipe) {
  std::string line;
  char letter = 0;
  while (::read(pipe, &letter, 1) == 1 && letter != '\n') line += letter;
  return line;
}

}  // namespace

ViewProcess::ViewProcess(const std::vector<std::string>& arguments, const std::filesystem::path& directory) {
  std::array<int, 2> pipe{};
  if (::pipe2(pipe.data(), O_CLOEXEC) != 0) return;
  std::vector<std::string> words{LOBE_COMMAND, "view"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  process_ = ::fork();
  if (process_ == 0) {
    ::dup2(pipe[1], STDOUT_FILENO);
    if (::chdir(directory.c_str()) == 0) ::execv(pointers.front(), pointers.data());
    ::_exit(127);
  }
  ::close(pipe[1]);
  address_ = first_line(pipe[0]);
  ::close(pipe[0]);
  const auto colon = address_.find(':', address_.find("//"));
  const auto slash = address_.find('/', colon);
  if (slash == std::string::npos) return;
  port_ = std::stoi(address_.substr(colon + 1, slash - colon - 1));
  token_ = address_.substr(slash + 1, address_.size() - slash - 2);
}

ViewProcess::~ViewProcess() {
  if (process_ > 0) end(SIGKILL);
}

int ViewProcess::end(int signal) {
  const auto start = std::chrono::steady_clock::now();
  ::kill(process_, signal);
  int status = 0;
  ::waitpid(process_, &status, 0);
  process_ = -1;
  after_signal_ = std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::steady_clock::now() - start);
  return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
}

httplib::Client ViewProcess::client() const {
  httplib::Client client("127.0.0.1", port_);
  constexpr time_t kMinute = 60;
  client.set_read_timeout(kMinute);
  return client;
}

ViewProcess::Answer ViewProcess::ask(const std::string& kind, const Json& question) const {
  auto client = this->client();
  const auto response = client.Post("/" + token_ + "/ask/" + kind, question.dump(), "application/json");
  if (!response) {
    ADD_FAILURE() << kind << ": no answer, " << httplib::to_string(response.error());
    return {};
  }
  return {response->status, Json::parse(response->body)};
}

}  // namespace lobe::test
