#pragma once

#include "lobe/table/table.hpp"

namespace lobe {

/// integral(f^2 dmu dmu) of the smooth part of a channel, by the table's grid.
[[nodiscard]] double squared_norm(const BrdfTable& table, std::size_t channel);

}  // namespace lobe
