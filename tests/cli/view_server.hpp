#pragma once

#include <sys/types.h>

#include <chrono>
#include <csignal>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "support/temporary_directory.hpp"

namespace httplib {
class Client;
}

namespace lobe::test {

/// A `lobe view` that runs while the object lives.
class ViewProcess {
 public:
  using Json = nlohmann::ordered_json;

  /// How a question was answered.
  struct Answer {
    int status = 0;
    Json body;
  };

  /// \param arguments of `lobe view`, run in `directory`
  ViewProcess(const std::vector<std::string>& arguments, const std::filesystem::path& directory);
  ~ViewProcess();
  ViewProcess(const ViewProcess&) = delete;
  ViewProcess& operator=(const ViewProcess&) = delete;

  /// "http://127.0.0.1:8080/0123456789abcdef0123456789abcdef/"; empty when it did not start.
  [[nodiscard]] const std::string& address() const { return address_; }
  [[nodiscard]] int port() const { return port_; }
  [[nodiscard]] const std::string& token() const { return token_; }
  [[nodiscard]] pid_t process() const { return process_; }

  /// A client of the server, which waits a minute at most.
  [[nodiscard]] httplib::Client client() const;
  /// Asks as the page does.
  [[nodiscard]] Answer ask(const std::string& kind, const Json& question) const;

  /// Ends it by a signal. \return its exit status, or 128 + the signal's number
  int end(int signal = SIGINT);
  /// From the signal to the end.
  [[nodiscard]] std::chrono::milliseconds after_signal() const { return after_signal_; }

 private:
  pid_t process_ = -1;
  std::string address_;
  std::string token_;
  int port_ = 0;
  std::chrono::milliseconds after_signal_ = {};
};

}  // namespace lobe::test
