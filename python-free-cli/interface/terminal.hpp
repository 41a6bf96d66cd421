#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

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

/// A terminal on which a line can be written over: not TERM=dumb.
[[nodiscard]] bool can_redraw(Stream stream);

/// How many characters fit on a line of the terminal; 80 where it does not tell.
[[nodiscard]] std::size_t columns(Stream stream);

/// `text` in bold where `color` is true.
[[nodiscard]] std::string bold(std::string_view text, bool color);

/// Writes the results to standard output. A reader that has gone away is no failure.
/// \throws IoError when they cannot be written, for example because the disk is full.
void write_output(std::string_view text);

/// Makes write_output() and write_error() say nothing from now on: another process speaks for this one.
void be_silent();

/// Writes to standard error; failures are ignored, there is nobody left to tell.
void write_error(std::string_view text);

/// Writes a line over the last one that was written so; an empty one leaves nothing of it. Blanks instead of an escape
/// sequence: they work on every terminal.
void write_over(std::string_view line);

/// While it lives, the first SIGINT or SIGTERM sets a mark, for work to look at and to end by Cancelled; a second one
/// ends the process. Work that goes on 0.7 s after the mark is ended as it stands. There is one at a time.
class InterruptWatch {
 public:
  /// \param directories where files are written: those made meanwhile go, if empty, when work is ended as it stands
  explicit InterruptWatch(const std::vector<std::filesystem::path>& directories);
  ~InterruptWatch();
  InterruptWatch(const InterruptWatch&) = delete;
  InterruptWatch& operator=(const InterruptWatch&) = delete;

  [[nodiscard]] static bool interrupted();

  /// Message for interrupted work, instead of the one that nothing was written.
  static void note(std::string text);
  [[nodiscard]] static std::string noted();

 private:
  void end_what_goes_on();

  std::thread thread_;
};

/// Ends the process by the signal that InterruptWatch caught, so that the shell sees 128 + its number.
[[noreturn]] void end_by_caught_signal();

}  // namespace lobe::cli
