#include "core/file_writer.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <system_error>
#include <utility>

#include "lobe/core/error.hpp"

namespace lobe {

FileWriter::FileWriter(const std::filesystem::path& path, std::string name)
    : name_(std::move(name)),
      descriptor_(retried([&] { return ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666); })) {
  if (descriptor_ < 0) fail(errno);
}

FileWriter::~FileWriter() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void FileWriter::write(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = retried([&] { return ::write(descriptor_, bytes.data(), bytes.size()); });
    if (count < 0) fail(errno);
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
}

void FileWriter::close() {
  // Closed, whatever the answer, also when it is that a signal came.
  if (::close(std::exchange(descriptor_, -1)) != 0 && errno != EINTR) fail(errno);
}

void FileWriter::fail(int code) const {
  const std::error_code error(code, std::generic_category());
  throw IoError("cannot write " + name_ + ": " + error.message(), {.fault = fault_of(error), .path = name_});
}

}  // namespace lobe
