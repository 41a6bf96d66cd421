#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

namespace [[gnu::visibility("default")]] lobe {

/// Cause of an error, if a program can react to it more specifically than the type of the exception tells.
enum class Fault {
  unspecified,
  missing_file,     ///< there is no file of that path
  existing_file,    ///< there is a file of that path, which may not be replaced
  directory,        ///< a directory where a file is expected, or the other way round
  not_permitted,    ///< the permissions of a file or folder
  read_only_place,  ///< nothing can be written there
  no_space,         ///< the disk is full
  too_large,        ///< the file is larger than the system permits
  content,          ///< a line or byte of a file is not what its format says
  unknown_format,   ///< a file in no format that is known
  hdf5_content,     ///< an HDF5 file that is damaged, or that something else has written
  wrong_results,    ///< a kernel does not compute what is known of it
  other_grid,       ///< an operand is on another grid than grid(), and may not be interpolated
  not_reciprocal,   ///< a reflectance is not reciprocal, which symmetrise() makes it
  infinite_norm     ///< a norm over the whole hemisphere, which a smaller domain has
};

/// Fault that an error of the operating system stands for.
[[nodiscard]] Fault fault_of(const std::error_code& code);

/// Subject of an error, by which a program can direct users to further reading.
enum class Topic { other, materials, models, studies };

/// Details of an error in addition to its message.
struct ErrorFields {
  Fault fault = Fault::unspecified;  ///< cause
  Topic topic = Topic::other;        ///< subject
  std::string path = {};             ///< file at fault
  std::string grid = {};             ///< grid that was expected
};

/// Base class of everything the library throws. The message is one sentence: what happened, where, and, behind "; ",
/// what was expected or can be done.
class Error : public std::runtime_error {
 public:
  /// Makes an error; "; " in the message begins the advice.
  explicit Error(const std::string& message, ErrorFields fields = {});

  /// Message without its advice.
  [[nodiscard]] std::string_view problem() const;
  /// Advice of the message: what was expected or can be done; empty if there is none.
  [[nodiscard]] std::string_view advice() const;

  /// Cause of the error.
  [[nodiscard]] Fault fault() const { return fields_->fault; }
  /// Subject of the error.
  [[nodiscard]] Topic topic() const { return fields_->topic; }
  /// File at fault; empty if there is none.
  [[nodiscard]] const std::string& path() const { return fields_->path; }
  /// Grid that was expected; empty if there is none.
  [[nodiscard]] const std::string& grid() const { return fields_->grid; }
  /// All details.
  [[nodiscard]] const ErrorFields& fields() const { return *fields_; }

 private:
  std::shared_ptr<const ErrorFields> fields_;  ///< shared: copies of exceptions must not throw
};

/// A caller's mistake: an unknown model, a value out of range, a malformed study file.
class ArgumentError : public Error {
 public:
  using Error::Error;
};

/// Failure to read, write or understand a file.
class IoError : public Error {
 public:
  using Error::Error;
};

/// Failure of a device: no usable OpenCL device, a kernel that does not build, a failed launch.
class DeviceError : public Error {
 public:
  /// Makes an error of a device or its compiler.
  /// \param message one line for people
  /// \param build_log log of the compiler, if a kernel did not build
  explicit DeviceError(const std::string& message, std::string build_log = {}, ErrorFields fields = {})
      : Error(message, std::move(fields)), build_log_(std::move(build_log)) {}

  /// The compiler's log if a kernel did not build, else empty.
  [[nodiscard]] const std::string& build_log() const { return build_log_; }

 private:
  std::string build_log_;
};

/// Failure of a computation: a quantity that does not exist, such as an infinite norm, or a quadrature that gave no
/// finite number.
class NumericError : public Error {
 public:
  using Error::Error;
};

/// Refusal of a grid that does not resolve the reflectance to be tabulated on it.
class UnresolvedError : public NumericError {
 public:
  using NumericError::NumericError;
};

/// End of a computation that the progress callback asked to stop.
class Cancelled : public Error {
 public:
  using Error::Error;
};

}  // namespace lobe
