#pragma once

#include <string>
#include <string_view>

namespace lobe::cli {

/// The name of an option (without dashes) or of a positional argument. Commands declare their arguments by handles and
/// read them by the same: a name that is misspelt does not compile, and neither does one that is read as something else
/// than it is.
class Handle {
 public:
  constexpr explicit Handle(std::string_view name) : name_(name) {}

  [[nodiscard]] constexpr std::string_view name() const { return name_; }
  /// As users write it: "--theta-in".
  [[nodiscard]] std::string dashed() const { return "--" + std::string(name_); }

 private:
  std::string_view name_;
};

/// An option that takes no value.
struct Flag : public Handle {
  using Handle::Handle;
};

/// One that has a text, whatever else that is read as.
struct Text : public Handle {
  using Handle::Handle;
};

/// One that may be given several times.
struct Texts : public Text {
  using Text::Text;
};

struct Number : public Text {
  using Text::Text;
};

/// A whole number from 1 on.
struct Count : public Text {
  using Text::Text;
};

/// A list "0,15,30".
struct Numbers : public Text {
  using Text::Text;
};

/// A list "red,blue".
struct Words : public Text {
  using Text::Text;
};

}  // namespace lobe::cli
