#include "interface/output_file.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "interface/options.hpp"
#include "interface/session.hpp"
#include "interface/terminal.hpp"
#include "lobe/core/error.hpp"
#include "lobe/core/files.hpp"

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
      path_(session.arguments().has(option::output) ? fs::path(session.arguments().text(option::output)) : otherwise) {
  if (path_ == "-") path_ = "/dev/stdout";
  if (path_.empty() || is_output_stream(path_)) return;
  std::error_code ignored;
  if (fs::is_directory(path_, ignored)) throw IoError(path_.string() + " is a directory; give the name of a file");
  const auto refuse_existing = [&] {
    if (fs::exists(path_, ignored) && !overwrites()) {
      throw IoError(path_.string() + " exists; use --force to replace it, or give another --output");
    }
  };
  const fs::path directory = path_.has_parent_path() ? path_.parent_path() : fs::path(".");
  if (!fs::exists(directory / ("." + path_.filename().string() + ".lock"), ignored)) refuse_existing();
  require_writable(directory);
  lock_ = OutputLock(path_, session.command_line());
  Session::hold(lock_);
  refuse_existing();
}

bool OutputFile::overwrites() const {
  return session_.arguments().has(option::force) || lock_.goes_on();
}

bool takes_standard_output(const Arguments& arguments) {
  if (!arguments.is_given(option::output)) return false;
  const std::string& output = arguments.text(option::output);
  return output == "-" || output == "/dev/stdout" || output == "/dev/fd/1" || output == "/proc/self/fd/1";
}

void OutputFile::write(const std::string& text) const {
  if (InterruptWatch::interrupted()) throw Cancelled("interrupted");
  if (is_wanted()) write_text(path_, overwrites(), text);
}

}  // namespace lobe::cli
