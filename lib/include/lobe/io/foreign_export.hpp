#pragma once

#include <string_view>

#include "lobe/table/brdf_function.hpp"

namespace lobe {

/// Whether a format of save_measured() holds averages over cells, with delta parts, rather than samples. False for
/// formats that are not known.
[[nodiscard]] bool holds_cells(std::string_view format);

/// How far a reflectance is from another one, at pseudo-random pairs of directions up to 75 degrees.
struct Deviation {
  double median = 0;  ///< of |difference| / |value| where there is a value, over all channels
  double rms = 0;     ///< root mean square of the difference over that of the value
};

/// \param exact what `found` is held against. \throws NumericError where `found` has fewer channels.
[[nodiscard]] Deviation deviation(const BrdfFunction& exact, const BrdfFunction& found);

}  // namespace lobe
