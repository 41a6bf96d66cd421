#include "interface/help.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "core/text.hpp"
#include "interface/exit_code.hpp"
#include "interface/reading.hpp"
#include "interface/report.hpp"
#include "interface/session.hpp"
#include "interface/topics.hpp"
#include "lobe/core/error.hpp"
#include "lobe/core/version.hpp"

namespace lobe::cli {
namespace {

constexpr Text kTopic{"TOPIC"};

constexpr std::string_view kPurpose = "composes BRDFs as operators and measures distances between them on OpenCL";
constexpr std::string_view kUsage = "lobe COMMAND [ARGUMENTS] [OPTIONS]";

std::vector<Example> root_examples() {
  return {{"what there is to compare", "lobe models"},
          {"distance of two materials", "lobe distance phong:n=20 ward:m=0.2"}};
}

Block option_entry(const Option& option) {
  std::string item = option.letter == '\0' ? "    " : fmt::format("-{}, ", option.letter);
  item += option.handle.dashed();
  if (!option.value.empty()) item += fmt::format(" {}", option.value);
  return entry(item, option.help);
}

std::vector<Block> option_entries(std::span<const Option> options) {
  std::vector<Block> blocks;
  for (const auto& option : options) blocks.push_back(option_entry(option));
  return blocks;
}

Section examples_section(std::span<const Example> examples) {
  Section section{"Examples", {}};
  for (const auto& [purpose, line] : examples) {
    section.blocks.push_back({.kind = Block::Kind::example, .text = std::string(purpose), .item = std::string(line)});
  }
  return section;
}

std::string topic_names() {
  std::string names;
  for (const auto& topic : topics()) names += fmt::format("{}{}", names.empty() ? "" : ", ", topic.name);
  return names;
}

std::string usage_of(const Command& command) {
  std::string usage = fmt::format("lobe {}", command.name);
  for (const auto& positional : command.positionals) {
    usage += positional.required ? fmt::format(" {}", positional.name()) : fmt::format(" [{}]", positional.name());
    if (positional.is_repeated) usage += "...";
  }
  for (const auto& option : command.options) {
    if (option.required) usage += fmt::format(" {} {}", option.handle.dashed(), option.value);
  }
  return usage + " [OPTIONS]";
}

ExitCode execute_help(Session& session) {
  const std::string& name = session.arguments().text(kTopic);
  std::vector<std::string_view> known;
  for (const auto& topic : topics()) {
    if (topic.name == name) session.print(terminal_text(topic_page(topic)));
    known.push_back(topic.name);
  }
  for (const auto& command : commands()) {
    if (command.name == name) session.print(terminal_text(command_page(command)));
    known.push_back(command.name);
  }
  if (name.empty()) session.print(overview(commands()));
  if (session.output().empty()) throw ArgumentError("no help on '" + name + "'" + did_you_mean(name, known));
  return ExitCode::success;
}

}  // namespace

std::string overview(std::span<const Command> commands) {
  constexpr std::size_t kNames = 12;
  constexpr std::size_t kSummaries = 29;
  std::string text = fmt::format("{}\nUsage: {}\n\n", wrap(fmt::format("lobe {}.", kPurpose), 0), kUsage);
  std::string_view group;
  for (const auto& command : commands) {
    const std::string_view heading = command.group == group ? std::string_view{} : command.group;
    group = command.group;
    text += fmt::format("{:<{}}{:<{}}{}\n", heading, kNames, command.name, kSummaries - kNames,
                        wrap(command.summary, kSummaries));
  }
  text += fmt::format("\n{}\n", wrap(fmt::format("'lobe COMMAND --help' explains a command and its options, 'lobe help "
                                                 "TOPIC' one of {}.",
                                                 topic_names()),
                                     0));
  text += "Examples:\n";
  for (const auto& example : root_examples()) text += fmt::format("  {}\n", example.line);
  return text;
}

Page lobe_page(std::span<const Command> commands) {
  Page page{.name = "lobe", .summary = std::string(kPurpose), .usage = std::string(kUsage), .sections = {}};
  for (const auto& command : commands) {
    if (page.sections.empty() || page.sections.back().title != command.group) {
      page.sections.push_back({std::string(command.group), {}});
    }
    page.sections.back().blocks.push_back(entry(command.name, command.summary));
  }
  page.sections.push_back({"Common options, before or after the command", option_entries(common_options())});
  Section help{"Topics of 'lobe help'", {}};
  for (const auto& topic : topics()) help.blocks.push_back(entry(topic.name, topic.summary));
  page.sections.push_back(std::move(help));
  Section status{"Exit status", {}};
  for (const auto& [code, meaning] : kExitMeanings) {
    status.blocks.push_back(entry(std::to_string(static_cast<int>(code)), meaning));
  }
  page.sections.push_back(std::move(status));
  page.sections.push_back(examples_section(root_examples()));
  return page;
}

Page command_page(const Command& command) {
  Page page{.name = fmt::format("lobe {}", command.name),
            .summary = std::string(command.summary),
            .usage = usage_of(command),
            .sections = {{"", {}}}};
  for (const auto text : split(command.description, '\n')) page.sections[0].blocks.push_back(paragraph(text));
  if (!command.positionals.empty()) {
    Section arguments{"Arguments", {}};
    for (const auto& positional : command.positionals) {
      arguments.blocks.push_back(entry(positional.name(), positional.help));
    }
    page.sections.push_back(std::move(arguments));
  }
  const bool takes_materials = std::ranges::any_of(command.positionals, &Positional::is_material);
  const std::span<const Option> options(command.options);
  const std::size_t of_files = takes_materials ? reading_options().size() : 0;  // they are the last ones
  if (options.size() > of_files) {
    page.sections.push_back({"Options", option_entries(options.first(options.size() - of_files))});
  }
  if (of_files > 0) {
    page.sections.push_back(
        {"Options of files, also FILE[theta_max=80,luminance=rec709]", option_entries(options.last(of_files))});
  }
  page.sections.push_back({"Common options", option_entries(common_options())});
  if (takes_materials) {
    page.sections.push_back(
        {"Materials",
         {paragraph(
             "A material is MODEL[:key=value,...], where besides the model's parameters scale=x multiplies it; "
             "several are added by '+', as in lambert:scale=0.3+ward:m=0.1,scale=0.5. Or it is the path of a "
             ".toml file, of a table (.h5), or of a file of another program. 'lobe help materials' has more.")}});
  }
  page.sections.push_back(examples_section(command.examples));
  return page;
}

std::vector<ManualPage> manual(std::span<const Command> commands) {
  std::vector<std::string> all;
  for (const auto& command : commands) all.push_back(fmt::format("lobe-{}(1)", command.name));
  std::vector<std::string> others{"lobe(1)"};
  for (const auto& topic : topics()) others.push_back(fmt::format("lobe-{}(7)", topic.name));
  all.insert(all.end(), others.begin() + 1, others.end());

  std::vector<ManualPage> pages{{"lobe.1", manual_text(lobe_page(commands), '1', all)}};
  for (const auto& command : commands) {
    pages.push_back({fmt::format("lobe-{}.1", command.name), manual_text(command_page(command), '1', others)});
  }
  for (const auto& topic : topics()) {
    pages.push_back({fmt::format("lobe-{}.7", topic.name), manual_text(topic_page(topic), '7', {"lobe(1)"})});
  }
  return pages;
}

std::string version_text() {
  return fmt::format("lobe {}\ncommit: {}\nOpenCL headers: {}\nHDF5: {}\n", version(), commit(),
                     opencl_headers_version(), hdf5_version().substr(hdf5_version().rfind(' ') + 1));
}

Command help_command() {
  return {.name = "help",
          .group = "Reference",
          .summary = "explain a command or a topic",
          .description = "Prints help on a command or a topic; without a name, the list of commands.",
          .positionals = {{.handle = kTopic, .help = "command or topic", .required = false}},
          .options = {},
          .examples = {{"how to write materials", "lobe help materials"}, {"help on a command", "lobe help distance"}},
          .execute = execute_help};
}

}  // namespace lobe::cli
