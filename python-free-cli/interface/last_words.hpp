#pragma once

namespace lobe::cli {

/// Libraries that end the process themselves: PoCL and LLVM do so where a kernel cannot be written to the cache, or
/// `ld` is missing. From prepare_last_words() until leave() such an end is reported in a line on standard error, after
/// the library's own, with the exit status of a device that failed.
void prepare_last_words();

/// The process ends as intended from here on, with this status.
void leave(int status);

/// Ends a process that is leaving without what libraries still do at the end. Does nothing before leave(), and where a
/// sanitizer has to look for leaks.
void end_at_once();

/// Says that work which nobody wants any more may go on in a thread, so that the process is to end without it.
void leave_threads_behind();
[[nodiscard]] bool leaves_threads_behind();

}  // namespace lobe::cli
