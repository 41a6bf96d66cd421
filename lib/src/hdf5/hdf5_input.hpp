#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "hdf5/hdf5.hpp"

namespace lobe::hdf5 {

/// The count of numbers in a dataset of that shape.
[[nodiscard]] std::size_t volume(std::span<const hsize_t> shape);

/// An HDF5 file that is read. Every failure is an IoError that names the file and the object in it. What lies in other
/// files (external links, external and virtual datasets) is refused, and so are datasets of more values than the file
/// can hold, before memory is taken for them.
class InputFile {
 public:
  explicit InputFile(const std::filesystem::path& path);

  /// \param object absolute path
  [[nodiscard]] bool has(const std::string& object) const;
  [[nodiscard]] bool has_attribute(const std::string& object, const char* name) const;
  /// A text of one line or several. Control characters other than those of layout are refused in all texts and names.
  [[nodiscard]] std::string text(const std::string& object, const char* attribute) const;
  /// A text of one line, such as a name.
  [[nodiscard]] std::string line(const std::string& object, const char* attribute) const;
  /// The texts of an attribute: those of an array, or the lines of a single one.
  [[nodiscard]] std::vector<std::string> text_list(const std::string& object, const char* attribute) const;
  [[nodiscard]] double number(const std::string& object, const char* attribute) const;

  /// Names of the groups within a group, in the order in which they were made.
  [[nodiscard]] std::vector<std::string> groups(const std::string& parent) const;

  /// Absolute paths of the datasets of numbers in the whole file.
  [[nodiscard]] std::vector<std::string> numeric_datasets() const;
  /// Bytes that the numbers of a dataset take in memory, once all of them have been read, some at a time: what of them
  /// is damaged is found.
  [[nodiscard]] std::uint64_t read_through(const std::string& dataset) const;

  [[nodiscard]] std::vector<hsize_t> shape(const std::string& dataset) const;
  /// Whether the numbers of a dataset have less than 64 bits.
  [[nodiscard]] bool is_narrow(const std::string& dataset) const;
  /// All texts (variable-length) of a dataset along one axis.
  [[nodiscard]] std::vector<std::string> texts(const std::string& dataset) const;
  /// Refuses a dataset of another shape, so that memory is taken for what is there only.
  void require_shape(const std::string& dataset, std::span<const hsize_t> shape) const;
  /// All numbers of a dataset that must have this shape.
  void read(const std::string& dataset, std::span<const hsize_t> shape, std::span<double> values) const;
  [[nodiscard]] std::vector<double> read(const std::string& dataset, std::span<const hsize_t> shape) const;
  /// The numbers of a box within a dataset; reads only the chunks it touches.
  [[nodiscard]] std::vector<double> read_box(const std::string& dataset, std::span<const hsize_t> offset,
                                             std::span<const hsize_t> count) const;

  /// \throws IoError "cannot read FILE: <complaint>"
  [[noreturn]] void refuse(const std::string& complaint) const;

 private:
  /// Members of a group with one HDF5 type, in the order of their creation.
  [[nodiscard]] std::vector<std::string> members(const std::string& parent, H5I_type_t type) const;
  [[nodiscard]] Dataset open_numbers(const std::string& dataset) const;
  [[nodiscard]] Attribute open_attribute(const std::string& object, const char* name) const;
  [[nodiscard]] Dataset open_dataset(const std::string& dataset) const;
  void require_plain(std::string text, const std::string& what) const;
  void require_stored(const Dataset& opened, const std::string& dataset) const;
  void require_stored(const Attribute& opened, const Type& type, const std::string& what) const;
  [[nodiscard]] hsize_t file_size() const;
  [[noreturn]] void refuse_damaged(const std::string& object) const;

  QuietErrors quiet_;
  std::string name_;
  File file_;
  Properties links_;
  Properties groups_;
  Properties datasets_;
};

}  // namespace lobe::hdf5
