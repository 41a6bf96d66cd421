#include "output_file.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "core/files.hpp"
#include "lobe/error.hpp"
#include "session.hpp"
#include "terminal.hpp"

namespace lobe::cli {
namespace {

namespace fs = std::filesystem;

/// \throws IoError when no file can be made in a directory.
void require_writable(const fs::path& directory) {
  if (::access(directory.c_str(), W_OK | X_OK) == 0) return;
  throw IoError(fmt::format("cannot write into directory {}: {}; give another by --output", directory.string(),
                            std::error_code(errno, std::generic_category()).message()));
}

}  // namespace

OutputFile::OutputFile(const Session& session, const fs::path& otherwise)
    : session_(session),
      path_(session.arguments().has("output") ? fs::path(session.arguments().text("output")) : otherwise) {
  if (path_.empty()) return;
  std::error_code ignored;
  if (fs::is_directory(path_, ignored)) throw IoError(path_.string() + " is a directory; give the name of a file");
  if (fs::exists(path_, ignored) && !session.arguments().has("force")) {
    throw IoError(path_.string() + " exists; use --force to replace it, or give another --output");
  }
  require_writable(path_.has_parent_path() ? path_.parent_path() : fs::path("."));
}

void OutputFile::write(const std::string& text) const {
  if (InterruptWatch::interrupted()) throw Cancelled("interrupted");
  if (is_wanted()) write_text(path_, session_.arguments().has("force"), text);
}

}  // namespace lobe::cli
