#pragma once

#include <string>

#include "lobe/formats/measured.hpp"

namespace lobe {

/// Content of a tensor tree file: averages over the leaves, weighted by projected solid angle, in single precision.
/// Isotropic functions get trees of three dimensions, others of four, all leaves of one size.
/// \throws ArgumentError for numbers of leaves that are no power of two or out of range; NumericError for values that are
///   not finite; Cancelled
[[nodiscard]] std::string write_tensor_tree(const BrdfFunction& brdf, const WriteOptions& options);

}  // namespace lobe
