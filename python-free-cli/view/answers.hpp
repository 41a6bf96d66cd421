#pragma once

#include <span>
#include <string_view>

#include "interface/report.hpp"
#include "lobe/core/progress.hpp"
#include "lobe/device/device.hpp"
#include "view/kept_answers.hpp"
#include "view/scenes.hpp"
#include "view/shown.hpp"

namespace lobe::cli {

/// What the answers are made from.
struct Workshop {
  const Device& device;
  ShownMaterials& shown;
  ShownScenes& scenes;
  KeptAnswers& kept;
  std::size_t first_shown;                   ///< how many of the offers the page begins with
  ProgressCallback progress;                 ///< false: nobody waits for the answer any more
  std::function<void(Json best)> tell_best;  ///< the best so far, for the page to show
};

/// A question that the page asks.
struct QuestionKind {
  std::string_view name;
  int patience;  ///< as in Turns
  Json (*answer)(Workshop& workshop, const Json& asked) = nullptr;
  bool is_kept = false;  ///< the answer takes long, and the same question always has the same
};

/// The answer to a question, as it was given before or made.
/// \throws what the kind's `answer` throws
[[nodiscard]] Json answer(Workshop& workshop, const QuestionKind& kind, const Json& asked);

/// All of them.
[[nodiscard]] std::span<const QuestionKind> question_kinds();

/// An offer, as the page is told of it.
[[nodiscard]] Json offer_json(const Offer& offer);

}  // namespace lobe::cli
