#pragma once

#include <string_view>

namespace lobe::test {

/// A text as a formula: refused with one clear line, or written out so that it reads back as the same. What reaches the
/// compiler has no character but those of its statements. Anything else ends the process.
void fuzz_formula(std::string_view text);

}  // namespace lobe::test
