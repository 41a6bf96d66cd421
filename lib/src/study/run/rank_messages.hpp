#pragma once

#include <cstdint>
#include <exception>
#include <optional>
#include <string>
#include <string_view>

namespace lobe {

/// Texts that the ranks of a study exchange (lobe/study/ranks.hpp): a kind, a name, a content and their checksum.
enum class RankWord : std::uint64_t {
  begin,   ///< 0 to others: begin; content: identity of the study
  next,    ///< to 0: asks for a unit
  unit,    ///< from 0: compute it; name: the unit's
  none,    ///< from 0: there is no unit left
  result,  ///< to 0: name and record of a unit
  failed,  ///< to 0: content: an error
  alive,   ///< either way, now and then
  leave,   ///< from 0: it is over
  left     ///< to 0: the last text of a rank
};

struct RankText {
  RankWord word = RankWord::alive;
  std::string name = {};
  std::string content = {};
};

[[nodiscard]] std::string written_rank_text(const RankText& text);
/// None: it is not what somebody has written.
[[nodiscard]] std::optional<RankText> read_rank_text(std::string_view bytes);

/// An error of another process, by its kind, text and fields.
[[nodiscard]] std::string written_error(const std::exception_ptr& error);
/// Throws what written_error() has written.
/// \param rank what to call the rank in errors of its machine
[[noreturn]] void throw_written_error(std::string_view content, const std::string& rank);

}  // namespace lobe
