#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace lobe {

/// Base of everything the library throws. The message is one sentence: what happened, where, and what is expected.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
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
  /// \param message one line for people
  /// \param build_log of the compiler, where a kernel did not build
  explicit DeviceError(const std::string& message, std::string build_log = {})
      : Error(message), build_log_(std::move(build_log)) {}

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
