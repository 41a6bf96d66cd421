#pragma once

#include <cstddef>

#include "lobe/table/brdf_function.hpp"

namespace lobe {

/// A function that answers what it was asked before from memory: searches ask a target for the same pairs again and
/// again.
/// \param bytes of pairs and values that are kept, the first ones
[[nodiscard]] BrdfFunction remembered(BrdfFunction function, std::size_t bytes);

}  // namespace lobe
