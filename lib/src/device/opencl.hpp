#pragma once

// The one place that includes opencl.hpp; its macros are set by the build (cmake/dependencies.cmake).
#include <CL/opencl.hpp>
