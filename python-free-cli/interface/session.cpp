#include "interface/session.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <system_error>
#include <utility>

#include "core/shell.hpp"
#include "interface/last_words.hpp"
#include "interface/memory.hpp"
#include "interface/options.hpp"
#include "interface/reading.hpp"
#include "interface/table_making.hpp"
#include "interface/terminal.hpp"
#include "lobe/core/error.hpp"

namespace lobe::cli {
namespace {

/// There before libraries of OpenCL are loaded, and therefore until they have gone.
/// Gives locks back when the process ends, and ends it then and there: who is killed later has finished.
struct HeldLocks {
  HeldLocks() = default;
  HeldLocks(const HeldLocks&) = delete;
  HeldLocks& operator=(const HeldLocks&) = delete;
  ~HeldLocks() {
    if (all.empty()) return;
    all.clear();
    end_at_once();
  }
  std::vector<OutputLock> all;
};
HeldLocks locks;

constexpr std::uint64_t kMuchMemory = std::uint64_t{1} << 30;
constexpr std::uint64_t kKernelMemory = std::uint64_t{16} << 20;  // kernels and their runtime, once they run
constexpr std::uint64_t kFileMemory = std::uint64_t{32} << 20;    // parts of a table on their way into a file

/// \return null without --memory
std::unique_ptr<MemoryBound> make_bound(const Arguments& arguments) {
  if (!arguments.has(option::memory)) return nullptr;
  const std::uint64_t bytes = parse_bytes(arguments.text(option::memory));
  try {
    return std::make_unique<MemoryBound>(scratch_folder(), bytes);
  } catch (const IoError& error) {
    throw IoError(std::string(error.problem()) + "; set TMPDIR to a folder on a disk with room for the tables",
                  error.fields());
  }
}

}  // namespace

std::string_view to_string(Precision precision) {
  return precision == Precision::single_precision ? "single" : "double";
}

std::string command_line_of(const std::vector<std::string>& words) {
  std::string line = "lobe";
  for (const auto& word : words) line += " " + shell_word(word);
  return line;
}

Session::Session(const Arguments& arguments, std::vector<std::string> words)
    : arguments_(arguments),
      device_(Device::on_demand(arguments.text(option::device))),
      words_(std::move(words)),
      command_line_(command_line_of(words_)),
      is_strict_(arguments.is_given(option::strict)),
      bound_(make_bound(arguments)),
      progress_(can_redraw(Stream::error) && !arguments.has(option::quiet) && !arguments.has(option::no_progress) &&
                !arguments.is_given(option::json)) {}

bool Session::colors_output() const {
  return uses_color(Stream::output, arguments_.text(option::color));
}

const Device& Session::choose_device() const {
  (void)device_.info();
  return device_;
}

Operand Session::operand(const Text& positional) const {
  Operand operand(arguments_.text(positional), read_options(arguments_));
  operand.adjust(device_);
  return operand;
}

Reflectance Session::reflectance(const Operand& operand) {
  if (const BrdfTable* header = operand.shape().table()) state_memory(value_bytes(*header));
  return operand.reflectance();
}

std::vector<Device> Session::devices() const {
  std::string names = arguments_.text(option::device);
  if (const char* variable = std::getenv("LOBE_DEVICE"); names.empty() && variable != nullptr) names = variable;
  if (names.find(',') == names.npos) return {device_};
  std::vector<Device> devices;
  for (std::size_t at = 0; at <= names.size();) {
    const std::size_t end = std::min(names.find(',', at), names.size());
    if (end == at) throw ArgumentError("'" + names + "' names no devices; expected a list such as 0:0,0:1");
    devices.push_back(Device::choose(names.substr(at, end - at)));
    at = end + 1;
  }
  return devices;
}

Precision Session::precision(Precision otherwise) const {
  if (!arguments_.has(option::precision)) return otherwise;
  return arguments_.text(option::precision) == "single" ? Precision::single_precision : Precision::double_precision;
}

double Session::tolerance(double otherwise) const {
  if (!arguments_.has(option::tolerance)) return otherwise;
  const double value = arguments_.number(option::tolerance);
  if (!(value > 0 && value < 1)) {
    throw ArgumentError("--tolerance " + arguments_.text(option::tolerance) +
                        " is out of range; expected a relative error above 0 and below 1, such as 1e-6");
  }
  return value;
}

void Session::warn(std::string_view text) {
  if (arguments_.has(option::quiet)) return;
  progress_.erase();
  const bool color = uses_color(Stream::error, arguments_.text(option::color));
  write_error("lobe: " + bold("warning:", color) + " " + std::string(text) + "\n");
}

void Session::state(std::string_view text) {
  if (arguments_.has(option::quiet)) return;
  progress_.erase();
  write_error("lobe: " + std::string(text) + "\n");
}

void Session::remark(std::string_view text) {
  if (!is_verbose() || arguments_.has(option::quiet)) return;
  progress_.erase();
  write_error(text);
}

void Session::note_missed(MissedTolerance missed) {
  if (is_strict_) refuse_missed_tolerance(missed);
  missed_.push_back(std::move(missed));
}

MissedToleranceCallback Session::missed() {
  return [this](const MissedTolerance& missed) { note_missed(missed); };
}

void Session::note_if_missed(std::string quantity, const Estimate& estimate, double tolerance) {
  const double size = std::abs(estimate.value);
  if (!(estimate.error > tolerance * size)) return;
  note_missed({.quantity = std::move(quantity), .relative_error = estimate.error / size, .tolerance = tolerance});
}

void Session::warn_of_miss(const std::string& text) {
  if (is_strict_) throw NumericError(text + "; give a larger tolerance");
  warn(text);
}

void Session::note_coarse(const HemisphereGrid& grid, const std::string& material, const std::string& needed) {
  if (arguments_.is_given(option::allow_unresolved)) return;
  std::string text = fmt::format("grid {} does not resolve ", grid.name());
  text += material.empty() ? "a lobe" : fmt::format("'{}'", material);
  if (!needed.empty()) text += fmt::format(" (it needs {})", needed);
  if (std::ranges::find(coarse_, text) == coarse_.end()) coarse_.push_back(std::move(text));
}

void Session::warn_of_missed() {
  if (!coarse_.empty()) {
    const std::size_t others = coarse_.size() - 1;
    const std::string more = others == 0 ? "" : fmt::format(", nor {} more", others);
    warn(coarse_.front() + more + "; errors are stated as they are, --strict refuses them");
    if (others > 0) {
      for (const auto& text : coarse_) remark("lobe: " + text + "\n");
    }
  }
  if (missed_.empty()) return;
  const auto& worst = *std::ranges::max_element(missed_, {}, &MissedTolerance::relative_error);
  const std::size_t others = missed_.size() - 1;
  std::string text = to_string(worst);
  if (others > 0) text += fmt::format(", the worst of {} values", missed_.size());
  warn(text + "; errors are stated as they are, --strict refuses them");
  if (others == 0) return;
  for (const auto& missed : missed_) remark("lobe: " + to_string(missed) + "\n");
}

void Session::state_memory(std::uint64_t work_bytes, std::uint64_t saved_bytes, std::uint64_t other_bytes) {
  const std::uint64_t table_bytes = work_bytes - std::min(work_bytes, other_bytes);
  if (arguments_.is_given(option::output)) work_bytes = std::max(work_bytes, saved_bytes + kFileMemory);
  work_bytes_ = kKernelMemory + work_bytes;
  predicted_bytes_ = resident_bytes() + kKernelMemory + work_bytes;
  require_addresses();
  if (bound_) return state_bounded_memory(table_bytes, other_bytes);
  const MachineMemory machine = machine_memory();
  if (machine.total_bytes > 0 && predicted_bytes_ > machine.total_bytes) {
    throw NumericError("this takes about " + bytes_text(predicted_bytes_) + " of memory, more than the " +
                       bytes_text(machine.total_bytes) + " of this machine; use a smaller grid");
  }
  const std::string statement = "peak memory will be about " + bytes_text(predicted_bytes_);
  if (machine.available_bytes > 0 && predicted_bytes_ > machine.available_bytes) {
    warn(statement + ", more than the " + bytes_text(machine.available_bytes) + " available");
  } else if (predicted_bytes_ >= kMuchMemory || is_verbose()) {
    state(statement);
  }
}

void Session::require_addresses() const {
  const auto left = bytes_within_limit();
  if (!left || work_bytes_ <= *left) return;
  throw NumericError("this takes about " + bytes_text(work_bytes_) + " of memory, more than the " + bytes_text(*left) +
                     " that the limit on this process (ulimit -v) leaves; use a smaller grid");
}

void Session::state_bounded_memory(std::uint64_t table_bytes, std::uint64_t other_bytes) {
  least_bytes_ = std::min(least_bytes_, resident_bytes());
  const std::uint64_t needed = least_bytes_ + kKernelMemory + kFileMemory + other_bytes;
  if (bound_->bytes() < needed) {
    throw NumericError("--memory " + arguments_.text(option::memory) + " is too small: this takes about " +
                       bytes_text(needed) + " beside its tables; expected more");
  }
  const std::string folder = bound_->folder().string();
  std::error_code code;
  const std::uint64_t free = std::filesystem::space(bound_->folder(), code).available;
  if (!code && table_bytes > free) {
    throw NumericError("this takes about " + bytes_text(table_bytes) + " for tables, more than the " +
                       bytes_text(free) + " that are free in " + folder + "; set TMPDIR to a folder on a larger disk");
  }
  if (table_bytes < kMuchMemory && !is_verbose()) return;
  state("tables will take about " + bytes_text(table_bytes) + " in " + folder + ", memory is meant to stay below " +
        bytes_text(bound_->bytes()));
}

void Session::warn_of_memory() {
  const std::uint64_t peak = peak_resident_bytes();
  if (!bound_ || peak <= bound_->bytes()) return;
  warn("memory reached " + bytes_text(peak) + ", more than --memory " + arguments_.text(option::memory) +
       ": what is no table has to fit, and tables may exceed it for a moment");
}

Json Session::memory_json() const {
  return {{"predicted_bytes", work_bytes_}};
}

void Session::hold(OutputLock lock) {
  locks.all.push_back(std::move(lock));
}

void Session::let_go() {
  locks.all.clear();
}

void Session::report_stages() {
  end_progress();
  if (!is_verbose() || arguments_.has(option::quiet)) return;
  const double total = progress_.seconds();
  std::vector<std::vector<std::string>> rows{{"stage", "seconds", "share/%"}};
  const auto add = [&](std::string name, double seconds) {
    rows.push_back({std::move(name), fmt::format("{:.3f}", seconds), fmt::format("{:.1f}", 100 * seconds / total)});
  };
  double rest = total;
  for (const auto& [name, seconds] : progress_.stages()) {
    add(name, seconds);
    rest -= seconds;
  }
  add("before, between and after", rest);
  add("total", total);
  remark("\n" + format_table(rows, 1, false) + fmt::format("peak memory {}\n", bytes_text(peak_resident_bytes())));
}

ProgressCallback Session::progress() {
  return [this](std::string_view stage, double fraction) {
    progress_.show(stage, fraction);
    return !InterruptWatch::interrupted();
  };
}

}  // namespace lobe::cli
