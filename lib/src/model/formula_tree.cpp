#include "model/formula_tree.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <system_error>
#include <utility>

#include "core/text.hpp"
#include "lobe/core/error.hpp"

namespace lobe {
namespace {

using Kind = FormulaPart::Kind;

constexpr std::array kQuantities{
    FormulaQuantity{"cos_i"},       FormulaQuantity{"cos_o"},        FormulaQuantity{"cos_h"},
    FormulaQuantity{"cos_d"},       FormulaQuantity{"cos_rv"},       FormulaQuantity{"cos_lv"},
    FormulaQuantity{"theta_i"},     FormulaQuantity{"theta_o"},      FormulaQuantity{"tan2_h"},
    FormulaQuantity{"log_cos_h"},   FormulaQuantity{"log_rv"},       FormulaQuantity{"distance_p"},
    FormulaQuantity{"in_x", true},  FormulaQuantity{"in_y", true},   FormulaQuantity{"out_x", true},
    FormulaQuantity{"out_y", true}, FormulaQuantity{"half_x", true}, FormulaQuantity{"half_y", true},
    FormulaQuantity{"pi"}};

constexpr std::array kFunctions{FormulaFunction{"exp", 1},        FormulaFunction{"exp2", 1},
                                FormulaFunction{"exp10", 1},      FormulaFunction{"expm1", 1},
                                FormulaFunction{"log", 1},        FormulaFunction{"log2", 1},
                                FormulaFunction{"log10", 1},      FormulaFunction{"log1p", 1},
                                FormulaFunction{"pow", 2},        FormulaFunction{"powr", 2},
                                FormulaFunction{"sqrt", 1},       FormulaFunction{"rsqrt", 1},
                                FormulaFunction{"cbrt", 1},       FormulaFunction{"hypot", 2},
                                FormulaFunction{"sin", 1},        FormulaFunction{"cos", 1},
                                FormulaFunction{"tan", 1},        FormulaFunction{"asin", 1},
                                FormulaFunction{"acos", 1},       FormulaFunction{"atan", 1},
                                FormulaFunction{"atan2", 2},      FormulaFunction{"sinh", 1},
                                FormulaFunction{"cosh", 1},       FormulaFunction{"tanh", 1},
                                FormulaFunction{"asinh", 1},      FormulaFunction{"acosh", 1},
                                FormulaFunction{"atanh", 1},      FormulaFunction{"erf", 1},
                                FormulaFunction{"erfc", 1},       FormulaFunction{"fabs", 1},
                                FormulaFunction{"sign", 1},       FormulaFunction{"floor", 1},
                                FormulaFunction{"ceil", 1},       FormulaFunction{"round", 1},
                                FormulaFunction{"trunc", 1},      FormulaFunction{"fmod", 2},
                                FormulaFunction{"fmin", 2},       FormulaFunction{"fmax", 2},
                                FormulaFunction{"min", 2},        FormulaFunction{"max", 2},
                                FormulaFunction{"fdim", 2},       FormulaFunction{"clamp", 3},
                                FormulaFunction{"mix", 3},        FormulaFunction{"step", 2},
                                FormulaFunction{"smoothstep", 3}, FormulaFunction{"fma", 3},
                                FormulaFunction{"mad", 3},        FormulaFunction{"radians", 1},
                                FormulaFunction{"degrees", 1},    FormulaFunction{"fresnel", 3, "formula_fresnel"}};

constexpr std::string_view kWhere = "where";
constexpr std::size_t kShown = 40;  // characters of a name in a message

/// Operators of two operands, by how tightly they bind; within one level they are taken from the left.
struct Operator {
  std::string_view text;
  Kind kind;
  unsigned level;
};
constexpr std::array kOperators{Operator{"||", Kind::either, 1},
                                Operator{"&&", Kind::both, 2},
                                Operator{"==", Kind::equal, 3},
                                Operator{"!=", Kind::unequal, 3},
                                Operator{"<=", Kind::less_or_equal, 4},
                                Operator{">=", Kind::greater_or_equal, 4},
                                Operator{"<", Kind::less, 4},
                                Operator{">", Kind::greater, 4},
                                Operator{"+", Kind::sum, 5},
                                Operator{"-", Kind::difference, 5},
                                Operator{"*", Kind::product, 6},
                                Operator{"/", Kind::quotient, 6}};
constexpr unsigned kLowest = 1;
constexpr unsigned kSign = 7;  // the level of signs and '!'
constexpr unsigned kAtom = 8;

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

bool starts_name(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

bool continues_name(char c) {
  return starts_name(c) || is_digit(c);
}

bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

bool takes_conditions(Kind kind) {
  return kind == Kind::both || kind == Kind::either || kind == Kind::opposite;
}

/// Guess at the meaning of a character, or a pair of characters, outside the language.
std::string_view remark_on(std::string_view rest) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 12> kRemarks{
      {{"**", "powers are pow(a, b)"},
       {"^", "powers are pow(a, b)"},
       {"%", "remainders are fmod(a, b)"},
       {"?", "choices are where(condition, a, b)"},
       {":", "choices are where(condition, a, b)"},
       {"//", "a formula has no comments"},
       {"/*", "a formula has no comments"},
       {"#", "a formula has no comments and no directives"},
       {"&", "conditions are joined by '&&'"},
       {"|", "conditions are joined by '||'"},
       {"=", "equality is '=='"},
       {",", "only arguments of functions are separated by commas"}}};
  for (const auto& [start, remark] : kRemarks) {
    if (rest.starts_with(start)) return remark;
  }
  return {};
}

/// The character with which a text begins, for messages.
std::string shown_character(std::string_view text) {
  const auto byte = static_cast<unsigned char>(text.front());
  if (byte < 0x80U) return printable(text.substr(0, 1));
  const std::size_t length = byte < 0xc2U || byte > 0xf4U ? 1 : byte < 0xe0U ? 2 : byte < 0xf0U ? 3 : 4;
  const auto character = text.substr(0, length);
  const bool is_whole =
      length > 1 && character.size() == length &&
      std::ranges::all_of(character.substr(1), [](char c) { return (static_cast<unsigned char>(c) & 0xc0U) == 0x80U; });
  if (is_whole) return printable(character);
  constexpr std::string_view kDigits = "0123456789abcdef";
  return std::string("\\x") + kDigits[byte >> 4U] + kDigits[byte & 15U];
}

std::string shown_name(std::string_view name) {
  std::string shown(name.substr(0, kShown));
  if (name.size() > kShown) shown.append(3, '.');
  return shown;
}

class Reader {
 public:
  explicit Reader(const Formula& formula) : formula_(formula), text_(formula.text) {}

  FormulaTree read() {
    if (text_.size() > kFormulaLength) {
      fail(0, "formula has " + std::to_string(text_.size()) + " characters; expected at most " +
                  std::to_string(kFormulaLength));
    }
    skip_blanks();
    if (at_ == text_.size()) fail(0, "formula is empty; expected an expression such as \"rho / pi\"");
    const std::size_t whole = read_expression(kLowest);
    if (at_ < text_.size()) fail_here("an operator or the end of the formula");
    require_number(whole, 0);
    return std::move(tree_);
  }

 private:
  [[noreturn]] void fail(std::size_t place, const std::string& message) const {
    const auto before = text_.substr(0, place);
    const auto lines = static_cast<std::size_t>(std::ranges::count(before, '\n'));
    const auto last = before.rfind('\n');
    // Places count characters, as those of TOML do.
    const auto in_line = before.substr(last == std::string_view::npos ? 0 : last + 1);
    const auto characters = static_cast<std::size_t>(
        std::ranges::count_if(in_line, [](char c) { return (static_cast<unsigned char>(c) & 0xc0U) != 0x80U; }));
    const std::size_t column = characters + (lines == 0 ? std::max(formula_.column, 1U) : 1U);
    throw ArgumentError(printable(formula_.file.empty() ? "formula" : formula_.file) + ":" +
                            std::to_string(formula_.line + lines) + ":" + std::to_string(column) + ": " + message,
                        {.topic = formula_.file.empty() ? Topic::materials : Topic::studies});
  }

  /// \param expected what may stand here
  [[noreturn]] void fail_here(std::string_view expected) const {
    if (at_ >= text_.size()) fail(at_, "the formula ends here; expected " + std::string(expected));
    const auto rest = text_.substr(at_);
    std::string what = "unexpected ";
    if (starts_name(rest.front())) {
      what += "name '" + shown_name(name_at(at_)) + "'";
    } else if (is_digit(rest.front())) {
      what += "number";
    } else {
      what += "'" + shown_character(rest) + "'";
    }
    const auto remark = remark_on(rest);
    fail(at_, what + "; expected " + std::string(expected) + (remark.empty() ? "" : " (" + std::string(remark) + ")"));
  }

  void skip_blanks() {
    while (at_ < text_.size() && is_blank(text_[at_])) ++at_;
  }

  bool take(char c) {
    if (at_ >= text_.size() || text_[at_] != c) return false;
    ++at_;
    skip_blanks();
    return true;
  }

  [[nodiscard]] std::string_view name_at(std::size_t start) const {
    std::size_t end = start;
    while (end < text_.size() && continues_name(text_[end])) ++end;
    return text_.substr(start, end - start);
  }

  [[nodiscard]] std::optional<Operator> operator_here() const {
    const auto rest = text_.substr(at_);
    if (rest.starts_with("//") || rest.starts_with("/*") || rest.starts_with("**")) return std::nullopt;
    const auto* found =
        std::ranges::find_if(kOperators, [&](const Operator& one) { return rest.starts_with(one.text); });
    return found == kOperators.end() ? std::nullopt : std::optional(*found);
  }

  /// \param place where it begins in the text
  std::size_t add(FormulaPart part, std::size_t place) {
    if (tree_.parts.size() >= kFormulaParts) {
      fail(place,
           "formula has more than " + std::to_string(kFormulaParts) + " numbers, names and operations; expected fewer");
    }
    tree_.parts.push_back(part);
    return tree_.parts.size() - 1;
  }

  [[nodiscard]] bool is_condition_at(std::size_t part) const { return is_condition(tree_.parts[part].kind); }

  void require_number(std::size_t part, std::size_t place) const {
    if (is_condition_at(part)) {
      fail(place,
           "a condition stands where a number is expected; conditions are for where(condition, a, b), which is a "
           "number");
    }
  }

  void require_condition(std::size_t part, std::size_t place) const {
    if (!is_condition_at(part)) {
      fail(place, "a number stands where a condition is expected; expected one such as cos_i > 0.5");
    }
  }

  /// Parentheses, calls and signs, within which the reader calls itself.
  class Level {
   public:
    Level(Reader& reader, std::size_t place) : depth_(reader.depth_) {
      if (++depth_ > kFormulaDepth) {
        reader.fail(place, "parentheses, calls and signs stand more than " + std::to_string(kFormulaDepth) +
                               " deep in each other; expected fewer");
      }
    }
    ~Level() { --depth_; }
    Level(const Level&) = delete;
    Level& operator=(const Level&) = delete;

   private:
    std::size_t& depth_;
  };

  /// An expression of operators that bind at least so tightly.
  std::size_t read_expression(unsigned level) {
    std::size_t place = at_;
    std::size_t left = read_signed();
    // A loop by levels instead of a call per level: what has been read is the left operand of what follows.
    for (;;) {
      const auto found = operator_here();
      if (!found || found->level < level) return left;
      const std::size_t operator_place = at_;
      at_ += found->text.size();
      skip_blanks();
      const std::size_t right_place = at_;
      const std::size_t right = read_expression(found->level + 1);
      if (takes_conditions(found->kind)) {
        require_condition(left, place);
        require_condition(right, right_place);
      } else {
        require_number(left, place);
        require_number(right, right_place);
      }
      left = add({found->kind, 0, 0, {left, right}}, operator_place);
    }
  }

  std::size_t read_signed() {
    const std::size_t place = at_;
    if (at_ < text_.size() && (text_[at_] == '-' || text_[at_] == '+')) {
      const bool is_minus = text_[at_] == '-';
      const Level level(*this, place);
      ++at_;
      skip_blanks();
      const std::size_t operand_place = at_;
      const std::size_t operand = read_signed();
      require_number(operand, operand_place);
      return is_minus ? add({Kind::negation, 0, 0, {operand}}, place) : operand;
    }
    if (at_ < text_.size() && text_[at_] == '!' && !text_.substr(at_).starts_with("!=")) {
      const Level level(*this, place);
      ++at_;
      skip_blanks();
      const std::size_t operand_place = at_;
      const std::size_t operand = read_signed();
      require_condition(operand, operand_place);
      return add({Kind::opposite, 0, 0, {operand}}, place);
    }
    return read_atom();
  }

  std::size_t read_atom() {
    constexpr std::string_view kExpected = "a number, a name, a sign or '('";
    if (at_ >= text_.size()) fail_here(kExpected);
    const char first = text_[at_];
    if (is_digit(first) || first == '.') return read_number();
    if (starts_name(first)) return read_name();
    const Level level(*this, at_);
    if (!take('(')) fail_here(kExpected);
    const std::size_t inner = read_expression(kLowest);
    if (!take(')')) fail_here("an operator or ')'");
    return inner;
  }

  std::size_t read_number() {
    const std::size_t start = at_;
    std::size_t end = at_;
    const auto digits = [&] {
      const std::size_t before = end;
      while (end < text_.size() && is_digit(text_[end])) ++end;
      return end > before;
    };
    bool has_digits = digits();
    if (end < text_.size() && text_[end] == '.') {
      ++end;
      has_digits = digits() || has_digits;
    }
    if (!has_digits) fail_here("a number, a name, a sign or '('");
    if (end < text_.size() && (text_[end] == 'e' || text_[end] == 'E')) {
      std::size_t exponent = end + 1;
      if (exponent < text_.size() && (text_[exponent] == '+' || text_[exponent] == '-')) ++exponent;
      if (exponent < text_.size() && is_digit(text_[exponent])) {
        end = exponent;
        digits();
      }
    }
    const auto text = text_.substr(start, end - start);
    if (end < text_.size() && (continues_name(text_[end]) || text_[end] == '.')) refuse_suffix(text, end);
    double value = 0;
    const auto [last, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || last != text.data() + text.size() || !std::isfinite(value)) {
      fail(start, "number " + shown_name(text) + " is out of range; expected 0, or a size from about 1e-308 to 1e308");
    }
    at_ = end;
    skip_blanks();
    return add({Kind::number, value, 0, {}}, start);
  }

  [[noreturn]] void refuse_suffix(std::string_view number, std::size_t end) const {
    const std::string shown = shown_name(number);
    const auto suffix = name_at(end);
    if (suffix == "f" || suffix == "F") {
      fail(end, "number " + shown + " has the suffix '" + std::string(suffix) +
                    "'; expected none, formulas are computed in double precision");
    }
    if (number == "0" && (suffix.starts_with('x') || suffix.starts_with('X'))) {
      fail(end, "hexadecimal numbers are not understood; expected a decimal number such as 0.25");
    }
    fail(end, "number " + shown + " is followed by '" + (suffix.empty() ? "." : shown_name(suffix)) +
                  "'; expected a number such as 0.25 or 1e-3, and an operator behind it");
  }

  std::size_t read_name() {
    const std::size_t start = at_;
    const auto name = name_at(start);
    if (name.size() > kFormulaNameLength) {
      fail(start, "name '" + shown_name(name) + "' is too long; expected at most " +
                      std::to_string(kFormulaNameLength) + " characters");
    }
    at_ += name.size();
    skip_blanks();
    if (at_ < text_.size() && text_[at_] == '(') return read_call(name, start);
    const auto parameter = std::ranges::find(formula_.parameters, name);
    if (parameter != formula_.parameters.end()) {
      return add({Kind::parameter, 0, static_cast<std::size_t>(parameter - formula_.parameters.begin()), {}}, start);
    }
    const auto* quantity = std::ranges::find(kQuantities, name, &FormulaQuantity::name);
    if (quantity != kQuantities.end()) {
      return add({Kind::quantity, 0, static_cast<std::size_t>(quantity - kQuantities.begin()), {}}, start);
    }
    if (name == kWhere || std::ranges::find(kFunctions, name, &FormulaFunction::name) != kFunctions.end()) {
      fail(start, "function '" + std::string(name) + "' without arguments; expected '(' after it");
    }
    std::vector<std::string_view> known(formula_.parameters.begin(), formula_.parameters.end());
    for (const auto& one : kQuantities) known.push_back(one.name);
    fail(start, "unknown name '" + std::string(name) + "'" + did_you_mean(name, known));
  }

  /// \param start where the function's name begins
  std::size_t read_call(std::string_view name, std::size_t start) {
    const auto* function = std::ranges::find(kFunctions, name, &FormulaFunction::name);
    const bool is_choice = name == kWhere;
    if (!is_choice && function == kFunctions.end()) refuse_function(name, start);
    const std::size_t expected = is_choice ? 3 : function->arguments;
    const auto wrong_number = [&](std::size_t place, std::string_view given) {
      fail(place, "function '" + std::string(name) + "' is given " + std::string(given) + "; expected " +
                      (is_choice ? std::string("where(condition, a, b)") : arguments_text(expected)));
    };
    const Level level(*this, at_);
    (void)take('(');
    FormulaPart call{is_choice ? Kind::choice : Kind::call, 0, 0, {}};
    if (!is_choice) call.index = static_cast<std::size_t>(function - kFunctions.begin());
    if (at_ < text_.size() && text_[at_] == ')') wrong_number(at_, "no arguments");
    for (std::size_t k = 0; k < expected; ++k) {
      if (k > 0 && !take(',')) {
        if (at_ < text_.size() && text_[at_] == ')') {
          wrong_number(start, k == 1 ? "1 argument" : std::to_string(k) + " arguments");
        }
        fail_here("an operator or ','");
      }
      const std::size_t place = at_;
      call.operands[k] = read_expression(kLowest);
      if (is_choice && k == 0) {
        require_condition(call.operands[k], place);
      } else {
        require_number(call.operands[k], place);
      }
    }
    if (at_ < text_.size() && text_[at_] == ',') wrong_number(at_, "more arguments than that");
    if (!take(')')) fail_here("an operator or ')'");
    return add(call, start);
  }

  static std::string arguments_text(std::size_t count) {
    return count == 1 ? "one argument" : std::to_string(count) + " arguments";
  }

  [[noreturn]] void refuse_function(std::string_view name, std::size_t start) const {
    const auto is_name = [&](const auto& list) { return std::ranges::find(list, name) != list.end(); };
    if (is_name(formula_.parameters)) {
      fail(start, "parameter '" + std::string(name) + "' is no function; expected an operator such as '*' after it");
    }
    if (std::ranges::find(kQuantities, name, &FormulaQuantity::name) != kQuantities.end()) {
      fail(start, "'" + std::string(name) + "' is no function; expected an operator such as '*' after it");
    }
    std::vector<std::string_view> known{kWhere};
    for (const auto& one : kFunctions) known.push_back(one.name);
    // There are too many for a message.
    const std::string near = name == "ln" ? "log" : nearest_word(name, known);
    fail(start,
         "unknown function '" + std::string(name) + "'" +
             (near.empty() ? "; docs/formulas.md lists those that there are" : "; did you mean '" + near + "'?"));
  }

  const Formula& formula_;
  std::string_view text_;
  std::size_t at_ = 0;
  std::size_t depth_ = 0;
  FormulaTree tree_;
};

/// A part as text, and how tightly it binds.
struct Written {
  std::string text;
  unsigned level = kAtom;
};

std::string in_parentheses(const Written& operand, bool needs_them) {
  return needs_them ? "(" + operand.text + ")" : operand.text;
}

Written written(const FormulaPart& part, const std::vector<Written>& before, std::span<const std::string> parameters) {
  const auto operand = [&](std::size_t k) -> const Written& { return before[part.operands[k]]; };
  switch (part.kind) {
    case Kind::number:
      return {shortest(part.number)};
    case Kind::quantity:
      return {std::string(kQuantities.at(part.index).name)};
    case Kind::parameter:
      return {parameters[part.index]};
    case Kind::negation:
      return {"-" + in_parentheses(operand(0), operand(0).level < kSign), kSign};
    case Kind::opposite:
      return {"!" + in_parentheses(operand(0), operand(0).level < kSign), kSign};
    case Kind::call:
    case Kind::choice: {
      std::string text(part.kind == Kind::choice ? kWhere : kFunctions.at(part.index).name);
      for (std::size_t k = 0; k < operand_count(part); ++k) {
        text += (k == 0 ? "(" : ", ") + operand(k).text;
      }
      return {text + ")"};
    }
    default: {
      const auto* found = std::ranges::find(kOperators, part.kind, &Operator::kind);
      return {in_parentheses(operand(0), operand(0).level < found->level) + " " + std::string(found->text) + " " +
                  in_parentheses(operand(1), operand(1).level <= found->level),
              found->level};
    }
  }
}

}  // namespace

std::span<const FormulaQuantity> formula_quantities() {
  return kQuantities;
}

std::span<const FormulaFunction> formula_functions() {
  return kFunctions;
}

bool is_condition(FormulaPart::Kind kind) {
  return kind >= Kind::less;
}

std::size_t operand_count(const FormulaPart& part) {
  switch (part.kind) {
    case Kind::number:
    case Kind::quantity:
    case Kind::parameter:
      return 0;
    case Kind::negation:
    case Kind::opposite:
      return 1;
    case Kind::choice:
      return 3;
    case Kind::call:
      return kFunctions.at(part.index).arguments;
    default:
      return 2;
  }
}

FormulaTree read_formula_tree(const Formula& formula) {
  return Reader(formula).read();
}

std::string canonical_text(const FormulaTree& tree, std::span<const std::string> parameters) {
  std::vector<Written> texts;
  texts.reserve(tree.parts.size());
  for (const FormulaPart& part : tree.parts) {
    texts.push_back(written(part, texts, parameters));
    // Every part is an operand once: what has been written into another one is not needed any more.
    for (std::size_t k = 0; k < operand_count(part); ++k) texts[part.operands[k]].text.clear();
  }
  return texts.empty() ? std::string() : texts.back().text;
}

}  // namespace lobe
