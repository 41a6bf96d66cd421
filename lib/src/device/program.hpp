#pragma once

#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "device/opencl.hpp"
#include "lobe/device/device.hpp"

namespace lobe {

/// A part of a program: a file by its path below kernels/, or a text where the path is empty.
struct KernelText {
  std::string file;
  std::string text = {};
};

/// A file below kernels/, as it is in this build.
struct KernelFile {
  std::string name;
  std::string_view text;
};

/// Files with what their headers include, which comes first; each file once.
/// \throws DeviceError for a file that this build lacks
[[nodiscard]] std::vector<KernelFile> with_includes(std::span<const std::string> files);

/// Builds (or finds, if built before on this device) the program that concatenates the parts, in the order of their
/// #include lines; what a header (.clh) includes comes before it by itself. The last part is a file.
/// \param options preprocessor definitions, "-D NAME=VALUE"; REAL_BITS and REAL_WIDTH are added here
/// \throws DeviceError with the compiler's log when it does not build
[[nodiscard]] cl::Program build_program(const Device& device, const std::vector<KernelText>& parts, Precision precision,
                                        const std::string& options = {});

/// Builds a program whose parts are all files.
[[nodiscard]] cl::Program build_program(const Device& device, std::initializer_list<std::string_view> files,
                                        Precision precision, const std::string& options = {});

/// A kernel of such a program.
/// \throws DeviceError when the number of arguments is not the one expected.
[[nodiscard]] cl::Kernel make_kernel(const cl::Program& program, const char* name, unsigned arguments);

}  // namespace lobe
