#pragma once

#include "hdf5/hdf5.hpp"
#include "lobe/study/study.hpp"

namespace lobe {

/// Writes the group `charts` with a group per chart; nothing for studies without charts.
void write_charts(hid_t root, const StudyResult& result);

}  // namespace lobe
