#pragma once

#include <string>
#include <string_view>

namespace lobe::cli {

/// Which of the two output streams a question is about.
enum class Stream { output, error };

/// Makes file descriptors 0 to 2 open (on /dev/null where they were closed, so that no result file takes their place)
/// and turns a closed pipe and a file size limit from deadly signals into failing writes.
void prepare_streams();

/// Whether text for a stream may be coloured. Precedence: `choice` ("always", "never"), terminal or not, NO_COLOR,
/// TERM.
[[nodiscard]] bool uses_color(Stream stream, std::string_view choice);

[[nodiscard]] bool is_terminal(Stream stream);

/// `text` in bold where `color` is true.
[[nodiscard]] std::string bold(std::string_view text, bool color);

/// Writes the results to standard output. A reader that has gone away is no failure.
/// \throws IoError when they cannot be written, for example because the disk is full.
void write_output(std::string_view text);

/// Writes to standard error; failures are ignored, there is nobody left to tell.
void write_error(std::string_view text);

/// While it lives, the first SIGINT or SIGTERM only sets a mark; a second one ends the process.
class InterruptWatch {
 public:
  InterruptWatch();
  ~InterruptWatch();
  InterruptWatch(const InterruptWatch&) = delete;
  InterruptWatch& operator=(const InterruptWatch&) = delete;

  [[nodiscard]] static bool interrupted();
};

/// Ends the process by the signal that InterruptWatch caught, so that the shell sees 128 + its number.
[[noreturn]] void end_by_caught_signal();

}  // namespace lobe::cli
