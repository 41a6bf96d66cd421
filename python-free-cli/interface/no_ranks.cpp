// In place of mpi/ranks_mpi.cpp where lobe is built without MPI.
#include <fmt/format.h>

#include "interface/ranks.hpp"
#include "lobe/core/error.hpp"

namespace lobe::cli {

std::unique_ptr<Ranks> join_ranks() {
  const Launched own = launched();
  if (own.count < 2) return nullptr;
  throw ArgumentError(
      fmt::format("this is one of {} processes that were launched together, and lobe was built without MPI; build it "
                  "with LOBE_MPI=ON, or compute shards (--shard)",
                  own.count));
}

}  // namespace lobe::cli
