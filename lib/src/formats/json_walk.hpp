#pragma once

#include <functional>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>

#include "formats/file_bytes.hpp"

namespace lobe {

/// A value of a JSON text that is neither an array nor an object.
struct JsonScalar {
  enum class Kind { null, boolean, number, text };
  Kind kind = Kind::null;
  double number = 0;           ///< of numbers
  std::string_view text = {};  ///< of texts, until the next value
};

/// Where a value stands: the keys that lead to it, and "[]" for an array.
using JsonPath = std::span<const std::string>;

/// Whether a path is that of these keys.
[[nodiscard]] bool is_at(JsonPath path, std::initializer_list<std::string_view> keys);

/// Goes through a JSON text (RFC 8259) value by value. A tree of one that is mostly numbers takes many times its
/// memory.
class JsonWalk {
 public:
  explicit JsonWalk(const FileBytes& file) : file_(file), at_(file.content().data()) {}

  /// \param value called for each value that is neither an array nor an object
  /// \param array_end called behind the last value of each array
  /// \throws IoError for what is no JSON, and for arrays and objects within more than 32 others
  void run(const std::function<void(JsonPath, const JsonScalar&)>& value,
           const std::function<void(JsonPath)>& array_end);

  /// \throws IoError that names the line that has been reached
  [[noreturn]] void refuse(std::string_view complaint) const;

 private:
  const FileBytes& file_;
  const char* at_;  // behind the last character that was read
};

/// A text as JSON writes it, with its quotes; what is no UTF-8 becomes U+FFFD.
[[nodiscard]] std::string json_text(std::string_view text);

}  // namespace lobe
