#pragma once

#include <hdf5.h>

#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// A thin layer over the HDF5 C library: handles that close themselves, failures as IoError with the library's own
/// cause, and the conventions of every file lobe writes. Debian's HDF5 is serial: one thread at a time.
namespace lobe::hdf5 {

/// Owns one identifier; the function that closes it is part of the type.
template <herr_t (*Close)(hid_t)>
class Handle {
 public:
  /// \throws IoError naming the operation when the identifier is invalid.
  Handle(hid_t id, std::string_view operation);
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, H5I_INVALID_HID)) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() {
    if (id_ >= 0) Close(id_);
  }

  [[nodiscard]] hid_t id() const { return id_; }

 private:
  hid_t id_;
};

using File = Handle<H5Fclose>;
using Group = Handle<H5Gclose>;
using Dataset = Handle<H5Dclose>;
using Space = Handle<H5Sclose>;
using Type = Handle<H5Tclose>;
using Properties = Handle<H5Pclose>;
using Attribute = Handle<H5Aclose>;

/// Passes on a result that is no failure.
/// \throws IoError "cannot <operation>: <cause>" for a negative one.
template <typename Result>
Result check(Result result, std::string_view operation);

/// Silences HDF5's messages to stderr for its lifetime and restores what was there.
class QuietErrors {
 public:
  QuietErrors();
  ~QuietErrors();
  QuietErrors(const QuietErrors&) = delete;
  QuietErrors& operator=(const QuietErrors&) = delete;

 private:
  H5E_auto2_t function_ = nullptr;
  void* data_ = nullptr;
};

[[nodiscard]] Group create_group(hid_t parent, const std::string& name);

/// Attributes: scalar strings (variable-length UTF-8), numbers and lists of numbers.
void write_attribute(hid_t object, const char* name, std::string_view value);
void write_attribute(hid_t object, const char* name, double value);
void write_attribute(hid_t object, const char* name, std::int64_t value);
void write_attribute(hid_t object, const char* name, std::span<const double> values);

using TextAttribute = std::pair<const char*, std::string_view>;
void write_attributes(hid_t object, std::initializer_list<TextAttribute> attributes);

/// A dataset that serves as an axis of others, known by its own name; created before them.
[[nodiscard]] Dataset create_text_axis(hid_t parent, const std::string& name, std::span<const std::string> labels);
/// \param first number of the first place
[[nodiscard]] Dataset create_index_axis(hid_t parent, const std::string& name, std::size_t count,
                                        std::int32_t first = 1);
[[nodiscard]] Dataset create_number_axis(hid_t parent, const std::string& name, std::span<const double> values);

/// A dataset of doubles in row-major order along the axes: 64-bit little-endian, chunked, shuffled, deflated, with
/// checksums; missing values are NaN.
/// \throws IoError; ArgumentError when the number of values is not the product of the axes' lengths.
[[nodiscard]] Dataset create_dataset(hid_t parent, const std::string& name, std::span<const double> values,
                                     std::span<const Dataset* const> axes);

/// A dataset of 32-bit whole numbers, kept as those of doubles are but without missing values.
/// \throws as create_dataset()
[[nodiscard]] Dataset create_integer_dataset(hid_t parent, const std::string& name,
                                             std::span<const std::int32_t> values,
                                             std::span<const Dataset* const> axes);

/// A dataset of doubles without values, which are written chunk by chunk.
/// \param chunk shape of a chunk
[[nodiscard]] Dataset define_dataset(hid_t parent, const std::string& name, std::span<const Dataset* const> axes,
                                     std::span<const hsize_t> chunk, bool compress);

/// A dataset of texts (variable-length UTF-8) along one axis.
[[nodiscard]] Dataset create_text_dataset(hid_t parent, const std::string& name, std::span<const std::string> values,
                                          const Dataset& axis);

/// Chunk of a row-major array of doubles: whole rows of the last axes, up to 1 MiB (the default chunk cache).
[[nodiscard]] std::vector<hsize_t> chunk_shape(std::span<const hsize_t> shape);

// --- implementation of the templates ---

/// The library's account of the failure that just happened: the deepest entry of its error stack.
[[nodiscard]] std::string failure_cause();
[[noreturn]] void throw_failure(std::string_view operation);

template <typename Result>
Result check(Result result, std::string_view operation) {
  if (result < 0) throw_failure(operation);
  return result;
}

template <herr_t (*Close)(hid_t)>
Handle<Close>::Handle(hid_t id, std::string_view operation) : id_(check(id, operation)) {}

}  // namespace lobe::hdf5
