#include "interface/page.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>

#include "core/text.hpp"
#include "interface/report.hpp"
#include "lobe/core/version.hpp"

namespace lobe::cli {
namespace {

constexpr std::size_t kIndent = 26;  // where explanations begin

std::string entry_text(const Block& block) {
  std::string line = fmt::format("  {:<{}}", block.item, kIndent - 2);
  if (line.size() > kIndent) line += fmt::format("\n{:{}}", "", kIndent);
  return line + wrap(block.text, kIndent) + "\n";
}

std::string block_text(const Block& block, bool is_first) {
  switch (block.kind) {
    case Block::Kind::paragraph:
      return (is_first ? "" : "\n") + wrap(block.text, 0) + "\n";
    case Block::Kind::entry:
      return entry_text(block);
    case Block::Kind::example:
      return fmt::format("  # {}\n  {}\n", block.text, block.item);
    case Block::Kind::verbatim:
      break;
  }
  std::string text = "\n";
  for (const auto line : split(block.text, '\n')) text += line.empty() ? "\n" : fmt::format("  {}\n", line);
  return text;
}

std::string upper(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return text;
}

/// A text that roff takes for nothing else: no escapes, no requests, and dashes that can be copied.
std::string escaped(std::string_view text) {
  constexpr std::string_view kPlusMinus = "±";
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (text.substr(i).starts_with(kPlusMinus)) {
      result += "\\[+-]";
      i += kPlusMinus.size() - 1;
    } else if (c == '\\') {
      result += "\\e";
    } else if (c == '-') {
      result += "\\-";
    } else if (c == '\'') {
      result += "\\(aq";
    } else if (c == '.' && (result.empty() || result.back() == '\n')) {
      result += "\\&.";
    } else {
      result += c;
    }
  }
  return result;
}

/// "-o, --output DIR": what stands for a value is slanted, the rest bold.
std::string marked(std::string_view item) {
  std::string result;
  for (const auto word : split(item, ' ')) {
    const bool is_value = std::ranges::all_of(word, [](unsigned char c) { return std::islower(c) == 0 && c != '-'; });
    if (!result.empty()) result += ' ';
    if (!word.empty()) result += (is_value ? "\\fI" : "\\fB") + escaped(word) + "\\fR";
  }
  return result;
}

std::string manual_block(const Block& block) {
  switch (block.kind) {
    case Block::Kind::paragraph:
      return ".PP\n" + escaped(block.text) + "\n";
    case Block::Kind::entry:
      return ".TP\n" + marked(block.item) + "\n" + escaped(block.text) + "\n";
    case Block::Kind::example:
      return ".PP\n" + escaped(block.text) + ":\n.PP\n.nf\n.RS\n\\fB" + escaped(block.item) + "\\fR\n.RE\n.fi\n";
    case Block::Kind::verbatim:
      break;
  }
  return ".PP\n.nf\n" + escaped(block.text) + "\n.fi\n";
}

/// "a-title-like-this" of "A title, like this".
std::string anchor_of(std::string_view title) {
  std::string anchor;
  for (const char c : lowercase(title)) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) anchor += c;
    if (c == ' ' || c == '-') anchor += '-';
  }
  return anchor;
}

std::string html_block(const Block& block, const std::vector<std::string>& pages) {
  const std::string item = escaped_markup(trim(block.item));
  const std::string text = escaped_markup(trim(block.text));
  switch (block.kind) {
    case Block::Kind::paragraph:
      return fmt::format("<p>{}</p>\n", text);
    case Block::Kind::entry: {
      const bool has_page = std::ranges::find(pages, block.item) != pages.end();
      const std::string name = fmt::format("<code>{}</code>", item);
      return fmt::format("<dt>{}</dt>\n<dd>{}</dd>\n",
                         has_page ? fmt::format("<a href=\"{}.html\">{}</a>", item, name) : name, text);
    }
    case Block::Kind::example:
      return fmt::format("<p class=\"example\">{}</p>\n<pre class=\"console\"><code>{}</code></pre>\n", text, item);
    case Block::Kind::verbatim:
      break;
  }
  std::string lines;
  for (const auto line : split(block.text, '\n')) lines += escaped_markup(line) + "\n";
  return fmt::format("<pre><code>{}</code></pre>\n", lines);
}

}  // namespace

Block paragraph(std::string_view text) {
  return {.kind = Block::Kind::paragraph, .text = std::string(text)};
}

Block entry(std::string_view item, std::string_view text) {
  return {.kind = Block::Kind::entry, .text = std::string(text), .item = std::string(item)};
}

std::string terminal_text(const Page& page) {
  std::string text = wrap(fmt::format("{}: {}", page.name, page.summary), 0) + "\n";
  if (!page.usage.empty()) text += fmt::format("\nUsage: {}\n", page.usage);
  for (const auto& section : page.sections) {
    text += section.title.empty() ? "\n" : fmt::format("\n{}:\n", section.title);
    for (const auto& block : section.blocks) text += block_text(block, &block == section.blocks.data());
  }
  return text;
}

std::string manual_text(const Page& page, char section, const std::vector<std::string>& see_also) {
  std::string name = page.name.starts_with("lobe") ? page.name : "lobe-" + page.name;
  std::ranges::replace(name, ' ', '-');
  std::string text = fmt::format(".TH {} {} \"\" \"lobe {}\" \"{}\"\n.nh\n.ad l\n", upper(name), section, version(),
                                 section == '1' ? "User Commands" : "Conventions of lobe");
  text += fmt::format(".SH NAME\n{} \\- {}\n", escaped(name), escaped(page.summary));
  if (!page.usage.empty()) text += fmt::format(".SH SYNOPSIS\n{}\n", marked(page.usage));
  for (const auto& part : page.sections) {
    text += fmt::format(".SH {}\n", part.title.empty() ? "DESCRIPTION" : upper(part.title));
    for (const auto& block : part.blocks) text += manual_block(block);
  }
  text += ".SH \"SEE ALSO\"\n";
  for (const auto& other : see_also) {
    text += fmt::format(".BR {} {}{}\n", escaped(other.substr(0, other.find('('))), other.substr(other.find('(')),
                        &other == &see_also.back() ? "" : ",");
  }
  return text;
}

std::string html_text(const Page& page, const std::vector<std::string>& pages) {
  std::string text = fmt::format("<h1>{}</h1>\n<p class=\"summary\">{}</p>\n", escaped_markup(page.name),
                                 escaped_markup(page.summary));
  if (!page.usage.empty()) {
    text += fmt::format("<pre class=\"usage\"><code>{}</code></pre>\n", escaped_markup(page.usage));
  }
  for (const auto& section : page.sections) {
    if (!section.title.empty()) {
      text += fmt::format("<h2 id=\"{}\">{}</h2>\n", anchor_of(section.title), escaped_markup(section.title));
    }
    bool is_list = false;
    for (const auto& block : section.blocks) {
      if ((block.kind == Block::Kind::entry) != is_list) text += is_list ? "</dl>\n" : "<dl>\n";
      is_list = block.kind == Block::Kind::entry;
      text += html_block(block, pages);
    }
    if (is_list) text += "</dl>\n";
  }
  return text;
}

}  // namespace lobe::cli
