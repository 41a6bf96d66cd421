#pragma once

#include <cstddef>
#include <functional>

namespace lobe {

/// Calls work(0) .. work(count - 1), in any order, on all cores; within a call of another one's work, on its thread
/// alone.
/// \throws the first exception of `work`, once all calls under way have ended; no further ones are begun.
void parallel_for(std::size_t count, const std::function<void(std::size_t)>& work);

/// Calls work(begin, end) for pieces of 0 .. count, of `size` each, the last one possibly shorter, as parallel_for()
/// does: for work so small that a call for each would cost more than it does. `end` does not belong to its piece.
/// \param size at least 1
/// \throws the first exception of `work`, as parallel_for().
void parallel_for_pieces(std::size_t count, std::size_t size,
                         const std::function<void(std::size_t begin, std::size_t end)>& work);

}  // namespace lobe
