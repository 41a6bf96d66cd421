#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "lobe/core/progress.hpp"
#include "lobe/device/device.hpp"
#include "lobe/study/study.hpp"
#include "study/run/kept_units.hpp"
#include "study/run/record_file.hpp"
#include "study/run/study_computation.hpp"
#include "study/run/unit_dealer.hpp"

namespace lobe {

/// What threads that compute share with the one that waits for them.
struct Computing {
  std::mutex mutex;
  std::condition_variable changed;
  ProgressCallback progress;
  bool is_stopped = false;

  [[nodiscard]] bool report(std::string_view stage, double share);
};

/// A thread that computes. The work owns what it uses: if it does not end in time it is left to itself.
class ComputingThread {
 public:
  ComputingThread(std::shared_ptr<Computing> state, std::function<void()> work);
  ~ComputingThread();
  ComputingThread(const ComputingThread&) = delete;
  ComputingThread& operator=(const ComputingThread&) = delete;

  [[nodiscard]] bool is_over() const;
  /// What it has thrown; null: nothing.
  [[nodiscard]] std::exception_ptr failure() const;
  /// Has all threads with this state stop, and waits for this one.
  void stop(std::chrono::milliseconds patience);

 private:
  struct Ending {
    bool is_over = false;
    std::exception_ptr failure;
  };
  std::shared_ptr<Computing> state_;
  std::shared_ptr<Ending> ending_ = std::make_shared<Ending>();
  std::thread thread_;
};

/// Records of all units, in the checkpoint where that keeps them, else in memory.
class CrewRecords {
 public:
  /// \param file none: all are in memory
  CrewRecords(const Study& study, RecordFile* file) : names_(study), file_(file) {}

  [[nodiscard]] bool has(const std::string& unit) const { return find(unit) != nullptr; }
  [[nodiscard]] std::string get(const std::string& unit) const { return *find(unit); }
  void keep(const std::string& unit, std::string content);
  /// Number of those in the checkpoint.
  [[nodiscard]] std::size_t kept() const { return file_ == nullptr ? 0 : file_->size(); }

 private:
  [[nodiscard]] const std::string* find(const std::string& unit) const;

  KeptNames names_;
  RecordFile* file_;
  std::map<std::string, std::string, std::less<>> others_;
};

/// A study that several threads or processes compute, in the process that completes it. Computing::mutex guards what
/// changes.
struct CrewWork {
  CrewWork(Device used, Study computed, RecordFile* file)
      : device(std::move(used)), study(std::move(computed)), records(study, file) {}

  std::shared_ptr<Computing> state = std::make_shared<Computing>();
  Device device;
  Study study;
  CrewRecords records;
  std::unique_ptr<StudyComputation> computation;  ///< of the first taker
  std::vector<StudyUnit> units;
  std::unique_ptr<UnitDealer> dealer;  ///< there once units are known
  std::set<std::string> left;          ///< units whose results are not known
  std::size_t all_units = 0;           ///< of these, at the beginning
  std::size_t units_of_others = 0;     ///< units that others than the first taker have computed
  bool is_abandoned = false;           ///< records may be gone
  std::mutex preparing;                ///< libraries that read files take one thread at a time

  /// Prepares the study, deals it, and computes units for the first taker.
  void compute(std::size_t takers);
  /// Computes units of a study that compute() has prepared on another device.
  void help(const Device& other, std::size_t taker);
  /// Takes the result of a unit from another taker.
  void take(const std::string& name, const std::string& content);

 private:
  [[nodiscard]] UnitStore store(std::size_t taker);
  [[nodiscard]] ProgressCallback report() const;
  [[nodiscard]] UnitSource source(std::size_t taker);
};

}  // namespace lobe
