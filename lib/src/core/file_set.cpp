#include "core/file_set.hpp"

#include <cerrno>
#include <cstdio>
#include <sstream>
#include <system_error>

#include "core/files.hpp"
#include "core/unfinished.hpp"
#include "lobe/core/error.hpp"

namespace lobe {
namespace {

namespace fs = std::filesystem;

constexpr const char* kJournal = "journal";  // what moves ("+NAME") and what goes ("-NAME"); there once all is made
constexpr const char* kOlder = "older.";     // before the name of a file that has been replaced

fs::path staging_of(const fs::path& directory, const std::string& name) {
  return (directory.empty() ? fs::path(".") : directory) / ("." + name + ".unfinished");
}

void move(const fs::path& from, const fs::path& to) {
  if (std::rename(from.c_str(), to.c_str()) == 0) return;
  const std::error_code code(errno, std::generic_category());
  throw IoError("cannot write " + to.string() + ": " + code.message(), {.fault = fault_of(code), .path = to.string()});
}

bool is_there(const fs::path& path) {
  std::error_code code;
  return fs::exists(fs::symlink_status(path, code));
}

/// Takes one step of a journal; one that has been taken is taken again without effect.
void step(const std::string& line, const fs::path& staging, const fs::path& directory) {
  const std::string name = line.substr(1);
  const fs::path place = directory / name;
  const fs::path made = staging / name;
  const bool is_to_move = line.front() == '+' && is_there(made);
  if (line.front() == '+' && !is_to_move) return;
  if (is_there(place)) {
    std::error_code code;
    if (fs::is_directory(place, code))
      throw IoError(place.string() + " is a directory; expected a file name",
                    {.fault = Fault::directory, .path = place.string()});
    if (is_to_move) take_mode(made, place);
    move(place, staging / (kOlder + name));
  }
  if (is_to_move) move(made, place);
}

std::vector<std::string> lines_of(const fs::path& path) {
  std::istringstream text(read_text(path));
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);) {
    if (line.size() > 1) lines.push_back(line);
  }
  return lines;
}

/// Puts files that had been replaced back.
/// \return whether all of them are
bool undo(const std::vector<std::string>& lines, const fs::path& staging, const fs::path& directory) {
  bool is_undone = true;
  for (const std::string& line : lines) {
    const std::string name = line.substr(1);
    std::error_code code;
    if (line.front() == '+' && !is_there(staging / name)) fs::rename(directory / name, staging / name, code);
    is_undone = is_undone && !code;
    if (is_there(staging / (kOlder + name))) fs::rename(staging / (kOlder + name), directory / name, code);
    is_undone = is_undone && !code;
  }
  return is_undone;
}

}  // namespace

struct FileSet::Staging {
  explicit Staging(fs::path path) : directory(std::move(path)) {}
  Unfinished directory;
};

FileSet::FileSet(const fs::path& directory, const std::string& name, bool overwrite)
    : directory_(directory.empty() ? fs::path(".") : directory), overwrite_(overwrite) {
  make_directory(directory_);
  lock_ = OutputLock(directory_ / name, {});
  finish_killed(directory_, name);
  const fs::path staging = staging_of(directory_, name);
  std::error_code code;
  if (!fs::create_directory(staging, code)) {
    if (!code) code = std::make_error_code(std::errc::file_exists);
    throw IoError(
        "cannot create directory " + staging.string() + ": " + code.message(),
        {.fault = code == std::errc::file_exists ? Fault::unspecified : fault_of(code), .path = staging.string()});
  }
  staging_ = std::make_unique<Staging>(staging);
}

FileSet::~FileSet() = default;

const fs::path& FileSet::staging() const {
  return staging_->directory.path();
}

void FileSet::write(const std::string& name, const std::string& text) {
  write_text(staging() / name, false, text);
  add(name);
}

void FileSet::keep() {
  if (!overwrite_) {
    for (const std::string& name : added_) require_absent(directory_ / name);
  }
  std::vector<std::string> lines;
  for (const std::string& name : added_) lines.push_back("+" + name);
  for (const std::string& name : left_out_) lines.push_back("-" + name);
  std::string journal;
  for (const std::string& line : lines) journal += line + "\n";
  const auto lock = without_interruption();
  write_text(staging() / kJournal, false, journal);
  try {
    for (const std::string& line : lines) step(line, staging(), directory_);
  } catch (const std::exception& failure) {
    if (undo(lines, staging(), directory_)) throw;
    // A file that is neither here nor there stays where it is, with its journal.
    staging_->directory.finish();
    lock_.leave_behind();
    throw IoError(std::string(failure.what()) + "; some files are in place: the same command moves the others");
  }
  sync_to_disk(directory_);
  // From here on nothing is to be finished any more.
  std::error_code ignored;
  fs::remove(staging() / kJournal, ignored);
  staging_.reset();
}

void finish_killed(const fs::path& directory, const std::string& name) {
  const fs::path staging = staging_of(directory, name);
  std::error_code code;
  if (!fs::is_directory(fs::symlink_status(staging, code))) return;
  if (fs::exists(staging / kJournal, code)) {
    for (const std::string& line : lines_of(staging / kJournal)) step(line, staging, directory);
    sync_to_disk(directory.empty() ? fs::path(".") : directory);
    fs::remove(staging / kJournal, code);
  }
  const Unfinished rest(staging);
}

bool is_half_moved(const fs::path& directory, const std::string& name) {
  return is_there(staging_of(directory, name) / kJournal);
}

void require_absent(const fs::path& path) {
  std::error_code ignored;
  if (fs::exists(path, ignored)) {
    throw IoError(path.string() + " exists; expected leave to replace it, or another output name",
                  {.fault = Fault::existing_file, .path = path.string()});
  }
}

void make_directory(const fs::path& directory) {
  if (directory.empty()) return;
  std::error_code code;
  fs::create_directories(directory, code);
  if (code)
    throw IoError("cannot create directory " + directory.string() + ": " + code.message(),
                  {.fault = fault_of(code), .path = directory.string()});
}

}  // namespace lobe
