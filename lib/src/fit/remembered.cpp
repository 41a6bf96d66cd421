#include "fit/remembered.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

namespace lobe {
namespace {

/// Pairs that were asked for together, and their values.
struct Answer {
  std::vector<Directions> pairs;
  BrdfValues values;
};

std::uint64_t hash_of(std::span<const Directions> pairs) {
  std::uint64_t hash = pairs.size();
  const auto mix = [&](double x) { hash = std::rotl(hash ^ std::bit_cast<std::uint64_t>(x), 29) * 0x9e3779b97f4a7c15; };
  for (const Directions& pair : pairs) {
    mix(pair.theta_in);
    mix(pair.theta_out);
    mix(pair.delta_phi);
    mix(pair.phi_in);
  }
  return hash;
}

bool are_equal(std::span<const Directions> a, std::span<const Directions> b) {
  return std::ranges::equal(a, b, [](const Directions& x, const Directions& y) {
    return x.theta_in == y.theta_in && x.theta_out == y.theta_out && x.delta_phi == y.delta_phi && x.phi_in == y.phi_in;
  });
}

class Memory {
 public:
  Memory(std::function<BrdfValues(std::span<const Directions>)> at, std::size_t bytes)
      : at_(std::move(at)), left_(bytes) {}

  BrdfValues at(std::span<const Directions> pairs) {
    const std::uint64_t hash = hash_of(pairs);
    if (auto known = find(hash, pairs)) return *std::move(known);
    BrdfValues values = at_(pairs);  // threads do not wait for each other
    if (find(hash, pairs)) return values;
    constexpr std::size_t kEach = 128;
    const auto numbers = static_cast<std::size_t>(values.value.size() + values.error.size());
    const std::size_t bytes = kEach + pairs.size_bytes() + sizeof(double) * numbers;
    const std::scoped_lock lock(mutex_);
    if (bytes > left_) return values;
    left_ -= bytes;
    answers_.emplace(hash, Answer{{pairs.begin(), pairs.end()}, values});
    return values;
  }

 private:
  [[nodiscard]] std::optional<BrdfValues> find(std::uint64_t hash, std::span<const Directions> pairs) {
    const std::scoped_lock lock(mutex_);
    const auto [begin, end] = answers_.equal_range(hash);
    const auto found =
        std::find_if(begin, end, [&](const auto& known) { return are_equal(known.second.pairs, pairs); });
    if (found == end) return std::nullopt;
    return found->second.values;
  }

  std::function<BrdfValues(std::span<const Directions>)> at_;
  std::size_t left_;
  std::mutex mutex_;
  std::unordered_multimap<std::uint64_t, Answer> answers_;
};

}  // namespace

BrdfFunction remembered(BrdfFunction function, std::size_t bytes) {
  const auto memory = std::make_shared<Memory>(std::move(function.at), bytes);
  function.at = [memory](std::span<const Directions> pairs) { return memory->at(pairs); };
  return function;
}

}  // namespace lobe
