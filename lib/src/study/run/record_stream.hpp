#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

namespace lobe {

/// Numbers and texts one after the other, as bytes.
class RecordWriter {
 public:
  void take(std::uint64_t number) { append(&number, sizeof number); }
  void take(double number) { append(&number, sizeof number); }
  void take(std::string_view text) {
    take(text.size());
    text_ += text;
  }
  template <typename Derived>
  void take(const Eigen::PlainObjectBase<Derived>& matrix) {
    take(static_cast<std::uint64_t>(matrix.rows()));
    take(static_cast<std::uint64_t>(matrix.cols()));
    append(matrix.data(), static_cast<std::size_t>(matrix.size()) * sizeof(double));
  }
  /// The numbers of a matrix without its sizes.
  void take_all(const Eigen::VectorXd& numbers) {
    append(numbers.data(), static_cast<std::size_t>(numbers.size()) * sizeof(double));
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  void append(const void* bytes, std::size_t count) { text_.append(static_cast<const char*>(bytes), count); }

  std::string text_;
};

/// Reads what a RecordWriter wrote; past the end, zeros.
class RecordReader {
 public:
  explicit RecordReader(std::string_view text) : rest_(text) {}

  [[nodiscard]] bool is_good() const { return is_good_; }
  [[nodiscard]] std::size_t left() const { return rest_.size(); }
  void take(std::uint64_t& number) { extract(&number, sizeof number); }
  void take(double& number) { extract(&number, sizeof number); }
  void take(std::string_view& text) {
    std::uint64_t size = 0;
    take(size);
    if (size > rest_.size()) return fail();
    text = rest_.substr(0, size);
    rest_.remove_prefix(size);
  }
  template <typename Derived>
  void take(Eigen::PlainObjectBase<Derived>& matrix) {
    std::uint64_t rows = 0;
    std::uint64_t columns = 0;
    take(rows);
    take(columns);
    constexpr std::uint64_t kMost = std::uint64_t{1} << 20U;
    if (rows > kMost || columns > kMost || rows * columns * sizeof(double) > rest_.size()) return fail();
    constexpr auto kColumns = static_cast<Eigen::Index>(Derived::ColsAtCompileTime);
    if (kColumns != Eigen::Dynamic && static_cast<Eigen::Index>(columns) != kColumns) return fail();
    matrix.resize(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(columns));
    extract(matrix.data(), rows * columns * sizeof(double));
  }
  /// As many numbers as there is room for.
  void take_all(Eigen::VectorXd& numbers) {
    extract(numbers.data(), static_cast<std::size_t>(numbers.size()) * sizeof(double));
  }
  void fail() {
    is_good_ = false;
    rest_ = {};
  }

 private:
  void extract(void* target, std::size_t count) {
    if (count > rest_.size()) return fail();
    if (count > 0) std::memcpy(target, rest_.data(), count);  // matrices of nothing have no memory
    rest_.remove_prefix(count);
  }

  std::string_view rest_;
  bool is_good_ = true;
};

}  // namespace lobe
