#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace lobe::test {

/// Checkpoints of running studies. The first byte says what the rest is: of 0 bytes as they are, of 1 what follows the
/// head of our own file, else the content of a result under a checksum that fits. Whatever is taken from it is of as
/// many materials as the study has, and is written again as the same bytes.
void fuzz_checkpoint(std::span<const std::uint8_t> data);

/// What a study of fuzz_checkpoint() writes, for seeds.
[[nodiscard]] std::vector<std::string> checkpoint_seeds();

}  // namespace lobe::test
