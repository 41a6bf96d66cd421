#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

#include "lobe/core/error.hpp"
#include "lobe/study/ranks.hpp"
#include "study/run/checkpoint_implementation.hpp"
#include "study/run/completed_study.hpp"
#include "study/run/crew_work.hpp"

namespace lobe {
namespace {

/// \throws DeviceError where results would depend on who has computed them
void require_one_kind(const std::vector<Device>& devices) {
  const DeviceInfo& first = devices.front().info();
  for (std::size_t k = 1; k < devices.size(); ++k) {
    const DeviceInfo& info = devices[k].info();
    const auto is_same = [&](const Device& other) { return other.info().selector == info.selector; };
    if (std::any_of(devices.begin(), devices.begin() + static_cast<std::ptrdiff_t>(k), is_same)) {
      throw DeviceError(fmt::format("device {} is named twice; name each once", info.selector));
    }
    if (info.name == first.name && info.driver == first.driver && info.platform_version == first.platform_version) {
      continue;
    }
    throw DeviceError(
        fmt::format("devices {} ({}) and {} ({}) are of different kinds, so that results would depend on "
                    "which of them has computed what; name devices of one kind",
                    first.selector, first.name, info.selector, info.name));
  }
}

/// Throws what threads have thrown, a cancellation only if there is nothing else.
void rethrow_first(const std::vector<std::exception_ptr>& failures) {
  for (const bool takes_cancelled : {false, true}) {
    for (const std::exception_ptr& failure : failures) {
      try {
        std::rethrow_exception(failure);
      } catch (const Cancelled&) {
        if (takes_cancelled) throw;
      }
    }
  }
}

}  // namespace

StudyResult run_study(const std::vector<Device>& devices, const Study& study, Checkpoint* checkpoint,
                      const CrewOptions& options) {
  if (devices.empty()) throw ArgumentError("there is no device to run the study on; expected one or more");
  require_one_kind(devices);
  RecordFile* file = nullptr;
  if (checkpoint != nullptr) {
    checkpoint->open(study, devices.front());
    file = &checkpoint->implementation_->file;
  }
  const auto work = std::make_shared<CrewWork>(devices.front(), study, file);
  work->state->progress = options.progress;
  std::vector<std::unique_ptr<ComputingThread>> threads;
  const std::size_t takers = devices.size();
  threads.push_back(std::make_unique<ComputingThread>(work->state, [work, takers] { work->compute(takers); }));
  for (std::size_t k = 1; k < takers; ++k) {
    threads.push_back(
        std::make_unique<ComputingThread>(work->state, [work, device = devices[k], k] { work->help(device, k); }));
  }
  std::optional<std::size_t> told;
  std::vector<std::exception_ptr> failures;
  const auto are_over = [&] { return std::ranges::all_of(threads, &ComputingThread::is_over); };
  for (bool is_over = false; !is_over && failures.empty();) {
    is_over = are_over();
    for (const auto& thread : threads) {
      if (thread->is_over() && thread->failure()) failures.push_back(thread->failure());
    }
    std::size_t kept = 0;
    {
      const std::scoped_lock lock(work->state->mutex);
      kept = work->records.kept();
    }
    if (kept != told && options.kept) options.kept(kept);
    told = kept;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  threads.clear();
  if (!failures.empty()) {
    {
      // Work that goes on without anybody waiting must not touch the caller's checkpoint.
      const std::scoped_lock lock(work->state->mutex);
      work->is_abandoned = true;
    }
    rethrow_first(failures);
  }
  if (options.done) options.done({.units = work->all_units, .units_of_others = work->units_of_others});
  return completed_study(work->device, *work->computation);
}

}  // namespace lobe
