#include "lobe/core/version.hpp"

#include <H5public.h>

#include "build_commit.hpp"

namespace lobe {

std::string_view version() {
  return LOBE_VERSION;
}

std::string_view commit() {
  return kBuildCommit;
}

std::string_view opencl_headers_version() {
  return "1.2 (opencl.hpp)";
}

std::string_view hdf5_version() {
  return H5_VERS_INFO;
}

}  // namespace lobe
