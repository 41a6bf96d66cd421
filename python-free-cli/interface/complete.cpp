#include "interface/complete.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>

#include "core/text.hpp"
#include "interface/topics.hpp"
#include "lobe/core/written_form.hpp"
#include "lobe/formats/chosen_file.hpp"
#include "lobe/formats/measured.hpp"
#include "lobe/model/model.hpp"

namespace lobe::cli {
namespace {

/// "patch:R" up to where the user's part begins: "patch:".
std::string fixed_part(std::string_view written) {
  const std::size_t colon = written.find(':');
  return std::string(written.substr(0, colon == std::string_view::npos ? colon : colon + 1));
}

void add_forms(Completion& completion, std::span<const WrittenForm> forms, const std::string& before = {}) {
  for (const auto& form : forms)
    completion.candidates.push_back({before + fixed_part(form.written), std::string(form.meaning)});
}

/// The names of "a=X,b=Y".
std::vector<Candidate> keys_of(std::string_view written) {
  std::vector<Candidate> keys;
  for (const auto part : split(written, ',')) keys.push_back({std::string(part.substr(0, part.find('=')))});
  return keys;
}

std::vector<Candidate> keys_of(std::span<const Parameter> parameters) {
  std::vector<Candidate> keys;
  for (const auto& parameter : parameters) {
    keys.push_back({std::string(parameter.name), std::string(parameter.description)});
  }
  return keys;
}

/// "NAME:" with keys, or "NAME".
template <typename Named>
void add_names(Completion& completion, std::span<const Named> all, const std::string& before) {
  for (const auto& each : all) {
    std::string help;
    if constexpr (requires { each.family; }) {
      help = each.family;
    } else {
      help = each.formula;
    }
    completion.candidates.push_back({before + std::string(each.name) + (each.parameters.empty() ? "" : ":"), help});
  }
}

/// Completes "NAME:a=1,": keys that are missing so far. Nothing while a value is typed.
void add_keys(Completion& completion, const std::vector<Candidate>& keys, const std::string& before,
              std::string_view given) {
  const auto parts = split(given, ',');
  if (parts.back().find('=') != std::string_view::npos) return;
  const std::string begun = before + std::string(given.substr(0, given.size() - parts.back().size()));
  for (const Candidate& key : keys) {
    const bool is_given = std::ranges::any_of(parts, [&key](std::string_view part) {
      return part.substr(0, part.find('=')) == key.word && part.find('=') != std::string_view::npos;
    });
    if (!is_given) completion.candidates.push_back({begun + key.word + "=", key.help});
  }
}

/// Completes "FILE[".
void add_file_choices(Completion& completion, const std::string& word, std::size_t open) {
  std::vector<Candidate> keys;
  for (const auto& form : file_choices()) keys.push_back({std::string(form.word), std::string(form.meaning)});
  add_keys(completion, keys, word.substr(0, open + 1), std::string_view(word).substr(open + 1));
}

/// A material: the part from the last of "+*@" on.
void add_materials(Completion& completion, const std::string& word, bool has_parameters = true) {
  const std::size_t open = word.rfind('[');
  if (open != std::string::npos) return add_file_choices(completion, word, open);
  const std::size_t mark = word.find_last_of("+*@");
  const std::size_t start = mark == std::string::npos ? 0 : mark + 1;
  const char kind = mark == std::string::npos ? '+' : word[mark];
  const std::string before = word.substr(0, start);
  const std::size_t colon = word.find(':', start);
  if (colon == std::string::npos) {
    if (kind == '@') {
      add_forms(completion, adjustment_forms(), before);
    } else if (kind == '*') {
      add_names(completion, factors(), before);
    } else {
      add_names(completion, catalogue(), before);
    }
    if (!has_parameters) {
      for (auto& candidate : completion.candidates) std::erase(candidate.word, ':');
    }
    return;
  }
  const std::string name = word.substr(start, colon - start);
  std::vector<Candidate> keys;
  if (kind == '@') {
    const auto form = std::ranges::find(adjustment_forms(), name, &WrittenForm::word);
    if (form != adjustment_forms().end() && form->written.find(':') != std::string_view::npos) {
      keys = keys_of(form->written.substr(form->written.find(':') + 1));
    }
  } else if (kind == '*') {
    const auto factor = std::ranges::find(factors(), name, &FactorModel::name);
    if (factor != factors().end()) keys = keys_of(factor->parameters);
  } else {
    const auto model = std::ranges::find(catalogue(), name, &Model::name);
    if (model != catalogue().end()) {
      keys = keys_of(model->parameters);
      keys.push_back({"scale", "factor on the model"});
    }
  }
  add_keys(completion, keys, word.substr(0, colon + 1), std::string_view(word).substr(colon + 1));
}

/// By what the tables call a value: "FILE.toml", "LIGHTING", ...
void add_values(Completion& completion, std::string_view value, const std::string& word,
                std::span<const Command> commands) {
  if (value.starts_with("FILE") || value == "STUDY") {
    completion.paths = Completion::Paths::files;
    completion.ending = value == "STUDY" ? ".toml" : value.substr(std::string_view("FILE").size());
  } else if (value.starts_with("DIR")) {
    completion.paths = Completion::Paths::directories;
  } else if (value == "MATERIAL") {
    add_materials(completion, word);
    if (word.find_first_of(":+*@") == std::string::npos) completion.paths = Completion::Paths::files;
  } else if (value == "FAMILY") {
    add_materials(completion, word, false);
  } else if (value == "LIGHTING") {
    constexpr std::string_view kTable = "table:";
    constexpr std::string_view kMaterial = "material:";
    if (word.starts_with(kMaterial)) {
      Completion own;
      add_values(own, "MATERIAL", word.substr(kMaterial.size()), commands);
      for (auto& candidate : own.candidates) candidate.word.insert(0, kMaterial);
      completion.candidates.insert(completion.candidates.end(), own.candidates.begin(), own.candidates.end());
      completion.paths = own.paths;
    } else if (word.starts_with(kTable)) {
      completion.paths = Completion::Paths::files;
      completion.ending = ".h5";
    } else {
      add_forms(completion, lighting_forms());
    }
  } else if (value == "GRID") {
    add_forms(completion, grid_forms());
  } else if (value == "FORMAT") {
    for (const auto& format : measured_formats()) {
      if (format.is_written) completion.candidates.push_back({std::string(format.name), std::string(format.title)});
    }
  } else if (value == "MODEL") {
    for (const auto& model : catalogue())
      completion.candidates.push_back({std::string(model.name), std::string(model.family)});
    for (const auto& factor : factors()) completion.candidates.push_back({std::string(factor.name), "factor"});
  } else if (value == "TOPIC") {
    for (const auto& topic : topics())
      completion.candidates.push_back({std::string(topic.name), std::string(topic.summary)});
    for (const auto& command : commands)
      completion.candidates.push_back({std::string(command.name), std::string(command.summary)});
  }
}

void add_options(Completion& completion, std::span<const Option> options) {
  for (const auto& option : options) {
    completion.candidates.push_back({option.handle.dashed(), std::string(option.help)});
  }
}

const Option* find_option(const Command* command, std::string_view word) {
  const auto is_meant = [&](const Option& option) {
    return word == option.handle.dashed() || (option.letter != '\0' && word == fmt::format("-{}", option.letter));
  };
  if (command != nullptr) {
    const auto found = std::ranges::find_if(command->options, is_meant);
    if (found != command->options.end()) return &*found;
  }
  const auto found = std::ranges::find_if(common_options(), is_meant);
  return found == common_options().end() ? nullptr : &*found;
}

/// The value of an option as far as it is typed, with what stands before it in the same word.
void add_option_values(Completion& completion, const Option& option, const std::string& word, const std::string& before,
                       std::span<const Command> commands) {
  add_values(completion, option.value, word, commands);
  for (const auto choice : option.choices) completion.candidates.push_back({std::string(choice)});
  for (auto& candidate : completion.candidates) candidate.word.insert(0, before);
}

Completion everything(std::span<const Command> commands, std::span<const std::string> words) {
  Completion completion;
  const std::string& word = words.back();
  const Command* command = nullptr;
  std::size_t position = 0;      // among the positional arguments
  const Option* open = nullptr;  // an option that waits for its value
  bool takes_options = true;
  for (const auto& before : words.first(words.size() - 1)) {
    const bool is_value = open != nullptr;
    open = nullptr;
    if (is_value) continue;
    if (takes_options && before == "--") {
      takes_options = false;
    } else if (takes_options && before.size() > 1 && before[0] == '-') {
      const Option* option = find_option(command, before);
      if (option != nullptr && !option->value.empty()) open = option;
    } else if (command == nullptr) {
      const auto found = std::ranges::find(commands, std::string_view(before), &Command::name);
      if (found == commands.end()) return completion;
      command = &*found;
    } else {
      ++position;
    }
  }
  if (open != nullptr) {
    add_option_values(completion, *open, word, {}, commands);
  } else if (takes_options && word.starts_with("--") && word.find('=') != std::string::npos) {
    const std::size_t value = word.find('=') + 1;
    if (const Option* option = find_option(command, word.substr(0, value - 1)); option != nullptr) {
      add_option_values(completion, *option, word.substr(value), word.substr(0, value), commands);
    }
  } else if (takes_options && word.starts_with('-')) {
    if (command != nullptr) add_options(completion, command->options);
    add_options(completion, common_options());
  } else if (command == nullptr) {
    for (const auto& each : commands)
      completion.candidates.push_back({std::string(each.name), std::string(each.summary)});
  } else if (!command->positionals.empty()) {
    const auto& positionals = command->positionals;
    if (position >= positionals.size() && !positionals.back().is_repeated) return completion;
    const Positional& positional = positionals[std::min(position, positionals.size() - 1)];
    add_values(completion, positional.is_material ? "MATERIAL" : positional.name(), word, commands);
  }
  return completion;
}

}  // namespace

Completion complete(std::span<const Command> commands, std::span<const std::string> words) {
  if (words.empty()) return {};
  Completion completion = everything(commands, words);
  std::erase_if(completion.candidates,
                [&](const Candidate& candidate) { return !candidate.word.starts_with(words.back()); });
  return completion;
}

std::string completion_text(const Completion& completion) {
  constexpr std::array<std::string_view, 3> kPaths{"none", "files", "directories"};
  std::string text = fmt::format("{}\t{}\n", kPaths.at(static_cast<std::size_t>(completion.paths)), completion.ending);
  for (const auto& [word, help] : completion.candidates) text += fmt::format("{}\t{}\n", word, help);
  return text;
}

}  // namespace lobe::cli
