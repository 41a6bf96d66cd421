#pragma once

#include "hdf5/hdf5.hpp"
#include "lobe/study/study.hpp"

namespace lobe {

/// Writes the group `published` with a dataset per column of published_csv(); nothing for studies without such figures.
void write_published(hid_t root, const StudyResult& result);

}  // namespace lobe
