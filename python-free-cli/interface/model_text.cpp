#include "interface/model_text.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/text.hpp"
#include "interface/example_value.hpp"

namespace lobe::cli {
namespace {

constexpr std::string_view kDissertation = "Neumann 2001, ";

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// The end of a number like 2001 or 3.7.1.
std::size_t number_end(std::string_view text, std::size_t at) {
  while (at < text.size() &&
         (is_digit(text[at]) || (text[at] == '.' && at + 1 < text.size() && is_digit(text[at + 1])))) {
    ++at;
  }
  return at;
}

}  // namespace

std::string bound_text(double value) {
  if (std::isinf(value)) return value > 0 ? "infinity" : "-infinity";
  std::string text = fmt::format("{:.5g}", value);
  const auto mark = text.find('e');
  if (mark == std::string::npos) return text;
  return fmt::format("{}e{}", text.substr(0, mark), std::stoi(text.substr(mark + 1)));
}

std::string example_specification(const Model& model) {
  std::string text(model.name);
  char separator = ':';
  for (const auto& parameter : model.parameters) {
    text += fmt::format("{}{}={}", separator, parameter.name, shortest(example_value(parameter)));
    separator = ',';
  }
  return text;
}

std::string traits_text(const Traits& traits) {
  std::string text = traits.isotropic ? "isotropic" : "anisotropic";
  if (traits.reciprocal) text += ", reciprocal";
  if (traits.conserves_energy) text += ", conserves energy";
  if (traits.has_delta) text += ", has a delta part";
  if (!traits.non_negative) text += ", may be negative";
  return text;
}

std::string names_of(std::span<const Parameter> parameters) {
  std::string text;
  for (const auto& parameter : parameters) {
    text += fmt::format("{}{}", text.empty() ? "" : ", ", parameter.name);
  }
  return text.empty() ? "-" : text;
}

int chapter_of(const Model& model) {
  if (!model.source.starts_with(kDissertation)) return 0;
  return model.source[model.source.find_first_of("0123456789", kDissertation.size())] - '0';
}

std::string_view citation(const Model& model) {
  const std::string_view source = model.source;
  std::size_t end = number_end(source, source.find_first_of("0123456789"));
  const auto follows = [&](std::string_view joint) {
    const std::size_t next = end + joint.size();
    return source.substr(end).starts_with(joint) && next < source.size() && is_digit(source[next]);
  };
  constexpr std::array<std::string_view, 5> kJoints{", eq. ", ", section ", " to ", " and ", ", "};
  for (;;) {
    const auto joint = std::ranges::find_if(kJoints, follows);
    if (joint == kJoints.end()) break;
    end = number_end(source, end + joint->size());
  }
  const std::size_t first = chapter_of(model) > 0 ? kDissertation.size() : 0;
  return source.substr(first, end - first);
}

std::vector<Chapter> chapters() {
  constexpr std::array<std::string_view, 6> kTitles{"Beyond the dissertation",
                                                    "1 Introduction",
                                                    "2 Reflectance Models by Pumping up the Albedo Function",
                                                    "3 New Simple Reflectance Models for Specular Materials",
                                                    "4 Reflectance Models with Fast Importance Sampling",
                                                    "5 Central Concepts and Future Directions"};
  std::vector<Chapter> list;
  for (std::size_t turn = 1; turn <= kTitles.size(); ++turn) {
    const std::size_t number = turn % kTitles.size();
    Chapter chapter{kTitles.at(number), {}};
    for (const auto& model : catalogue()) {
      if (chapter_of(model) == static_cast<int>(number)) chapter.models.push_back(&model);
    }
    if (!chapter.models.empty()) list.push_back(std::move(chapter));
  }
  return list;
}

}  // namespace lobe::cli
