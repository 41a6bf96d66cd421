#pragma once

#include <string>

#include "lobe/formats/measured.hpp"

namespace lobe {

/// Content of a tensor file with the values of a function, and densities that renderers sample it by: at the nodes of
/// the light's angles the file has its values exactly, but for single precision.
/// \throws ArgumentError for channels that the format does not hold, and numbers of nodes that are too small or make
///   too large a file; NumericError for values that are not finite; Cancelled
[[nodiscard]] std::string write_rgl(const BrdfFunction& brdf, const WriteOptions& options);

}  // namespace lobe
