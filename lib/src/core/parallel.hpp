#pragma once

#include <cstddef>
#include <functional>

namespace lobe {

/// Calls work(0) .. work(count - 1), in any order, on all cores; within a call of another one's work, on its thread
/// alone.
/// \throws the first exception of `work`, once all calls under way have ended; no further ones are begun.
void parallel_for(std::size_t count, const std::function<void(std::size_t)>& work);

}  // namespace lobe
