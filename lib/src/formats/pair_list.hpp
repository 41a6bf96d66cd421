#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formats/file_bytes.hpp"
#include "lobe/core/directions.hpp"

namespace lobe {

/// Consecutive pairs of a list.
struct PairBlock {
  std::vector<double> numbers;         ///< as the file has them, rows x columns that are read
  std::vector<Directions> directions;  ///< of each row
  double largest_angle = 0;            ///< by size, as the file has it; of vectors 0
};

/// A list of pairs of directions in a file, as evaluate_pairs() describes it.
class PairList {
 public:
  /// \param radians of angles without a unit
  /// \throws IoError, ArgumentError as evaluate_pairs(), but for what is wrong with a row
  PairList(const std::filesystem::path& path, bool radians);

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] std::size_t blocks() const { return blocks_.size(); }
  /// Index of a block's first pair.
  [[nodiscard]] std::size_t first(std::size_t block) const { return blocks_[block].first; }
  /// Reads a block in place of what was there. May be called from several threads.
  /// \throws IoError for a row that is no pair
  void read(std::size_t index, PairBlock& block) const;

  /// Names of the columns that are read, with their unit.
  [[nodiscard]] const std::vector<std::string>& columns() const { return names_; }
  /// Angles whose unit nobody has said.
  [[nodiscard]] bool lacks_unit() const { return lacks_unit_; }

  static constexpr std::size_t kRoles = 11;
  static constexpr std::size_t kBlock = 8192;  ///< pairs of a block: enough for a device, small beside any memory

 private:
  /// Where the rows of a block begin in the file.
  struct Place {
    std::size_t offset = 0;
    std::size_t line = 0;  ///< that begins there, from 1 on
    std::size_t first = 0;
  };

  void read_names(std::span<const std::string_view> names, std::size_t line, bool radians);
  void assume_columns(std::size_t count, std::size_t line, bool radians);
  void add_column(std::size_t role, std::size_t place, double unit);
  void place_blocks(std::size_t offset, std::size_t line);
  void read_text(bool radians);
  void read_array(bool radians);
  void add_row(std::string_view text, std::size_t line, PairBlock& block) const;
  void add_row(std::span<const double> numbers, std::size_t row, PairBlock& block) const;
  [[nodiscard]] Directions directions_of(std::span<const double> numbers, std::size_t row) const;
  /// \param row line of a text, row of an array, from 1 on
  [[noreturn]] void refuse(std::size_t row, std::string_view complaint) const;

  FileBytes file_;
  bool is_array_ = false;
  std::size_t numbers_at_ = 0;  // where the file has the numbers of an array, by rows; else 0
  std::vector<double> values_;  // of another array
  char separator_ = ' ';        // of a text
  std::vector<std::string> names_;
  std::vector<std::size_t> places_;          // in a row of the file, of the columns that are read
  std::size_t cells_ = 0;                    // of a row of the file
  std::array<std::size_t, kRoles> where_{};  // a role among the columns that are read
  std::array<double, kRoles> units_{};       // radians of 1
  bool is_vectors_ = false;
  bool lacks_unit_ = false;
  std::size_t size_ = 0;
  std::vector<Place> blocks_;
};

}  // namespace lobe
