#pragma once

#include <span>
#include <string>

#include "hdf5/hdf5.hpp"
#include "lobe/metric/metric.hpp"
#include "lobe/model/label.hpp"

namespace lobe {

/// Writes the pairs that did not reach the tolerance into the group of a lighting or of a comparison metric
/// (docs/file-formats.md).
/// \param quantity what did not reach it: "product" or "distance"
void write_unresolved(hid_t group, std::span<const Unresolved> unresolved, std::span<const MaterialLabel> materials,
                      const std::string& quantity);

}  // namespace lobe
