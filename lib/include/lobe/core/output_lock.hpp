#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace [[gnu::visibility("default")]] lobe {

/// Keeps other processes from writing the same output. The lock is on a file beside the output, ".NAME.lock", and ends
/// with the process, however that ends; the file says which work it belongs to. Within a process it is shared.
class OutputLock {
 public:
  /// Locks nothing.
  OutputLock() = default;
  /// Locks an output.
  /// \param output the file, or a name for several; its directory must exist
  /// \param work the work that writes it, the same for the same command
  /// \throws IoError "FILE is being written by process N; ..."
  OutputLock(const std::filesystem::path& output, std::string_view work);

  /// Whether the same work held the lock before and was killed, so that its leftovers may be replaced.
  [[nodiscard]] bool goes_on() const;
  /// Lets the next command with this work go on, as after a kill.
  void leave_behind() const;

 private:
  class Held;
  std::shared_ptr<Held> held_;
};

}  // namespace lobe
