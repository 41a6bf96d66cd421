// Ranks by MPI, the only source that sees it.
#include <fmt/format.h>
#include <mpi.h>
#include <sched.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <climits>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <list>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "interface/ranks.hpp"
#include "lobe/core/error.hpp"

namespace lobe::cli {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr int kSizeTag = 1;
constexpr int kBytesTag = 2;
constexpr std::size_t kPart = std::size_t{1} << 30;  // MPI counts with an int
// MPI waits by asking without end, which would take a processor from whoever computes.
constexpr std::chrono::microseconds kPause{200};
// For a part of a text whose beginning has come; ranks that hear nothing of rank 0 meanwhile leave after six seconds.
constexpr milliseconds kTransfer{5000};

/// \throws DeviceError
void check(int code, const char* what) {
  if (code == MPI_SUCCESS) return;
  std::array<char, MPI_MAX_ERROR_STRING> text{};
  int length = 0;
  MPI_Error_string(code, text.data(), &length);
  throw DeviceError(fmt::format("MPI cannot {}: {}; check that all ranks are still there", what,
                                std::string_view(text.data(), static_cast<std::size_t>(length))));
}

/// Where a rank runs.
struct Seat {
  std::array<char, 256> host{};
  std::int64_t process = 0;
};

class MpiRanks : public Ranks {
 public:
  MpiRanks() {
    int level = 0;
    check(MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &level), "begin");
    MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN);
    int number = 0;
    check(MPI_Comm_rank(MPI_COMM_WORLD, &number), "number the ranks");
    rank_ = static_cast<std::size_t>(number);
    check(MPI_Comm_size(MPI_COMM_WORLD, &number), "count the ranks");
    seats_.resize(static_cast<std::size_t>(number));
    Seat own{.process = ::getpid()};
    ::gethostname(own.host.data(), own.host.size() - 1);
    check(MPI_Allgather(&own, sizeof own, MPI_BYTE, seats_.data(), sizeof own, MPI_BYTE, MPI_COMM_WORLD),
          "introduce the ranks");
    // Processes of other containers may have names of this one's machine, and numbers that mean nothing here.
    for (const Seat& seat : seats_) {
      is_near_.push_back(seat.host == own.host && ::kill(static_cast<pid_t>(seat.process), 0) == 0);
    }
    share_processors();
  }

  [[nodiscard]] std::size_t rank() const override { return rank_; }
  [[nodiscard]] std::size_t count() const override { return seats_.size(); }
  [[nodiscard]] std::string host(std::size_t rank) const override { return seats_.at(rank).host.data(); }

  void send(std::size_t to, std::string text) override {
    std::erase_if(sending_, [](Sending& sending) { return sending.is_done(); });
    Sending& sending = sending_.emplace_back(std::move(text));
    const int target = static_cast<int>(to);
    check(MPI_Isend(&sending.size, 1, MPI_UINT64_T, target, kSizeTag, MPI_COMM_WORLD, &sending.next()), "send");
    for (std::size_t at = 0; at < sending.text.size(); at += kPart) {
      const auto part = static_cast<int>(std::min(kPart, sending.text.size() - at));
      check(MPI_Isend(sending.text.data() + at, part, MPI_BYTE, target, kBytesTag, MPI_COMM_WORLD, &sending.next()),
            "send");
    }
  }

  [[nodiscard]] std::optional<RankMessage> receive(milliseconds patience) override {
    const auto end = Clock::now() + patience;
    while (true) {
      int has_come = 0;
      MPI_Status status{};
      check(MPI_Iprobe(MPI_ANY_SOURCE, kSizeTag, MPI_COMM_WORLD, &has_come, &status), "look for texts");
      if (has_come != 0) return text_from(status.MPI_SOURCE);
      if (Clock::now() >= end) return {};
      std::this_thread::sleep_for(kPause);
    }
  }

  [[nodiscard]] bool has_ended(std::size_t rank) const override {
    return is_near_.at(rank) && ::kill(static_cast<pid_t>(seats_[rank].process), 0) != 0 && errno == ESRCH;
  }

  void leave(bool all_leave) override {
    if (!all_leave) return;  // to wait for the others would have no end
    while (!sending_.empty()) {
      std::erase_if(sending_, [](Sending& sending) { return sending.is_done(); });
      std::this_thread::sleep_for(kPause);
    }
    MPI_Finalize();
    // What is left to do is this process' alone.
    if (rank_ == 0 && CPU_COUNT(&given_) > 0) static_cast<void>(::sched_setaffinity(0, sizeof given_, &given_));
  }

 private:
  /// A text on its way.
  struct Sending {
    explicit Sending(std::string bytes) : text(std::move(bytes)), size(text.size()) {}
    MPI_Request& next() { return requests.emplace_back(MPI_REQUEST_NULL); }
    [[nodiscard]] bool is_done() {
      int are_done = 0;
      MPI_Testall(static_cast<int>(requests.size()), requests.data(), &are_done, MPI_STATUSES_IGNORE);
      return are_done != 0;
    }
    std::string text;
    std::uint64_t size;
    std::vector<MPI_Request> requests;
  };

  RankMessage text_from(int source) {
    std::uint64_t size = 0;
    check(MPI_Recv(&size, 1, MPI_UINT64_T, source, kSizeTag, MPI_COMM_WORLD, MPI_STATUS_IGNORE), "receive");
    RankMessage message{.from = static_cast<std::size_t>(source), .text = std::string(size, '\0')};
    for (std::size_t at = 0; at < size; at += kPart) {
      MPI_Request request = MPI_REQUEST_NULL;
      const auto part = static_cast<int>(std::min<std::size_t>(kPart, size - at));
      check(MPI_Irecv(message.text.data() + at, part, MPI_BYTE, source, kBytesTag, MPI_COMM_WORLD, &request),
            "receive");
      await(request, source);
    }
    return message;
  }

  /// \throws DeviceError if the sender ends meanwhile or falls silent
  void await(MPI_Request& request, int source) {
    const auto end = Clock::now() + kTransfer;
    int is_done = 0;
    while (true) {
      const int code = MPI_Test(&request, &is_done, MPI_STATUS_IGNORE);
      if (code == MPI_SUCCESS && is_done != 0) return;
      if (has_ended(static_cast<std::size_t>(source))) throw rank_has_ended(*this, static_cast<std::size_t>(source));
      check(code, "receive");
      if (Clock::now() > end) throw rank_is_silent(*this, static_cast<std::size_t>(source), kTransfer);
      std::this_thread::sleep_for(kPause);
    }
  }

  /// Ranks of a machine that may run on the same processors take a part of them each, before OpenCL counts those.
  void share_processors() {
    cpu_set_t own;
    CPU_ZERO(&own);
    if (::sched_getaffinity(0, sizeof own, &own) != 0) return;
    MPI_Comm machine = MPI_COMM_NULL;
    check(MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine), "find the machines");
    int place = 0;
    int size = 0;
    MPI_Comm_rank(machine, &place);
    MPI_Comm_size(machine, &size);
    std::vector<cpu_set_t> all(static_cast<std::size_t>(size));
    check(MPI_Allgather(&own, sizeof own, MPI_BYTE, all.data(), sizeof own, MPI_BYTE, machine), "find the processors");
    MPI_Comm_free(&machine);

    std::size_t sharers = 0;
    std::size_t index = 0;
    for (std::size_t k = 0; k < all.size(); ++k) {
      if (!CPU_EQUAL(&all[k], &own)) continue;
      if (k < static_cast<std::size_t>(place)) ++index;
      ++sharers;
    }
    given_ = own;
    const auto processors = static_cast<std::size_t>(CPU_COUNT(&own));
    std::size_t part = 1;
    if (sharers <= processors) {
      const std::size_t first = index * processors / sharers;
      const std::size_t end = (index + 1) * processors / sharers;
      part = end - first;
      cpu_set_t mine;
      CPU_ZERO(&mine);
      for (std::size_t cpu = 0, seen = 0; cpu < CPU_SETSIZE; ++cpu) {
        if (!CPU_ISSET(cpu, &own)) continue;
        if (seen >= first && seen < end) CPU_SET(cpu, &mine);
        ++seen;
      }
      static_cast<void>(::sched_setaffinity(0, sizeof mine, &mine));
    }
    // Of PoCL 3 and 6; whoever has set them wants it so.
    for (const char* name : {"POCL_MAX_PTHREAD_COUNT", "POCL_CPU_MAX_CU_COUNT"}) {
      ::setenv(name, std::to_string(part).c_str(), 0);
    }
  }

  std::size_t rank_ = 0;
  std::vector<Seat> seats_;
  std::vector<bool> is_near_;
  std::list<Sending> sending_;  ///< MPI keeps addresses of theirs
  cpu_set_t given_{};           ///< processors before they were shared
};

}  // namespace

std::unique_ptr<Ranks> join_ranks() {
  if (launched().count < 2) return nullptr;
  auto ranks = std::make_unique<MpiRanks>();
  if (ranks->count() < 2) {
    ranks->leave(true);
    return nullptr;
  }
  return ranks;
}

}  // namespace lobe::cli
