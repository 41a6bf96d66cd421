#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "formats/byte_reader.hpp"

namespace lobe {

/// Datasets of 32-bit numbers in an HDF5 file of the plainest layout, which is what programs write unless told
/// otherwise: groups with symbol tables, data in one piece. Read without the HDF5 library, which crashes on damaged
/// files. Source: The HDF Group, "HDF5 File Format Specification Version 3.0".
class PlainHdf5 {
 public:
  /// \throws IoError for other layouts and damaged files, as all members
  explicit PlainHdf5(const FileBytes& file);

  /// The numbers of a dataset that must have this shape.
  /// \param path "/group/dataset"
  [[nodiscard]] std::vector<double> read(std::string_view path, std::span<const std::size_t> shape) const;

 private:
  /// Where the header of an object lies.
  using Address = std::uint64_t;
  struct Message {
    std::size_t begin;
    std::size_t size;
  };

  [[nodiscard]] ByteReader reader_at(Address address, std::string_view what) const;
  [[nodiscard]] ByteReader block_at(Address address, std::string_view signature) const;
  [[nodiscard]] Message message(Address object, std::uint16_t type, std::string_view what) const;
  [[nodiscard]] Address find(Address group, std::string_view name) const;

  const FileBytes& file_;
  Address root_ = 0;
};

}  // namespace lobe
