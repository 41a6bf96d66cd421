#pragma once

#include <cstddef>
#include <functional>
#include <list>
#include <map>
#include <string>

#include "interface/report.hpp"

namespace lobe::cli {

/// Answers that were given before: whoever takes a material away, goes back a step or opens the page again waits for
/// nothing. The oldest ones go where they take too much memory. For one thread.
class KeptAnswers {
 public:
  /// \param most_bytes as JSON texts, with their questions
  explicit KeptAnswers(std::size_t most_bytes = std::size_t{32} << 20) : most_bytes_(most_bytes) {}

  /// The answer to a question, made where it is not known.
  /// \throws what `make` throws; nothing is kept then
  [[nodiscard]] Json get(const std::string& question, const std::function<Json()>& make);

 private:
  struct Kept {
    std::string question;
    Json answer;
    std::size_t bytes;
  };

  std::list<Kept> kept_;  ///< the latest used last
  std::map<std::string, std::list<Kept>::iterator, std::less<>> places_;
  std::size_t bytes_ = 0;
  std::size_t most_bytes_;
};

}  // namespace lobe::cli
