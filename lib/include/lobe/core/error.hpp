#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

namespace [[gnu::visibility("default")]] lobe {

/// What has gone wrong, where a program can do more about it than the type of an error says.
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
  foreign_file,     ///< an HDF5 file that is damaged, or that something else has written
  wrong_results,    ///< a kernel does not compute what is known of it
  other_grid,       ///< an operand is on another grid than grid(), and may not be interpolated
  not_reciprocal,   ///< a reflectance is not reciprocal, which symmetrise() makes it
  infinite_norm     ///< a norm over the whole hemisphere, which a smaller domain has
};

/// The fault that an error of the operating system stands for.
[[nodiscard]] Fault fault_of(const std::error_code& code);

/// What an error is about, where a caller can tell users to read on.
enum class Topic { other, materials, models, studies };

/// What an error says beside its message.
struct ErrorFields {
  Fault fault = Fault::unspecified;
  Topic topic = Topic::other;
  std::string path = {};  ///< of the file at fault
  std::string grid = {};  ///< that was expected
};

/// The base of everything the library throws. The message is one sentence: what happened, where, and, behind "; ", what
/// is expected or can be done.
class Error : public std::runtime_error {
 public:
  explicit Error(const std::string& message, ErrorFields fields = {});

  /// The message without its advice.
  [[nodiscard]] std::string_view problem() const;
  /// What is expected or can be done; empty where the message does not say.
  [[nodiscard]] std::string_view advice() const;

  [[nodiscard]] Fault fault() const { return fields_->fault; }
  [[nodiscard]] Topic topic() const { return fields_->topic; }
  [[nodiscard]] const std::string& path() const { return fields_->path; }
  [[nodiscard]] const std::string& grid() const { return fields_->grid; }
  [[nodiscard]] const ErrorFields& fields() const { return *fields_; }

 private:
  std::shared_ptr<const ErrorFields> fields_;  ///< shared: copies of exceptions must not throw
};

/// A caller's mistake: unknown model, value out of range, malformed study file.
class ArgumentError : public Error {
 public:
  using Error::Error;
};

/// A file cannot be read, written or understood.
class IoError : public Error {
 public:
  using Error::Error;
};

/// No usable OpenCL device, a kernel that does not build, a failed launch.
class DeviceError : public Error {
 public:
  /// An error of a device or its compiler.
  /// \param message one line for people \param build_log of the compiler, where a kernel did not build
  explicit DeviceError(const std::string& message, std::string build_log = {}, ErrorFields fields = {})
      : Error(message, std::move(fields)), build_log_(std::move(build_log)) {}

  /// The compiler's log where a kernel did not build, else empty.
  [[nodiscard]] const std::string& build_log() const { return build_log_; }

 private:
  std::string build_log_;
};

/// A quantity does not exist or cannot be computed: an infinite norm, a quadrature that gave a value that is no number.
class NumericError : public Error {
 public:
  using Error::Error;
};

/// A grid does not resolve what is to be tabulated on it.
class UnresolvedError : public NumericError {
 public:
  using NumericError::NumericError;
};

/// The progress callback asked to stop.
class Cancelled : public Error {
 public:
  using Error::Error;
};

}  // namespace lobe
