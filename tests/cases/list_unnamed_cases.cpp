// Lists claims in loops of tests that do not say which case failed. A claim says so by a message, a SCOPED_TRACE inside
// the loop, an argument that is the loop's variable, which GoogleTest prints, or a matcher made of it.
// usage: list_unnamed_cases FILE...   Fails if it lists any.
#include <algorithm>
#include <cstddef>
#include <fstream>
#include <iostream>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "support/source_tokens.hpp"

namespace {

using lobe::test::Kind;
using lobe::test::Token;

struct Loop {
  std::size_t first;  // tokens of the body
  std::size_t last;
  std::vector<std::string_view> variables;
};

class Test {
 public:
  explicit Test(std::string text)
      : text_(lobe::test::without_text(std::move(text))), tokens_(lobe::test::tokens_of(text_)) {}

  // Lines of claims without a name.
  [[nodiscard]] std::vector<std::size_t> unnamed() const {
    const std::vector<Loop> loops = all_loops();
    std::vector<std::size_t> lines;
    for (std::size_t i = 0; i + 1 < tokens_.size(); ++i) {
      if (!is_claim(i)) continue;
      std::vector<Loop> around;
      std::ranges::copy_if(loops, std::back_inserter(around),
                           [&](const Loop& loop) { return loop.first <= i && i <= loop.last; });
      if (around.empty() || is_named(i, around)) continue;
      lines.push_back(static_cast<std::size_t>(std::count(text_.begin(), text_.begin() + offset(i), '\n')) + 1);
    }
    return lines;
  }

 private:
  [[nodiscard]] std::string_view text(std::size_t i) const { return i < tokens_.size() ? tokens_[i].text : ""; }
  [[nodiscard]] std::ptrdiff_t offset(std::size_t i) const { return static_cast<std::ptrdiff_t>(tokens_[i].offset); }

  [[nodiscard]] bool is_claim(std::size_t i) const {
    return (text(i).starts_with("EXPECT_") || text(i).starts_with("ASSERT_")) && text(i + 1) == "(";
  }

  // How a token changes the depth of brackets.
  [[nodiscard]] int step(std::size_t i) const {
    const std::string_view mark = text(i);
    if (mark == "(" || mark == "[" || mark == "{") return 1;
    return mark == ")" || mark == "]" || mark == "}" ? -1 : 0;
  }

  // The bracket that closes the one here.
  [[nodiscard]] std::size_t closing(std::size_t open) const {
    int depth = 0;
    for (std::size_t i = open; i < tokens_.size(); ++i) {
      depth += step(i);
      if (depth == 0) return i;
    }
    return tokens_.size();
  }

  // The last token of the statement that begins here.
  [[nodiscard]] std::size_t end_of_statement(std::size_t first) const {
    if (text(first) == "{") return closing(first);
    if (text(first) == "for" || text(first) == "while" || text(first) == "if") {
      const std::size_t head = text(first + 1) == "constexpr" ? first + 2 : first + 1;
      const std::size_t end = end_of_statement(closing(head) + 1);
      return text(first) == "if" && text(end + 1) == "else" ? end_of_statement(end + 2) : end;
    }
    int depth = 0;
    for (std::size_t i = first; i < tokens_.size(); ++i) {
      depth += step(i);
      if (depth == 0 && text(i) == ";") return i;
    }
    return tokens_.size();
  }

  [[nodiscard]] std::vector<Loop> all_loops() const {
    std::vector<Loop> loops;
    for (std::size_t i = 0; i + 1 < tokens_.size(); ++i) {
      if ((text(i) != "for" && text(i) != "while") || text(i + 1) != "(") continue;
      const std::size_t close = closing(i + 1);
      if (text(close + 1) == ";") continue;  // of a do
      loops.push_back({close + 1, end_of_statement(close + 1), variables(i + 2, close)});
    }
    return loops;
  }

  // Those that the head of a loop declares: the names before its colon, or those that get a value at its beginning.
  [[nodiscard]] std::vector<std::string_view> variables(std::size_t first, std::size_t close) const {
    std::vector<std::string_view> names;
    int depth = 0;
    for (std::size_t i = first; i < close && text(i) != ";"; ++i) {
      depth += step(i);
      if (text(i) == "=" && depth == 0) names.push_back(text(i - 1));
      if (text(i) != ":" || depth > 0) continue;
      if (text(i - 1) != "]") return {text(i - 1)};
      names.clear();
      for (std::size_t j = i - 2; text(j) != "["; --j) {
        if (tokens_[j].kind == Kind::Name) names.push_back(text(j));
      }
      return names;
    }
    return names;
  }

  [[nodiscard]] bool is_named(std::size_t claim, const std::vector<Loop>& around) const {
    const std::size_t close = closing(claim + 1);
    for (std::size_t i = close; i < end_of_statement(close + 1); ++i) {
      if (text(i) == "<<") return true;
    }
    const auto is_variable = [&](std::size_t i) {
      return std::ranges::any_of(around, [&](const Loop& loop) { return std::ranges::count(loop.variables, text(i)); });
    };
    const bool prints_arguments = !text(claim).ends_with("_TRUE") && !text(claim).ends_with("_FALSE");
    const bool is_match = text(claim).ends_with("_THAT");
    int depth = 0;
    bool is_matcher = false;
    for (std::size_t i = claim + 2; i < close && prints_arguments; ++i) {
      depth += step(i);
      is_matcher = is_matcher || (is_match && depth == 0 && text(i) == ",");
      const bool is_alone =
          depth == 0 && (text(i - 1) == "," || i == claim + 2) && (text(i + 1) == "," || i + 1 == close);
      if ((is_alone || is_matcher) && is_variable(i)) return true;
    }
    return has_trace(std::ranges::min(around, {}, &Loop::first).first, claim);
  }

  // Whether a SCOPED_TRACE between the two is still in force at the second.
  [[nodiscard]] bool has_trace(std::size_t first, std::size_t claim) const {
    int depth = 0;
    int least = 0;  // since the claim, backwards
    for (std::size_t i = claim; i > first; --i) {
      depth += text(i) == "}" ? 1 : text(i) == "{" ? -1 : 0;
      least = std::min(least, depth);
      if (text(i) == "SCOPED_TRACE" && depth == least) return true;
    }
    return false;
  }

  std::string text_;
  std::vector<Token> tokens_;
};

std::optional<std::string> content_of(const char* path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) return {};
  return std::string(std::istreambuf_iterator<char>(stream), {});
}

}  // namespace

int main(int argc, char** argv) {
  bool is_good = argc > 1;
  for (int i = 1; i < argc; ++i) {
    const auto text = content_of(argv[i]);
    if (!text) {
      std::cerr << "list_unnamed_cases: " << argv[i] << " cannot be read\n";
      return 2;
    }
    for (const std::size_t line : Test(*text).unnamed()) {
      std::cout << argv[i] << ':' << line << ": a claim in a loop does not say which case failed\n";
      is_good = false;
    }
  }
  return is_good ? 0 : 1;
}
