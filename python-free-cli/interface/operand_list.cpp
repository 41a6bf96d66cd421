#include "interface/operand_list.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <set>
#include <string>
#include <string_view>

#include "core/text.hpp"
#include "interface/options.hpp"
#include "interface/reading.hpp"
#include "lobe/core/error.hpp"
#include "lobe/study/study.hpp"

namespace lobe::cli {
namespace {

/// A study file among the arguments, and the families wanted of it.
struct StudyChoice {
  std::string path;
  std::vector<std::string> families;  ///< none: all
};

/// "FILE.toml#FAMILY" apart; with nothing after the mark it is the whole file.
bool split_family(const std::string& text, StudyChoice& choice) {
  constexpr std::string_view kMark = ".toml#";
  const std::size_t mark = text.rfind(kMark);
  if (mark == std::string::npos) return false;
  const std::size_t end = mark + kMark.size();
  choice = {text.substr(0, end - 1), {}};
  if (end < text.size()) choice.families.push_back(text.substr(end));
  return true;
}

bool contains(std::span<const std::string> list, std::string_view word) {
  return std::ranges::find(list, word) != list.end();
}

/// \throws ArgumentError for a wanted family that none of the studies has.
void require_known(std::span<const std::string> wanted, std::span<const Study> studies) {
  std::vector<std::string_view> known;
  for (const auto& study : studies) {
    for (const auto& material : study.materials) {
      if (std::ranges::find(known, material.family()) == known.end()) known.push_back(material.family());
    }
  }
  for (const auto& family : wanted) {
    if (std::ranges::find(known, family) == known.end()) {
      throw ArgumentError("unknown family '" + family + "'" + did_you_mean(family, known));
    }
  }
}

void add_study(OperandList& list, const Study& study, std::span<const std::string> families) {
  for (const StudyMaterial& material : study.materials) {
    if (!families.empty() && !contains(families, material.family())) continue;
    if (const MaterialFile* file = material.file()) list.operands.emplace_back(material.name(), *file);
    if (const Material* formula = material.formula()) list.operands.emplace_back(*formula);
  }
  for (const auto& lighting : study.lightings) {
    if (std::ranges::find(list.lightings, lighting) == list.lightings.end()) list.lightings.push_back(lighting);
  }
  if (study.channel_weights.size() < 2) return;
  if (!list.channel_weights.empty() && list.channel_weights != study.channel_weights) {
    throw ArgumentError("study '" + study.name +
                        "' weighs its channels otherwise than another one; give one of them at a time");
  }
  list.channel_weights = study.channel_weights;
}

/// A single channel serves all channels of a study, and so has the weights of all.
void share_one_channel(std::vector<double>& weights) {
  if (weights.size() > 1) weights = {std::accumulate(weights.begin(), weights.end(), 0.0)};
}

}  // namespace

OperandList read_operands(const Session& session, std::span<const std::string> texts,
                          std::span<const std::string> families) {
  OperandList list;
  std::vector<Study> restricted;
  const auto overrides = session.arguments().texts(option::set);
  std::set<std::string> studies;
  for (const auto& text : texts) {
    StudyChoice choice;
    if (split_family(text, choice)) {
      const Study study = load_study(choice.path, overrides);
      studies.insert(choice.path);
      require_known(choice.families, {&study, 1});
      add_study(list, study, choice.families);
    } else if (names_study(text)) {
      restricted.push_back(load_study(text, overrides));
      studies.insert(text);
      add_study(list, restricted.back(), families);
    } else {
      list.operands.emplace_back(text, read_options(session.arguments()));
    }
  }
  if (!overrides.empty() && studies.size() != 1) {
    throw ArgumentError(fmt::format("--set {} changes a study file, and {} are given; expected one", overrides.front(),
                                    studies.empty() ? "none" : std::to_string(studies.size())));
  }
  if (!families.empty() && restricted.empty()) {
    throw ArgumentError("--family " + families.front() + " chooses among the materials of a study file; give one");
  }
  require_known(families, restricted);
  if (std::ranges::all_of(list.operands, [](const Operand& operand) { return operand.channels() == 1; })) {
    share_one_channel(list.channel_weights);
  }
  for (Operand& operand : list.operands) operand.adjust(session.device());
  return list;
}

}  // namespace lobe::cli
