#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace lobe {

/// Base class of everything the library throws. The message is one sentence: what happened, where, and what was
/// expected.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
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
  explicit DeviceError(const std::string& message, std::string build_log = {})
      : Error(message), build_log_(std::move(build_log)) {}

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
