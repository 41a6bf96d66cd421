// C++ and OpenCL sources as tokens, for checks that read them.
#pragma once

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lobe::test {

enum class Kind { Name, Number, Mark };

struct Token {
  Kind kind;
  std::string_view text;
  std::size_t offset;
};

inline bool is_word(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

// Comments, texts and preprocessor lines become blanks; offsets stay.
inline std::string without_text(std::string text) {
  const auto blank = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < std::min(end, text.size()); ++i) {
      if (text[i] != '\n') text[i] = ' ';
    }
  };
  const auto find = [&](std::string_view what, std::size_t from) {
    return std::min(text.find(what, from), text.size());
  };
  bool line_begins = true;
  for (std::size_t i = 0; i < text.size();) {
    std::size_t end = i + 1;
    if (text.compare(i, 2, "//") == 0) {
      end = find("\n", i);
    } else if (text.compare(i, 2, "/*") == 0) {
      end = find("*/", i) + 2;
    } else if (text.compare(i, 2, "R\"") == 0) {
      const std::size_t open = find("(", i);
      const std::string close = ")" + text.substr(i + 2, open - i - 2) + "\"";
      end = find(close, open) + close.size();
    } else if (text[i] == '"' || (text[i] == '\'' && (i == 0 || !is_word(text[i - 1])))) {
      while (end < text.size() && text[end] != text[i]) end += text[end] == '\\' ? 2U : 1U;
      ++end;
    } else if (text[i] == '#' && line_begins) {
      end = find("\n", i);
      while (end < text.size() && text[end - 1] == '\\') end = find("\n", end + 1);
    } else {
      line_begins = text[i] == '\n' || (line_begins && text[i] == ' ');
      ++i;
      continue;
    }
    blank(i, end);
    i = end;
  }
  return text;
}

inline std::vector<Token> tokens_of(std::string_view text) {
  static constexpr auto kMarks =
      std::to_array<std::string_view>({"<<=", ">>=", "<=>", "...", "->*", "+=", "-=", "*=", "/=", "%=", "<=", ">=",
                                       "==",  "!=",  "&&",  "||",  "++",  "--", "->", "::", "<<", "&=", "|=", "^="});
  std::vector<Token> tokens;
  for (std::size_t i = 0; i < text.size();) {
    const char c = text[i];
    if (std::isspace(static_cast<unsigned char>(c)) != 0) {
      ++i;
      continue;
    }
    std::size_t end = i + 1;
    Kind kind = Kind::Mark;
    const bool digit = std::isdigit(static_cast<unsigned char>(c)) != 0;
    if (digit || (c == '.' && i + 1 < text.size() && std::isdigit(static_cast<unsigned char>(text[i + 1])) != 0)) {
      kind = Kind::Number;
      while (end < text.size() &&
             (is_word(text[end]) || text[end] == '.' || (text[end] == '\'' && is_word(text[end + 1])) ||
              ((text[end] == '-' || text[end] == '+') && (text[end - 1] == 'e' || text[end - 1] == 'E')))) {
        ++end;
      }
    } else if (is_word(c)) {
      kind = Kind::Name;
      while (end < text.size() && is_word(text[end])) ++end;
    } else {
      for (const std::string_view mark : kMarks) {
        if (text.substr(i, mark.size()) == mark) {
          end = i + mark.size();
          break;
        }
      }
    }
    tokens.push_back({kind, text.substr(i, end - i), i});
    i = end;
  }
  return tokens;
}

}  // namespace lobe::test
