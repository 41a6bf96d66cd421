#pragma once

#include "lobe/device/device.hpp"

namespace bench {

/// Products of matrices, as compositions of general tables are, against linear algebra libraries.
void run_dense(const lobe::Device& device, bool smoke);

/// Compositions of isotropic tables against the dense product of the same operator and against NumPy.
void run_isotropic(const lobe::Device& device, bool smoke);

}  // namespace bench
