#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace lobe::test {

/// Files of shards. The first byte says what the rest is: of 0 bytes as they are, else what follows the mark, under a
/// size and a checksum that fit. Whatever is read from it is written again as a file with the same head and records.
void fuzz_shard(std::span<const std::uint8_t> data);

/// What shards of fuzz_shard() write, for seeds.
[[nodiscard]] std::vector<std::string> shard_seeds();

}  // namespace lobe::test
