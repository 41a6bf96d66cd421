#pragma once

#include <string>

namespace lobe {

/// Tells builds of this code from each other, also those of sources that were not committed: the build ID that the
/// linker made from the program's content, in hexadecimal digits. It is the same wherever the same file is installed.
/// Where the linker made none, the size and the time of the file with this code.
[[nodiscard]] std::string build_identity();

}  // namespace lobe
