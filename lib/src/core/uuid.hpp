#pragma once

#include <string>
#include <string_view>

namespace lobe {

/// A UUID of version 8 (RFC 9562) that follows from a text: the same text has the same.
[[nodiscard]] std::string uuid_of(std::string_view text);

}  // namespace lobe
