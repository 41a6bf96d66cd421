#include "formats/shader_tokens.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <system_error>
#include <utility>

#include "core/text.hpp"

namespace lobe {
namespace {

using Kind = ShaderToken::Kind;

constexpr std::size_t kMostReplaced = std::size_t{1} << 15;  // tokens
constexpr std::size_t kMostNested = 32;                      // macros in macros
constexpr std::size_t kMostMacros = 4096;
constexpr std::size_t kMostOpenGroups = 64;
constexpr std::size_t kLongestName = 128;

/// Those of several characters before those that they begin with.
constexpr std::array<std::string_view, 41> kSigns{"<<=", ">>=", "++", "--", "+=", "-=", "*=", "/=", "%=", "&=", "|=",
                                                  "^=",  "<=",  ">=", "==", "!=", "&&", "||", "^^", "<<", ">>", "(",
                                                  ")",   "[",   "]",  "{",  "}",  ".",  ",",  ";",  "+",  "-",  "*",
                                                  "/",   "%",   "<",  ">",  "=",  "!",  "?",  ":"};
constexpr std::array<std::string_view, 4> kBitSigns{"&", "|", "^", "~"};

bool is_shader_digit(char c) {
  return c >= '0' && c <= '9';
}

bool starts_shader_name(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

bool continues_shader_name(char c) {
  return starts_shader_name(c) || is_shader_digit(c);
}

}  // namespace

void refuse_shader(const FileBytes& file, const ShaderPlace& at, const std::string& complaint) {
  file.refuse(fmt::format("line {}, column {}: {}", at.line, at.column, complaint));
}

std::string suggestion(std::string_view word, std::span<const std::string_view> names) {
  constexpr std::size_t kMostListed = 8;
  constexpr std::size_t kLongestListed = 30;
  const bool are_short = std::ranges::all_of(names, [](std::string_view one) { return one.size() <= kLongestListed; });
  if (!names.empty() && names.size() <= kMostListed && are_short) return did_you_mean(word, names);
  const std::string near = nearest_word(word, names);
  return near.empty() ? "; expected one that the file declares before" : fmt::format("; did you mean '{}'?", near);
}

std::string shown(const ShaderToken& token) {
  return token.kind == Kind::end ? "the end of the file" : "'" + excerpt(token.text) + "'";
}

ShaderTokens::ShaderTokens(const FileBytes& file) : file_(file), text_(file.content()) {
  if (text_.starts_with("\xef\xbb\xbf")) at_ = 3;
  static const Macro kOne{.body = {{.kind = Kind::integer, .text = "1", .number = 1}}};
  macros_.emplace("GL_ES", kOne);
}

void ShaderTokens::refuse(const ShaderPlace& at, const std::string& complaint) const {
  refuse_shader(file_, at, complaint);
}

char ShaderTokens::peek(std::size_t ahead) const {
  return at_ + ahead < text_.size() ? text_[at_ + ahead] : '\0';
}

void ShaderTokens::step() {
  const char c = text_[at_++];
  if (c == '\n') {
    ++line_;
    column_ = 1;
    starts_line_ = true;
  } else if ((static_cast<unsigned char>(c) & 0xc0U) != 0x80U) {
    ++column_;
  }
}

bool ShaderTokens::is_end_of_line() const {
  return at_ == text_.size() || peek() == '\n';
}

void ShaderTokens::skip_blanks(bool within_line) {
  while (at_ < text_.size()) {
    const char c = peek();
    if (c == '\n' && within_line) return;
    if (c == '\\' && (peek(1) == '\n' || (peek(1) == '\r' && peek(2) == '\n'))) {
      const bool started = starts_line_;
      while (peek() != '\n') step();
      step();
      starts_line_ = started;
    } else if (c == ' ' || c == '\t' || c == '\n' || c == '\r') {
      step();
    } else if (c == '/' && peek(1) == '/') {
      while (!is_end_of_line()) step();
    } else if (c == '/' && peek(1) == '*') {
      const ShaderPlace opened = place();
      step();
      step();
      while (at_ < text_.size() && !(peek() == '*' && peek(1) == '/')) step();
      if (at_ == text_.size()) refuse(opened, "nothing closes this comment; expected '*/'");
      step();
      step();
    } else {
      return;
    }
  }
}

ShaderToken ShaderTokens::read_number() {
  const ShaderPlace at = place();
  const std::size_t first = at_;
  const bool is_hexadecimal = peek() == '0' && (peek(1) == 'x' || peek(1) == 'X');
  bool is_real = false;
  if (is_hexadecimal) {
    step();
    step();
    while (continues_shader_name(peek()) && peek() != 'u' && peek() != 'U') step();
  } else {
    const auto digits = [&] {
      while (is_shader_digit(peek())) step();
    };
    digits();
    if (peek() == '.') {
      is_real = true;
      step();
      digits();
    }
    if (peek() == 'e' || peek() == 'E') {
      const std::size_t sign = peek(1) == '+' || peek(1) == '-' ? 1 : 0;
      if (is_shader_digit(peek(1 + sign))) {
        is_real = true;
        for (std::size_t k = 0; k <= sign; ++k) step();
        digits();
      }
    }
  }
  const std::string_view body = text_.substr(first, at_ - first);
  Kind kind = is_real ? Kind::real : Kind::integer;
  if (!is_hexadecimal && (peek() == 'f' || peek() == 'F')) {
    kind = Kind::real;
    step();
  } else if (!is_real && (peek() == 'u' || peek() == 'U')) {
    kind = Kind::natural;
    step();
  }
  while (continues_shader_name(peek())) step();
  const std::string_view whole = text_.substr(first, at_ - first);
  const bool has_rest =
      whole.size() > body.size() + (kind == Kind::natural || whole.ends_with('f') || whole.ends_with('F'));
  double number = 0;
  bool is_known = false;
  if (kind == Kind::real) {
    is_known = parse_number(body, number);
  } else {
    // A leading 0 makes a number octal.
    const int base = is_hexadecimal ? 16 : body.size() > 1 && body.front() == '0' ? 8 : 10;
    const std::string_view digits = is_hexadecimal ? body.substr(2) : body;
    std::uint32_t bits = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), bits, base);
    is_known = error == std::errc() && end == digits.data() + digits.size() && !digits.empty();
    number = kind == Kind::natural ? static_cast<double>(bits) : static_cast<double>(static_cast<std::int32_t>(bits));
  }
  if (!is_known || has_rest) {
    refuse(at, fmt::format("'{}' is no number of GLSL; expected one such as 2, 0.5, 1e-3 or 3u", excerpt(whole)));
  }
  return {kind, whole, number, at};
}

ShaderToken ShaderTokens::read_token() {
  for (;;) {
    skip_blanks(in_directive_);
    if (in_directive_ || at_ == text_.size() || peek() != '#' || !starts_line_) break;
    read_directive();
  }
  const ShaderPlace at = place();
  if (in_directive_ ? is_end_of_line() : at_ == text_.size()) {
    if (!in_directive_ && !open_groups_.empty()) {
      refuse(open_groups_.back(), "nothing closes this condition; expected #endif");
    }
    return {.at = at};
  }
  starts_line_ = false;
  const char c = peek();
  if (starts_shader_name(c)) {
    const std::size_t first = at_;
    while (continues_shader_name(peek())) step();
    const std::string_view name = text_.substr(first, at_ - first);
    if (name.size() > kLongestName) {
      refuse(at, fmt::format("a name of {} characters; expected at most {}", name.size(), kLongestName));
    }
    return {Kind::name, name, 0, at};
  }
  if (is_shader_digit(c) || (c == '.' && is_shader_digit(peek(1)))) return read_number();
  const std::string_view rest = text_.substr(at_);
  const auto* sign = std::ranges::find_if(kSigns, [&](std::string_view one) { return rest.starts_with(one); });
  if (sign == kSigns.end()) {
    if (std::ranges::any_of(kBitSigns, [&](std::string_view one) { return rest.starts_with(one); })) {
      refuse(at, fmt::format("'{}' works on bits, which is not read; expected arithmetic", c));
    }
    const auto byte = static_cast<unsigned char>(c);
    refuse(at, byte < 0x80U && byte > 0x20U && byte != 0x7fU
                   ? fmt::format("unexpected character '{}'; expected a name, a number or an operator of GLSL", c)
                   : fmt::format("unexpected byte \\x{:02x}; expected a name, a number or an operator of GLSL", byte));
  }
  for (std::size_t k = 0; k < sign->size(); ++k) step();
  return {Kind::sign, rest.substr(0, sign->size()), 0, at};
}

ShaderToken ShaderTokens::raw() {
  while (!replacements_.empty()) {
    Replacement& top = replacements_.back();
    if (top.at < top.tokens.size()) return top.tokens[top.at++];
    replacements_.pop_back();
  }
  return read_token();
}

bool ShaderTokens::is_active(std::string_view macro) const {
  return std::ranges::find(replacements_, macro, &Replacement::macro) != replacements_.end();
}

void ShaderTokens::replace(const ShaderToken& use, const Macro& macro, std::size_t depth) {
  const auto count = [&](std::size_t tokens) {
    replaced_ += tokens;
    if (replaced_ > kMostReplaced) {
      refuse(use.at, fmt::format("macros stand for more than {} tokens; expected fewer", kMostReplaced));
    }
  };
  std::vector<std::vector<ShaderToken>> arguments;
  if (macro.has_parameters) {
    (void)raw();  // the parenthesis
    arguments.emplace_back();
    for (std::size_t nested = 0;;) {
      const ShaderToken token = expanded(depth + 1);
      if (token.kind == Kind::end) {
        refuse(use.at, fmt::format("nothing closes the arguments of '{}'; expected ')'", use.text));
      }
      if (token.is(")") && nested == 0) break;
      if (token.is("(")) ++nested;
      if (token.is(")")) --nested;
      if (token.is(",") && nested == 0) {
        arguments.emplace_back();
        continue;
      }
      count(1);
      arguments.back().push_back(token);
    }
    if (macro.parameters.empty() && arguments.front().empty()) arguments.clear();
    if (arguments.size() != macro.parameters.size()) {
      refuse(use.at,
             fmt::format("'{}' has {} arguments; expected {}", use.text, arguments.size(), macro.parameters.size()));
    }
  }
  Replacement made{use.text, {}, 0};
  for (const ShaderToken& token : macro.body) {
    const auto parameter =
        token.kind == Kind::name ? std::ranges::find(macro.parameters, token.text) : macro.parameters.end();
    if (parameter == macro.parameters.end()) {
      count(1);
      made.tokens.push_back(token);
      made.tokens.back().at = use.at;
      continue;
    }
    const auto& argument = arguments[static_cast<std::size_t>(parameter - macro.parameters.begin())];
    count(argument.size());
    made.tokens.insert(made.tokens.end(), argument.begin(), argument.end());
  }
  replacements_.push_back(std::move(made));
}

ShaderToken ShaderTokens::expanded(std::size_t depth) {
  if (depth > kMostNested) refuse(place(), fmt::format("macros nest more than {} deep; expected less", kMostNested));
  for (;;) {
    ShaderToken token = raw();
    if (token.kind != Kind::name) return token;
    const auto macro = macros_.find(token.text);
    if (macro == macros_.end() || is_active(token.text)) return token;
    if (replacements_.size() > kMostNested) {
      refuse(token.at, fmt::format("macros nest more than {} deep; expected less", kMostNested));
    }
    if (macro->second.has_parameters) {
      // Without arguments it is a name like any other.
      const ShaderToken following = raw();
      if (!following.is("(")) {
        if (following.kind != Kind::end) replacements_.push_back({{}, {following}, 0});
        return token;
      }
      replacements_.push_back({{}, {following}, 0});
    }
    replace(token, macro->second, depth);
  }
}

ShaderToken ShaderTokens::next() {
  return expanded(0);
}

std::string_view ShaderTokens::read_word() {
  skip_blanks(true);
  const std::size_t first = at_;
  while (continues_shader_name(peek())) step();
  return text_.substr(first, at_ - first);
}

void ShaderTokens::require_end_of_directive(std::string_view directive) {
  skip_blanks(true);
  if (!is_end_of_line())
    refuse(place(), fmt::format("unexpected text behind #{}; expected the end of the line", directive));
}

void ShaderTokens::read_definition() {
  const ShaderPlace at = [&] {
    skip_blanks(true);
    return place();
  }();
  const std::string_view name = read_word();
  if (name.empty() || !starts_shader_name(name.front()) || name.size() > kLongestName) {
    refuse(at, "#define has no name; expected one of letters, digits and '_'");
  }
  if (macros_.size() == kMostMacros) refuse(at, fmt::format("more than {} macros; expected fewer", kMostMacros));
  Macro macro;
  macro.has_parameters = peek() == '(';
  if (macro.has_parameters) {
    step();
    skip_blanks(true);
    while (peek() != ')') {
      const ShaderPlace here = place();
      const std::string_view parameter = read_word();
      if (parameter.empty() || !starts_shader_name(parameter.front())) {
        refuse(here,
               fmt::format("a parameter of '{}' has no name; expected {}(a, b) and what it stands for", name, name));
      }
      macro.parameters.push_back(parameter);
      skip_blanks(true);
      if (peek() == ',') {
        step();
        skip_blanks(true);
      } else if (peek() != ')') {
        refuse(place(), fmt::format("the parameters of '{}' do not end; expected ',' or ')'", name));
      }
    }
    step();
  }
  in_directive_ = true;
  for (ShaderToken token = read_token(); token.kind != Kind::end; token = read_token()) macro.body.push_back(token);
  in_directive_ = false;
  macros_.insert_or_assign(name, std::move(macro));
}

bool ShaderTokens::condition_holds(const ShaderPlace& at) {
  in_directive_ = true;
  const ShaderToken token = read_token();
  const ShaderToken behind = read_token();
  in_directive_ = false;
  const ShaderToken* value = &token;
  if (token.kind == Kind::name) {
    const auto macro = macros_.find(token.text);
    if (macro != macros_.end() && macro->second.body.size() == 1) value = &macro->second.body.front();
    if (macro == macros_.end() && behind.kind == Kind::end) return false;
  }
  const bool is_number = value->kind == Kind::integer || value->kind == Kind::natural;
  if (!is_number || behind.kind != Kind::end) {
    refuse(at, "#if has an expression, which is not read; expected a number or a name (or #ifdef, #ifndef)");
  }
  return value->number != 0;
}

void ShaderTokens::skip_group(const ShaderPlace& opened, bool may_have_else) {
  std::size_t nested = 0;
  while (at_ < text_.size()) {
    while (!is_end_of_line()) step();
    if (at_ == text_.size()) break;
    step();
    skip_blanks(true);
    if (peek() != '#') continue;
    step();
    const std::string_view directive = read_word();
    if (directive == "if" || directive == "ifdef" || directive == "ifndef") ++nested;
    if (directive == "elif" && nested == 0) refuse(place(), "#elif is not read; expected #else or #endif");
    if (directive == "else" && nested == 0 && may_have_else) {
      open_groups_.push_back(opened);
      return require_end_of_directive(directive);
    }
    if (directive != "endif") continue;
    if (nested == 0) return require_end_of_directive(directive);
    --nested;
  }
  refuse(opened, "nothing closes this condition; expected #endif");
}

void ShaderTokens::read_condition(std::string_view directive, const ShaderPlace& at) {
  bool holds = false;
  if (directive == "if") {
    holds = condition_holds(at);
  } else {
    const std::string_view name = read_word();
    if (name.empty()) refuse(at, fmt::format("#{} has no name; expected the name of a macro", directive));
    require_end_of_directive(directive);
    holds = macros_.contains(name) == (directive == "ifdef");
  }
  if (!holds) return skip_group(at, true);
  if (open_groups_.size() == kMostOpenGroups) {
    refuse(at, fmt::format("conditions nest more than {} deep; expected less", kMostOpenGroups));
  }
  open_groups_.push_back(at);
}

void ShaderTokens::read_directive() {
  const ShaderPlace at = place();
  step();
  const std::string_view directive = read_word();
  constexpr std::array<std::string_view, 3> kIgnored{"version", "extension", "pragma"};
  if (directive == "define") {
    read_definition();
  } else if (directive == "undef") {
    macros_.erase(read_word());
    require_end_of_directive(directive);
  } else if (directive == "if" || directive == "ifdef" || directive == "ifndef") {
    read_condition(directive, at);
  } else if (directive == "else" || directive == "endif") {
    if (open_groups_.empty())
      refuse(at, fmt::format("#{} without a condition before it; expected #ifdef first", directive));
    const ShaderPlace opened = open_groups_.back();
    open_groups_.pop_back();
    require_end_of_directive(directive);
    if (directive == "else") skip_group(opened, false);
  } else if (directive.empty() || std::ranges::find(kIgnored, directive) != kIgnored.end()) {
    while (!is_end_of_line()) step();
  } else {
    refuse(at, fmt::format("#{} is not read; expected #define, #undef, #if, #ifdef, #ifndef, #else, #endif or #version",
                           excerpt(directive)));
  }
}

}  // namespace lobe
