#pragma once

#include "hdf5/hdf5.hpp"
#include "lobe/study/study.hpp"

namespace lobe {

/// Axes of the root group that comparison metrics share with lightings.
struct ComparisonAxes {
  const hdf5::Dataset& material;
  const hdf5::Dataset& material_other;
  const hdf5::Dataset& channel;
};

/// Writes the group `comparison`, with a group per comparison metric; none where the study asks for none
/// (docs/file-formats.md).
void write_comparisons(hid_t root, const StudyResult& result, const ComparisonAxes& axes);

/// Writes the group `agreement`; none where there is nothing to agree on.
void write_agreement(hid_t root, const MetricAgreement& agreement);

}  // namespace lobe
