#include "interface/ranks.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <optional>
#include <string_view>

namespace lobe::cli {
namespace {

/// Variables of a launcher.
struct Launcher {
  const char* rank;
  const char* count;
};
constexpr std::array kLaunchers{Launcher{"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"},
                                Launcher{"PMIX_RANK", "SLURM_STEP_NUM_TASKS"}, Launcher{"PMI_RANK", "PMI_SIZE"}};

std::optional<std::size_t> number_in_environment(const char* name) {
  const char* value = std::getenv(name);
  if (value == nullptr) return {};
  const std::string_view text = value;
  std::size_t number = 0;
  const auto [end, failed] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (failed != std::errc() || end != text.data() + text.size()) return {};
  return number;
}

}  // namespace

Launched launched() {
  for (const Launcher& launcher : kLaunchers) {
    const auto rank = number_in_environment(launcher.rank);
    const auto count = number_in_environment(launcher.count);
    if (rank && count && *rank < *count) return {*rank, *count};
  }
  return {};
}

bool is_silent_rank(const std::vector<std::string>& words) {
  if (launched().rank == 0) return false;
  // Shards know nothing of each other, whoever starts them.
  const auto is_shard = [](const std::string& word) { return word == "--shard" || word.starts_with("--shard="); };
  return std::ranges::find(words, "run") != words.end() && std::ranges::none_of(words, is_shard);
}

}  // namespace lobe::cli
