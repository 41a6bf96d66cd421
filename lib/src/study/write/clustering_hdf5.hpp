#pragma once

#include <string>

#include "hdf5/hdf5.hpp"
#include "lobe/cluster/clustering.hpp"
#include "lobe/study/study.hpp"

namespace lobe {

/// Writes tree, clusters, medoids and neighbours into the group of a lighting (docs/file-formats.md).
/// \param material the axis of the materials
/// \param unit of the distances
void write_clustering(hid_t group, const Study& study, const Clustering& clustering, const hdf5::Dataset& material,
                      const std::string& unit);

}  // namespace lobe
