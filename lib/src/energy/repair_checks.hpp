#pragma once

#include <cstddef>
#include <string_view>

#include "energy/repair.hpp"

namespace lobe {

/// \throws ArgumentError
void require_valid(const PumpOptions& options);

/// \param what is to be done, as a participle.
/// \throws NumericError for a value below 0 by more than its error.
void require_non_negative(const BrdfTable& table, std::size_t channel, std::string_view what);

}  // namespace lobe
