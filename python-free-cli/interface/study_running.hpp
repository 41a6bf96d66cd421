#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "interface/exit_code.hpp"
#include "interface/report.hpp"
#include "interface/session.hpp"
#include "lobe/core/output_lock.hpp"
#include "lobe/device/device.hpp"
#include "lobe/study/study.hpp"

// What `lobe run` and `lobe merge` have in common: the study that is asked for, and the files of its results.
namespace lobe::cli {

/// A study as `lobe run` is asked for it.
struct StudyRequest {
  std::string path;                    ///< of the study file
  std::vector<std::string> set;        ///< values set from outside
  std::string name;                    ///< stem of the file names; empty: the study's
  std::optional<double> tolerance;     ///< instead of the study's
  std::optional<Precision> precision;  ///< instead of the study's
  bool is_strict = false;              ///< tolerances that are missed are errors
  std::vector<std::string> command;    ///< words of the command, with kPlaceOfOutput for its output
};

/// Stands in StudyRequest::command for the directory of the results. No word of a command has control characters.
inline constexpr char kPlaceOfOutput = '\1';

[[nodiscard]] Json to_json(const StudyRequest& request);
/// \throws IoError where that is no request.
[[nodiscard]] StudyRequest study_request(const std::string& json);

/// Words of a command without `--shard` and `--force`, and with kPlaceOfOutput in place of the directory.
[[nodiscard]] std::vector<std::string> words_for_any_output(const std::vector<std::string>& words);
/// The command line that writes the same results into a directory.
/// \param output empty: the current directory
[[nodiscard]] std::string plain_command_line(const StudyRequest& request, const std::string& output);

/// A study, and whether it keeps tables that its grid does not resolve of its own accord.
struct RequestedStudy {
  Study study;
  bool allows_unresolved = false;
};
/// \throws as load_study(); ArgumentError for what is no study file or cannot be the stem of file names.
[[nodiscard]] RequestedStudy requested_study(const StudyRequest& request);

/// First file of the study's results that exists; empty if there is none.
[[nodiscard]] std::filesystem::path existing_file(const Study& study, const std::filesystem::path& directory);

/// Throws what OutputDirectory would throw for a directory; creates nothing.
void require_writable(const std::filesystem::path& directory);

/// A directory for files, checked before the computation; removed again if it was made here and stays empty.
class OutputDirectory {
 public:
  /// \throws IoError, as check()
  explicit OutputDirectory(std::filesystem::path path);
  ~OutputDirectory() { remove_empty(); }
  OutputDirectory(const OutputDirectory&) = delete;
  OutputDirectory& operator=(const OutputDirectory&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  /// \throws IoError when no file can be written.
  void check() const;

 private:
  void remove_empty() const;

  std::filesystem::path path_;
  std::vector<std::filesystem::path> made_;  ///< deepest first
};

/// The place of a study's results, locked: as long as it exists nobody else computes this study into the directory.
/// What a command had left when it was killed is its own.
class StudyPlace {
 public:
  /// \param overwrite whether files that exist may be replaced
  /// \param other the option by which results go elsewhere, for the message
  /// \throws IoError when they may not, or when nothing can be written
  StudyPlace(const Session& session, const Study& study, const std::filesystem::path& directory, bool overwrite,
             std::string_view other);

  [[nodiscard]] const std::filesystem::path& path() const { return directory_.path(); }
  [[nodiscard]] bool replaces() const { return replaces_; }
  [[nodiscard]] const OutputLock& lock() const { return lock_; }

 private:
  OutputDirectory directory_;
  OutputLock lock_;
  bool replaces_;
};

/// How results are written and told.
struct StudyEnding {
  std::string command;                            ///< for --json: "run"
  std::string command_line;                       ///< recorded in the file
  bool wants_errors = false;                      ///< errors above a tolerance that was asked for are told
  bool allows_unresolved = false;                 ///< as in RequestedStudy
  std::function<void()> when_written = [] {};     ///< called once all numbers are in their files
  std::function<void(Json&)> add = [](Json&) {};  ///< adds to the answer of --json
};

/// Writes the results of a study and tells what there is to tell.
/// \throws IoError; NumericError with --strict; Cancelled
[[nodiscard]] ExitCode finish_study(Session& session, StudyResult& result, const StudyPlace& place,
                                    const StudyEnding& ending);

}  // namespace lobe::cli
