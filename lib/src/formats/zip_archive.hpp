#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "formats/file_bytes.hpp"

struct zip;

namespace lobe {

/// A zip archive in memory, as of numpy.savez.
class ZipArchive {
 public:
  /// \throws IoError where it is damaged
  explicit ZipArchive(const FileBytes& file);

  /// Names of its members, in the order of the archive.
  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }

  /// The content of a member, which complaints call FILE/NAME. It is unpacked twice, so that its size is known before
  /// memory is taken.
  /// \param index among names().
  /// \param limit on its size
  /// \throws IoError where it is damaged, encrypted, packed in another way than zlib knows, or larger
  [[nodiscard]] FileBytes read(std::size_t index, std::size_t limit = FileBytes::kMostUnpacked) const;

 private:
  const FileBytes& file_;
  std::unique_ptr<zip, void (*)(zip*)> archive_;
  std::vector<std::string> names_;
};

}  // namespace lobe
