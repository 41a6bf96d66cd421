#include "core/streams.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <map>
#include <mutex>
#include <system_error>

#include "lobe/core/error.hpp"

namespace lobe {
namespace {

std::string read_all(const std::filesystem::path& path, std::size_t most) {
  const auto fail = [&](const std::string& why, Fault fault = Fault::unspecified) {
    throw IoError("cannot read " + path.string() + ": " + why, {.fault = fault, .path = path.string()});
  };
  const auto fail_with = [&](int code) {
    const std::error_code error(code, std::generic_category());
    fail(error.message(), fault_of(error));
  };
  const bool is_standard_input = path == "-";
  const int descriptor = is_standard_input ? STDIN_FILENO : ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) fail_with(errno);
  std::string content;
  std::array<char, std::size_t{1} << 16> part{};
  ssize_t count = 0;
  do {
    count = ::read(descriptor, part.data(), part.size());
    if (count > 0) content.append(part.data(), static_cast<std::size_t>(count));
  } while ((count > 0 && content.size() <= most) || (count < 0 && errno == EINTR));
  const int code = errno;
  if (!is_standard_input) ::close(descriptor);
  if (count < 0) fail_with(code);
  if (content.size() > most) fail("it holds more than " + std::to_string(most >> 20) + " MiB");
  return content;
}

}  // namespace

bool is_stream(const std::filesystem::path& path) {
  if (path == "-") return true;
  std::error_code ignored;
  const auto type = std::filesystem::status(path, ignored).type();
  return type == std::filesystem::file_type::fifo || type == std::filesystem::file_type::character;
}

std::shared_ptr<const std::string> stream_content(const std::filesystem::path& path, std::size_t most) {
  static std::mutex mutex;
  static std::map<std::string, std::shared_ptr<const std::string>> kept;
  const std::lock_guard lock(mutex);
  const std::string name = path == "/dev/stdin" ? "-" : path.string();
  auto& content = kept[name];
  if (!content) content = std::make_shared<const std::string>(read_all(name, most));
  return content;
}

}  // namespace lobe
