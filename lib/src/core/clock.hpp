#pragma once

#include <string>

namespace lobe {

/// Now, or what SOURCE_DATE_EPOCH says (reproducible-builds.org), as ISO 8601 text in UTC.
/// \throws ArgumentError when that variable is no whole number of seconds.
[[nodiscard]] std::string time_of_writing();

}  // namespace lobe
