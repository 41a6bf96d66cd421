#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace lobe::cli {

/// A piece of a page of help.
struct Block {
  enum class Kind {
    paragraph,
    entry,    ///< an item of a list and what it means
    example,  ///< a line to be typed and, before it, what it does
    verbatim  ///< lines as they stand in a file
  };
  Kind kind = Kind::paragraph;
  std::string text;       ///< for people
  std::string item = {};  ///< the term that an entry explains, or the line of an example
};

[[nodiscard]] Block paragraph(std::string_view text);
[[nodiscard]] Block entry(std::string_view item, std::string_view text);

/// Blocks under a heading.
struct Section {
  std::string title;
  std::vector<Block> blocks;
};

/// Help on one thing, to be shown on a terminal, as a manual page or in a browser. All are made from this alone.
struct Page {
  std::string name;     ///< "lobe run" of a command, "grids" of a topic
  std::string summary;  ///< one phrase
  std::string usage = {};
  std::vector<Section> sections;  ///< the first one may lack a title
};

/// For a terminal, 80 columns wide.
[[nodiscard]] std::string terminal_text(const Page& page);

/// In the language of man(7).
/// \param section of the manual: '1' commands, '7' conventions
/// \param see_also other manual pages: "lobe(1)"
[[nodiscard]] std::string manual_text(const Page& page, char section, const std::vector<std::string>& see_also);

/// As the body of a page of the documentation site; a heading has its title, in small letters with dashes, as anchor.
/// \param pages names that have pages of their own, NAME.html: entries of these names are links
[[nodiscard]] std::string html_text(const Page& page, const std::vector<std::string>& pages = {});

}  // namespace lobe::cli
