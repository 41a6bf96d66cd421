// The only file that includes CLI11: it splits the command line, all wording is ours.
#include "interface/parser.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <deque>
#include <iterator>

#include "core/text.hpp"
#include "interface/options.hpp"
#include "lobe/core/error.hpp"

namespace lobe::cli {
namespace {

/// Where CLI11 puts what it finds for one option or positional argument.
struct Slot {
  Handle handle;
  std::string_view value_name = {};
  std::vector<std::string_view> choices = {};
  bool required = false;
  bool is_positional = false;
  std::vector<std::string> texts = {};
  CLI::Option* option = nullptr;
};

Slot& add_option(CLI::App& app, std::deque<Slot>& slots, const Option& option) {
  auto& slot = slots.emplace_back(Slot{
      .handle = option.handle, .value_name = option.value, .choices = option.choices, .required = option.required});
  std::string names = slot.handle.dashed();
  if (option.letter != '\0') names += std::string(",-") + option.letter;
  // Each occurrence takes one value; what follows it is a positional argument.
  // A flag without a variable: from CLI11 2.4 on those with a counter have a result even where they are not given.
  slot.option = option.value.empty() ? app.add_flag(names) : app.add_option(names, slot.texts)->allow_extra_args(false);
  return slot;
}

void add_positional(CLI::App& app, std::deque<Slot>& slots, const Positional& positional) {
  auto& slot =
      slots.emplace_back(Slot{.handle = positional.handle, .required = positional.required, .is_positional = true});
  slot.option = app.add_option("argument" + std::to_string(slots.size()), slot.texts);
  if (!positional.is_repeated) slot.option->expected(1)->allow_extra_args(false);
}

std::string see_help(const Command* command) {
  return command == nullptr ? "see 'lobe --help'" : "see 'lobe " + std::string(command->name) + " --help'";
}

constexpr std::string_view kFormerCellPoints = "--samples";  // its name before samples were drawn directions only

[[noreturn]] void reject_unknown_option(const std::string& word, const Command* command) {
  std::vector<std::string> names;
  const auto add = [&](const Option& option) { names.push_back(option.handle.dashed()); };
  if (command != nullptr) std::ranges::for_each(command->options, add);
  std::ranges::for_each(common_options(), add);
  const std::vector<std::string_view> candidates(names.begin(), names.end());
  const std::string bare = word.substr(0, word.find('='));
  if (bare == kFormerCellPoints && std::ranges::find(names, option::cell_points.dashed()) != names.end()) {
    throw ArgumentError("option '" + bare + "' is called '" + option::cell_points.dashed() + "'");
  }
  const std::string near = nearest_word(bare, candidates);
  if (near == bare) throw ArgumentError("option '" + bare + "' in the wrong place; give it after the command's name");
  throw ArgumentError("unknown option '" + word + "'; " +
                      (near.empty() ? see_help(command) : "did you mean '" + near + "'?"));
}

[[noreturn]] void reject_unknown_command(std::span<const Command> commands, const std::string& word) {
  std::vector<std::string_view> names;
  for (const auto& command : commands) names.push_back(command.name);
  const std::string near = nearest_word(word, names);
  throw ArgumentError("unknown command '" + word + "'; " +
                      (near.empty() ? "'lobe --help' lists them" : "did you mean '" + near + "'?"));
}

void check_slot(const Slot& slot, const Command* command) {
  const std::string shown = slot.is_positional ? std::string(slot.handle.name()) : slot.handle.dashed();
  if (slot.option->count() == 0) {
    if (!slot.required) return;
    throw ArgumentError("'lobe " + std::string(command->name) + "' needs " + shown + "; " + see_help(command));
  }
  if (slot.is_positional || slot.value_name.empty()) return;
  for (const auto& text : slot.texts) {
    const bool looks_like_option =
        text.size() > 1 && text[0] == '-' && std::string_view("0123456789.").find(text[1]) == std::string_view::npos;
    if (text.empty() || looks_like_option) {
      throw ArgumentError("option " + shown + " needs a value, " + std::string(slot.value_name) + "; " +
                          see_help(command));
    }
    if (!slot.choices.empty() && std::ranges::find(slot.choices, text) == slot.choices.end()) {
      throw ArgumentError("unknown value '" + text + "' of " + shown + did_you_mean(text, slot.choices));
    }
  }
}

}  // namespace

Invocation parse(std::span<const Command> commands, const std::vector<std::string>& words) {
  CLI::App app;
  app.set_help_flag();
  app.allow_extras();
  app.require_subcommand(0, 1);
  std::deque<Slot> common;
  for (const auto& option : common_options()) add_option(app, common, option);

  struct Known {
    const Command* command;
    CLI::App* app;
    std::deque<Slot> slots;
  };
  std::deque<Known> known;
  for (const auto& command : commands) {
    auto& entry = known.emplace_back(Known{&command, app.add_subcommand(std::string(command.name)), {}});
    entry.app->set_help_flag();
    entry.app->fallthrough();
    entry.app->allow_extras();
    for (const auto& option : command.options) add_option(*entry.app, entry.slots, option);
    for (const auto& positional : command.positionals) add_positional(*entry.app, entry.slots, positional);
  }

  const auto named = std::ranges::find_first_of(words, commands, {}, {}, &Command::name);
  const Command* likely =
      named == words.end() ? nullptr : &*std::ranges::find(commands, std::string_view(*named), &Command::name);
  try {
    std::vector<std::string> reversed(words.rbegin(), words.rend());
    app.parse(reversed);
  } catch (const CLI::ArgumentMismatch& error) {
    const std::string text = error.what();
    throw ArgumentError("option " + text.substr(0, text.find(':')) + " needs a value; " + see_help(likely));
  } catch (const CLI::ParseError& error) {
    std::string text = error.what();
    if (!text.empty() && text.back() == '.') text.pop_back();
    throw ArgumentError(text + "; " + see_help(likely));
  }

  Invocation invocation;
  const auto used = std::ranges::find_if(known, [](const Known& entry) { return entry.app->parsed(); });
  if (used != known.end()) invocation.command = used->command;
  const auto collect = [&](const std::deque<Slot>& slots) {
    for (const auto& slot : slots) {
      invocation.arguments.declare(slot.handle);
      if (slot.option->count() > 0) invocation.arguments.set(slot.handle.name(), slot.texts);
    }
  };
  collect(common);
  if (used != known.end()) collect(used->slots);

  // Judge what is left over before what is missing: a misspelt option is the cause of both.
  auto rest = app.remaining(true);
  const auto dashed = std::ranges::find_if(rest, [](const auto& word) { return word.size() > 1 && word[0] == '-'; });
  if (dashed != rest.end() && *dashed != "--") reject_unknown_option(*dashed, invocation.command);
  if (invocation.arguments.has(option::help) || invocation.arguments.has(option::version)) return invocation;
  if (used == known.end()) {
    if (!rest.empty()) reject_unknown_command(commands, rest.front());
    throw ArgumentError("no command given; see 'lobe --help'");
  }
  for (const auto& slot : common) check_slot(slot, invocation.command);
  for (const auto& slot : used->slots) check_slot(slot, invocation.command);
  std::erase(rest, "--");
  if (!rest.empty()) {
    throw ArgumentError("too many arguments, from '" + rest.front() + "' on; " + see_help(invocation.command));
  }
  // Whoever reads it first leaves nothing to others.
  if (std::ranges::count_if(words, [](const auto& word) { return word == "-" || word == "/dev/stdin"; }) > 1) {
    throw ArgumentError("standard input is named twice; expected one '-'");
  }
  return invocation;
}

}  // namespace lobe::cli
