#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "interface/command.hpp"
#include "interface/operand.hpp"
#include "interface/options.hpp"
#include "interface/progress.hpp"
#include "interface/report.hpp"
#include "lobe/core/estimate.hpp"
#include "lobe/core/memory_bound.hpp"
#include "lobe/core/output_lock.hpp"
#include "lobe/core/progress.hpp"
#include "lobe/core/tolerance.hpp"
#include "lobe/device/device.hpp"
#include "lobe/hemisphere/grid.hpp"

namespace lobe::cli {

/// Surroundings of a command: its arguments, and the streams for results and remarks.
class Session {
 public:
  /// \param words all words as typed, without the program
  Session(const Arguments& arguments, std::vector<std::string> words);

  [[nodiscard]] const Arguments& arguments() const { return arguments_; }
  [[nodiscard]] const std::vector<std::string>& words() const { return words_; }
  /// All words as typed, quoted for a shell.
  [[nodiscard]] const std::string& command_line() const { return command_line_; }
  [[nodiscard]] bool wants_json() const { return arguments_.is_given(option::json); }
  [[nodiscard]] bool is_verbose() const { return arguments_.has(option::verbose); }
  [[nodiscard]] bool colors_output() const;

  /// The device of --device, else the library's choice, chosen when something is computed on it.
  [[nodiscard]] const Device& device() const { return device_; }
  /// The device, chosen now.
  /// \throws DeviceError.
  [[nodiscard]] const Device& choose_device() const;
  /// Handles of all devices of --device, else of LOBE_DEVICE, between which there are commas; one where that names one.
  [[nodiscard]] std::vector<Device> devices() const;
  /// Value of --precision, else `otherwise`.
  [[nodiscard]] Precision precision(Precision otherwise = Precision::double_precision) const;
  /// Value of --tolerance, else `otherwise`.
  /// \throws ArgumentError unless it is above 0 and below 1.
  [[nodiscard]] double tolerance(double otherwise) const;
  /// What a positional argument means, adjusted. \throws ArgumentError, IoError; as adjusted().
  [[nodiscard]] Operand operand(const Text& positional) const;
  /// What an operand stands for, tables with their values, whose memory is stated. \throws IoError.
  [[nodiscard]] Reflectance reflectance(const Operand& operand);

  /// Adds to the results. They are written when the command has succeeded.
  void print(std::string_view text) { output_ += text; }
  void print_json(const Json& json) { output_ += json_text(json); }
  [[nodiscard]] const std::string& output() const { return output_; }

  /// A line "lobe: warning: ..." on standard error, unless --quiet.
  void warn(std::string_view text);
  /// A line "lobe: ..." on standard error, unless --quiet.
  void state(std::string_view text);
  /// Text on standard error with --verbose, unless --quiet.
  void remark(std::string_view text);

  /// Keeps the lock of an output until the process ends, after OpenCL's last words: who is killed before has not
  /// finished.
  static void hold(OutputLock lock);
  /// Gives back the locks that are held.
  static void let_go();

  /// Has missed tolerances refused as with --strict, which the command may not take itself.
  void be_strict() { is_strict_ = true; }
  /// Notes a value that misses its tolerance.
  /// \throws NumericError with --strict.
  void note_missed(MissedTolerance missed);
  /// Notes what a computation tells it.
  /// \throws as note_missed().
  [[nodiscard]] MissedToleranceCallback missed();
  [[nodiscard]] bool reached_tolerance() const { return missed_.empty(); }
  /// Notes an error that exceeds a tolerance relative to a value.
  /// \throws as note_missed().
  void note_if_missed(std::string quantity, const Estimate& estimate, double tolerance);
  /// Warns in one line of something that was wished for and missed, and has no relative error.
  /// \throws NumericError with --strict.
  void warn_of_miss(const std::string& text);
  /// Notes a grid that does not resolve what is tabulated on it, unless --allow-unresolved is given.
  /// \param material its name; empty: a lobe of an unresolved table
  /// \param needed a grid that does; empty: unknown
  void note_coarse(const HemisphereGrid& grid, const std::string& material = {}, const std::string& needed = {});
  [[nodiscard]] bool has_coarse_grid() const { return !coarse_.empty(); }
  /// A warning in one line of all values that were noted and one of all grids, each on a line of its own with
  /// --verbose.
  void warn_of_missed();

  /// States how much memory the work to come will take at its peak: always from 1 GiB on, else with --verbose.
  /// \param work_bytes what it takes beside what is occupied now, with the device open
  /// \param saved_bytes what of it is still occupied while --output is written; that takes some more
  /// \param other_bytes what of it is no table, and stays in memory with --memory
  /// \throws NumericError if the machine has too little memory or, with --memory, the disk too little room.
  void state_memory(std::uint64_t work_bytes, std::uint64_t saved_bytes = 0, std::uint64_t other_bytes = 0);
  /// {"predicted_bytes"}: the last statement, less what the process had before, which differs from run to run. What was
  /// taken differs from run to run, and stands in report_stages().
  [[nodiscard]] Json memory_json() const;

  /// Shows progress on a terminal (unless --quiet, --no-progress or --json) and stops the work after Ctrl-C.
  [[nodiscard]] ProgressCallback progress();
  void end_progress() { progress_.erase(); }
  /// Warns where the process took more memory than --memory.
  void warn_of_memory();
  /// With --verbose a table on standard error: where the time went, and the peak of memory.
  void report_stages();

 private:
  void require_addresses() const;
  void state_bounded_memory(std::uint64_t table_bytes, std::uint64_t other_bytes);

  const Arguments& arguments_;
  Device device_;
  std::vector<std::string> words_;
  std::string command_line_;
  bool is_strict_;
  std::string output_;
  std::vector<MissedTolerance> missed_;
  std::vector<std::string> coarse_;  ///< grids with what they do not resolve
  std::uint64_t predicted_bytes_ = 0;
  std::uint64_t work_bytes_ = 0;                                           ///< memory in the last statement
  std::unique_ptr<MemoryBound> bound_;                                     ///< of --memory
  std::uint64_t least_bytes_ = std::numeric_limits<std::uint64_t>::max();  ///< resident before work that was stated
  ProgressLine progress_;
};

/// A command line, "lobe WORD...", quoted for a shell.
[[nodiscard]] std::string command_line_of(const std::vector<std::string>& words);

/// "double" or "single".
[[nodiscard]] std::string_view to_string(Precision precision);

}  // namespace lobe::cli
