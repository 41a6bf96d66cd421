// The mutants of C++ sources and OpenCL kernels: each exchanges one operator, constant or call for another that a test
// ought to tell from it. script/mutate compiles and judges them. usage: list_mutants SEED FILE... A line per place and
// one of its mutants, in the random order of the seed: key, file, line, offset and length in bytes, what stands there,
// what the mutant has instead; between tabs. The order depends on the text of lines and not on their numbers: other
// changes of a file leave the sequence of those that are still there. Left out are comments, texts, preprocessor lines,
// arguments of templates, what stands in brackets, heads of loops (their mutants crash or never end, which any test
// notices), static assertions, and statements that throw.
#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <iterator>
#include <map>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "support/source_tokens.hpp"

namespace {

using lobe::test::Kind;
using lobe::test::Token;

struct Mutant {
  std::uint64_t site;  // random numbers, alike for all mutants of a site
  std::uint64_t key;
  std::string file;
  std::size_t line;
  std::size_t offset;
  std::size_t length;
  std::string before;
  std::string after;
};

class Source {
 public:
  Source(std::uint64_t seed, std::string file) : seed_{seed}, file_{std::move(file)} {
    std::ifstream stream{file_, std::ios::binary};
    if (!stream) {
      std::cerr << "list_mutants: " << file_ << " cannot be read\n";
      std::exit(2);
    }
    text_.assign(std::istreambuf_iterator<char>{stream}, {});
    clean_ = lobe::test::without_text(text_);
    tokens_ = lobe::test::tokens_of(clean_);
  }

  std::vector<Mutant> mutants() {
    bool left_out = false;  // until the end of the statement
    std::size_t brackets = 0;
    std::size_t head = 0;  // depth of the parentheses of a loop's head
    for (std::size_t i = 0; i < tokens_.size(); ++i) {
      const std::string_view text = tokens_[i].text;
      if (text == "throw" || text == "static_assert" || text == "using" || text == "template" || text == "case" ||
          text == "enum" || text == "CHECK_THROWS") {
        left_out = true;
      }
      if (text == ";" || text == "{" || text == ":") left_out = false;
      if (text == "[") ++brackets;
      if (text == "]" && brackets > 0) --brackets;
      if (head > 0) head += text == "(" ? 1U : 0U;
      if (head > 0) head -= text == ")" ? 1U : 0U;
      if (text == "for" && i + 1 < tokens_.size() && tokens_[i + 1].text == "(") {
        ++i;
        head = 1;
        continue;
      }
      if (left_out || brackets > 0 || head > 0) continue;
      const std::size_t end = end_of_template(i);
      if (end != i) {
        i = end;
        continue;
      }
      look_at(i);
    }
    return std::move(mutants_);
  }

 private:
  [[nodiscard]] bool spaced(const Token& token) const {
    const std::size_t end = token.offset + token.text.size();
    const auto blank = [&](std::size_t at) {
      return at < clean_.size() && std::isspace(static_cast<unsigned char>(clean_[at])) != 0;
    };
    return token.offset > 0 && blank(token.offset - 1) && blank(end);
  }

  // The last token of arguments of a template that begin here, else i itself. The style tells them from comparisons.
  [[nodiscard]] std::size_t end_of_template(std::size_t i) const {
    const Token& token = tokens_[i];
    if (token.text != "<" || spaced(token) || i == 0 || tokens_[i - 1].kind != Kind::Name) return i;
    std::size_t depth = 1;
    for (std::size_t j = i + 1; j < tokens_.size(); ++j) {
      const std::string_view text = tokens_[j].text;
      if (text == ";" || text == "{") return i;
      if (text == "<" && !spaced(tokens_[j])) ++depth;
      if (text == ">" && --depth == 0) return j;
    }
    return i;
  }

  void add(std::size_t offset, std::size_t length, std::string after) {
    const std::string before = text_.substr(offset, length);
    if (before == after) return;
    const std::size_t begin = offset == 0 ? 0 : text_.rfind('\n', offset - 1) + 1;
    const std::string content = text_.substr(begin, std::min(text_.find('\n', offset), text_.size()) - begin);
    const auto line =
        static_cast<std::size_t>(std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(offset), '\n')) +
        1;
    if (before.find("//") != std::string::npos) return;
    const std::string place = file_ + '\n' + content + '\n' + std::to_string(offset - begin) + '\n';
    const std::string name = place + before + '\n' + after + '\n';
    const std::string times = std::to_string(seen_[name]++);
    mutants_.push_back(
        {hashed(place + times), hashed(name + times), file_, line, offset, length, before, std::move(after)});
  }

  // FNV-1a, then the finaliser of SplitMix64.
  [[nodiscard]] std::uint64_t hashed(const std::string& name) const {
    std::uint64_t hash = 0xcbf29ce484222325U ^ (seed_ * 0x9e3779b97f4a7c15U);
    for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
    hash = (hash ^ (hash >> 30U)) * 0xbf58476d1ce4e5b9U;
    hash = (hash ^ (hash >> 27U)) * 0x94d049bb133111ebU;
    return hash ^ (hash >> 31U);
  }

  void look_at(std::size_t i) {
    const Token& token = tokens_[i];
    switch (token.kind) {
      case Kind::Mark:
        look_at_operator(token);
        break;
      case Kind::Number:
        look_at_number(token);
        break;
      case Kind::Name:
        look_at_call(i);
        break;
    }
  }

  void look_at_operator(const Token& token) {
    static const std::map<std::string_view, std::vector<std::string>> exchanges = {
        {"+", {"-"}},       {"-", {"+"}},        {"*", {"/"}},       {"/", {"*"}},
        {"+=", {"-="}},     {"-=", {"+="}},      {"*=", {"/="}},     {"/=", {"*="}},
        {"<", {"<=", ">"}}, {"<=", {"<", ">="}}, {">", {">=", "<"}}, {">=", {">", "<="}},
        {"==", {"!="}},     {"!=", {"=="}},      {"&&", {"||"}},     {"||", {"&&"}}};
    const auto found = exchanges.find(token.text);
    if (found == exchanges.end() || !spaced(token)) return;
    for (const std::string& after : found->second) add(token.offset, token.text.size(), after);
  }

  void look_at_number(const Token& token) {
    std::string digits{token.text};
    digits.erase(std::remove(digits.begin(), digits.end(), '\''), digits.end());
    if (digits.size() > 1 && (digits[1] == 'x' || digits[1] == 'X' || digits[1] == 'b')) return;
    const bool real = digits.find_first_of(".eE") != std::string::npos;
    const std::size_t suffix = digits.find_first_not_of("0123456789.eE+-");
    if (suffix != std::string::npos && digits.substr(suffix) != "f" && digits.substr(suffix) != "U") return;
    const double value = std::strtod(digits.c_str(), nullptr);
    const std::string text{token.text};
    if (value == 0) {
      add(token.offset, text.size(), real ? "1.0" : "1");
      return;
    }
    const std::string tail = suffix == std::string::npos ? "" : digits.substr(suffix);
    add(token.offset, text.size(), "(2 * " + text + ")");
    if (real) {
      add(token.offset, text.size(), "(0.5" + tail + " * " + text + ")");
    } else if (value != 1) {
      add(token.offset, text.size(), "(" + text + " / 2)");
      add(token.offset, text.size(), "(" + text + " + 1)");
    }
    add(token.offset, text.size(), real ? "0.0" + tail : "0" + tail);
  }

  // max(a, b): the other one of the two, a, and b. abs(a): a.
  void look_at_call(std::size_t i) {
    static const std::map<std::string_view, std::string> exchanges = {
        {"min", "max"}, {"max", "min"}, {"fmin", "fmax"}, {"fmax", "fmin"}, {"abs", ""}, {"fabs", ""}};
    const auto found = exchanges.find(tokens_[i].text);
    if (found == exchanges.end() || i == 0 || tokens_[i - 1].text == "." || tokens_[i - 1].text == "->") return;
    std::size_t open = i + 1;
    if (open < tokens_.size() && tokens_[open].text == "<") open = end_of_template(open) + 1;
    if (open >= tokens_.size() || tokens_[open].text != "(") return;
    const bool qualified = i > 1 && tokens_[i - 1].text == "::" && tokens_[i - 2].text == "std";
    const std::size_t begin = qualified ? tokens_[i - 2].offset : tokens_[i].offset;
    std::vector<std::size_t> commas;
    std::size_t depth = 0;
    std::size_t close = open;
    for (; close < tokens_.size(); ++close) {
      const std::string_view text = tokens_[close].text;
      if (text == "(" || text == "{" || text == "[") ++depth;
      if ((text == ")" || text == "}" || text == "]") && --depth == 0) break;
      if (text == "," && depth == 1) commas.push_back(tokens_[close].offset);
    }
    if (close == tokens_.size()) return;
    const std::size_t first = tokens_[open].offset + 1;
    const std::size_t last = tokens_[close].offset;
    const std::size_t length = last + 1 - begin;
    const auto inside = [&](std::size_t from, std::size_t to) {
      while (from < to && std::isspace(static_cast<unsigned char>(text_[from])) != 0) ++from;
      return "(" + text_.substr(from, to - from) + ")";
    };
    if (found->second.empty()) {
      if (commas.empty()) add(begin, length, inside(first, last));
      return;
    }
    add(tokens_[i].offset, tokens_[i].text.size(), found->second);
    if (commas.size() != 1) return;
    add(begin, length, inside(first, commas[0]));
    add(begin, length, inside(commas[0] + 1, last));
  }

  std::uint64_t seed_;
  std::string file_;
  std::string text_;
  std::string clean_;
  std::vector<Token> tokens_;
  std::vector<Mutant> mutants_;
  std::map<std::string, std::size_t> seen_;
};

// On one line, for the table.
std::string shown(std::string text) {
  std::string line;
  for (const char c : text) {
    const bool blank = std::isspace(static_cast<unsigned char>(c)) != 0;
    if (!blank) line += c;
    if (blank && !line.empty() && line.back() != ' ') line += ' ';
  }
  return line;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::cerr << "usage: list_mutants SEED FILE...\n";
    return 2;
  }
  const std::uint64_t seed = std::strtoull(argv[1], nullptr, 10);
  std::vector<Mutant> mutants;
  for (int i = 2; i < argc; ++i) {
    for (Mutant& mutant : Source{seed, argv[i]}.mutants()) mutants.push_back(std::move(mutant));
  }
  std::sort(mutants.begin(), mutants.end(),
            [](const Mutant& a, const Mutant& b) { return std::tie(a.site, a.key) < std::tie(b.site, b.key); });
  std::uint64_t last = 0;
  for (const Mutant& mutant : mutants) {
    if (mutant.site == std::exchange(last, mutant.site)) continue;
    std::cout << std::hex << mutant.key << std::dec << '\t' << mutant.file << '\t' << mutant.line << '\t'
              << mutant.offset << '\t' << mutant.length << '\t' << shown(mutant.before) << '\t' << shown(mutant.after)
              << '\n';
  }
  return 0;
}
