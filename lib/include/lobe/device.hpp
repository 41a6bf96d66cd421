#pragma once

/// \file
/// OpenCL devices, and whether they compute rightly.

#include "lobe/device/device.hpp"     // choosing an OpenCL device
#include "lobe/device/self_test.hpp"  // whether a device computes rightly
