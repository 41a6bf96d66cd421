#include "view/kept_answers.hpp"

namespace lobe::cli {

Json KeptAnswers::get(const std::string& question, const std::function<Json()>& make) {
  const auto found = places_.find(question);
  if (found != places_.end()) {
    kept_.splice(kept_.end(), kept_, found->second);
    return kept_.back().answer;
  }
  Json answer = make();
  const std::size_t bytes = 2 * question.size() + answer.dump(-1, ' ', false, Json::error_handler_t::replace).size();
  kept_.push_back({question, answer, bytes});
  places_.emplace(question, std::prev(kept_.end()));
  bytes_ += bytes;
  while (bytes_ > most_bytes_) {
    bytes_ -= kept_.front().bytes;
    places_.erase(kept_.front().question);
    kept_.pop_front();
  }
  return answer;
}

}  // namespace lobe::cli
