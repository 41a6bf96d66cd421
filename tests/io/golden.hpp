#pragma once

#include <string>

namespace lobe::test {

/// Blanks what depends on versions of libraries and on the build, and computed numbers, whose last digits may.
[[nodiscard]] std::string without_versions(const std::string& text);

/// Puts what stands in innermost braces on one line.
[[nodiscard]] std::string compact(const std::string& text);

/// Fails with the first line that differs from tests/golden/NAME.
void expect_golden(const std::string& name, const std::string& text);

}  // namespace lobe::test
