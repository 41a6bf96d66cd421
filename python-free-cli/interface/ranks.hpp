#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "lobe/study/ranks.hpp"

// Processes that mpirun or srun starts together compute one study.
namespace lobe::cli {

/// Which of how many processes this one is, by the environment that a launcher makes.
struct Launched {
  std::size_t rank = 0;
  std::size_t count = 1;
};
[[nodiscard]] Launched launched();

/// Whether another process of the same `lobe run` speaks for this one.
/// \param words of the command line
[[nodiscard]] bool is_silent_rank(const std::vector<std::string>& words);

/// Joins the ranks that were launched together, and takes this one's share of the machine's processors; null: there is
/// one process alone. Built without MPI it only tells that.
/// \throws ArgumentError if there are several and lobe was built without MPI; DeviceError if MPI fails
[[nodiscard]] std::unique_ptr<Ranks> join_ranks();

}  // namespace lobe::cli
