#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace lobe::test {

/// Files of our own HDF5 schemas. Of any bytes flipped the checksum speaks, and past it HDF5, which is not ours and
/// crashes on what was made to crash it (SECURITY.md); here the file is sound, and what it says is not: `data` is a
/// list of changes to the attributes and datasets of a file that was written by us, made by HDF5 itself.
void fuzz_table(std::span<const std::uint8_t> data);
void fuzz_results(std::span<const std::uint8_t> data);
void fuzz_modes(std::span<const std::uint8_t> data);

/// The bytes of a table as they are, or, where `is_sealed`, under a checksum that fits them.
void fuzz_table_bytes(std::span<const std::uint8_t> data, bool is_sealed);

/// A table's file, for seeds.
[[nodiscard]] std::string sound_table_file();

}  // namespace lobe::test
