#pragma once

#include <cerrno>
#include <filesystem>
#include <string>
#include <string_view>

namespace lobe {

/// Makes a system call again as long as signals interrupt it.
template <typename Call>
auto retried(const Call& call) {
  for (;;) {
    const auto result = call();
    if (result != -1 || errno != EINTR) return result;
  }
}

/// A file that is written from its beginning to its end.
class FileWriter {
 public:
  /// \param name of what is written, for messages
  /// \throws IoError, as all that follows
  FileWriter(const std::filesystem::path& path, std::string name);
  ~FileWriter();
  FileWriter(const FileWriter&) = delete;
  FileWriter& operator=(const FileWriter&) = delete;

  void write(std::string_view bytes);
  void close();

 private:
  [[noreturn]] void fail(int code) const;

  std::string name_;
  int descriptor_;
};

}  // namespace lobe
