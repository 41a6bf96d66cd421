#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "lobe/core/error.hpp"
#include "lobe/core/progress.hpp"
#include "lobe/device/device.hpp"
#include "lobe/study/checkpoint.hpp"
#include "lobe/study/study.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// A text from another rank.
struct RankMessage {
  std::size_t from = 0;  ///< rank that has sent it
  std::string text;      ///< any bytes
};

/// Processes that compute a study together, such as those that mpirun starts, as seen by one of them, and how they
/// exchange texts. The library needs no MPI: the command implements this class where it was built with it. Texts of one
/// rank arrive in the order in which they were sent. One thread uses the object.
class Ranks {
 public:
  Ranks() = default;
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;
  virtual ~Ranks() = default;

  /// Rank of this process, from 0 on.
  [[nodiscard]] virtual std::size_t rank() const = 0;
  /// Number of processes.
  [[nodiscard]] virtual std::size_t count() const = 0;
  /// Name of a rank's machine, for messages.
  [[nodiscard]] virtual std::string host(std::size_t rank) const = 0;
  /// Sends a text to another rank, without waiting until it is taken.
  /// \throws DeviceError if that fails
  virtual void send(std::size_t to, std::string text) = 0;
  /// Takes the next text that has come from any rank; waits for one if there is none.
  /// \param patience how long to wait at most
  /// \throws DeviceError if that fails; rank_has_ended() or rank_is_silent() if the rest of a text does not come
  [[nodiscard]] virtual std::optional<RankMessage> receive(std::chrono::milliseconds patience) = 0;
  /// Whether the process of another rank is known to have ended. False does not say that it runs.
  [[nodiscard]] virtual bool has_ended(std::size_t rank) const = 0;
  /// Leaves the others; nothing is sent or received afterwards.
  /// \param all_leave whether all others are known to leave as well, so that the end may be waited for
  virtual void leave(bool all_leave) = 0;
};

/// Error for a study one of whose ranks has ended, even in the middle of a text.
[[nodiscard]] DeviceError rank_has_ended(const Ranks& ranks, std::size_t rank);

/// Error for a study one of whose ranks has said nothing, or not the rest of a text, for some time.
[[nodiscard]] DeviceError rank_is_silent(const Ranks& ranks, std::size_t rank, std::chrono::milliseconds since);

/// Traffic between the rank or device that completes a study and the others.
struct RankTraffic {
  std::uint64_t received_bytes = 0;  ///< texts from other ranks, of which nearly all are results
  std::uint64_t sent_bytes = 0;      ///< texts to other ranks
  std::size_t units = 0;             ///< units of the study that were computed
  std::size_t units_of_others = 0;   ///< units among them that other ranks or devices computed
};

/// Options for computing a study by several ranks or devices.
struct CrewOptions {
  ProgressCallback progress = {};  ///< told of the progress of this process; may cancel
  std::function<void(std::size_t)> kept =
      {};  ///< told how many results the checkpoint has, first and then of each more
  std::function<void(const RankTraffic&)> done = {};  ///< told of the traffic once all units are known
};

/// Computes a study with other ranks, of which each calls help_run_study(). The units of the study, those of its
/// shards, are handed out one after the other, so that whoever is quick computes more; this rank computes units as
/// well. The result is that of run_study(), to the last bit, but for the times of its stages. Every unit is kept in the
/// checkpoint as soon as it is known. Whether this succeeds or fails, the other ranks are sent away, and this one
/// leaves.
/// \param checkpoint provides results and keeps new ones; null: none does
/// \throws as run_study() for any rank; DeviceError if a rank ends or falls silent, IoError if one sees another study,
///   or has another build or device
[[nodiscard]] StudyResult run_study(const Device& device, const Study& study, Checkpoint* checkpoint, Ranks& ranks,
                                    const CrewOptions& options = {});

/// Computes a study on several devices of one kind. Each takes units as soon as it is free, so that whichever is quick
/// computes more. The result is that of run_study() on the first one, to the last bit, but for the times of its stages.
/// Every unit is kept in the checkpoint as soon as it is known. If this throws, a thread may still be at a unit that
/// nobody wants any more; a program should end soon then.
/// \param checkpoint provides results and keeps new ones; null: none does
/// \throws as run_study(); ArgumentError without devices; DeviceError if they are not all different and of one kind
[[nodiscard]] StudyResult run_study(const std::vector<Device>& devices, const Study& study, Checkpoint* checkpoint,
                                    const CrewOptions& options = {});

/// Computes units of a study for rank 0 until that has no more, and leaves. Failures, also those of `load`, are told to
/// rank 0, which throws them.
/// \param load loads the study that rank 0 computes; called unless rank 0 has nothing to do
/// \param progress may cancel
void help_run_study(const Device& device, const std::function<Study()>& load, Ranks& ranks,
                    const ProgressCallback& progress = {});

/// Sends all other ranks away, from rank 0 and instead of run_study(), and leaves.
void dismiss_ranks(Ranks& ranks);

}  // namespace lobe
