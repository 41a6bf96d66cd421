// Expressions of shaders: what they are worth, and the code that computes it.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/text.hpp"
#include "formats/shader_compiler.hpp"

namespace lobe {
namespace {

using Kind = ShaderToken::Kind;
using Op = ShaderOp;
using Base = ShaderBase;
using Shape = ShaderShape;
using Values = std::vector<ShaderValue>;

constexpr std::uint32_t kMostComponents = 4;
constexpr std::size_t kMostArguments = 1024;

/// Operators of two operands, by how tightly they bind.
struct ShaderOperator {
  std::string_view sign;
  unsigned level;
};
constexpr std::array kShaderOperators{ShaderOperator{"||", 1}, ShaderOperator{"^^", 2}, ShaderOperator{"&&", 3},
                                      ShaderOperator{"==", 4}, ShaderOperator{"!=", 4}, ShaderOperator{"<", 5},
                                      ShaderOperator{">", 5},  ShaderOperator{"<=", 5}, ShaderOperator{">=", 5},
                                      ShaderOperator{"+", 6},  ShaderOperator{"-", 6},  ShaderOperator{"*", 7},
                                      ShaderOperator{"/", 7},  ShaderOperator{"%", 7}};
constexpr unsigned kLowestLevel = 1;
constexpr unsigned kComparisonLevel = 4;

Base common_base(Base a, Base b) {
  if (a == b) return a;
  return a == Base::real || b == Base::real ? Base::real : Base::natural;
}

Op comparison_op(std::string_view sign) {
  return sign == "<" ? Op::less : sign == ">" ? Op::greater : sign == "<=" ? Op::less_or_equal : Op::greater_or_equal;
}

Op arithmetic_op(std::string_view sign, bool is_integer) {
  switch (sign.front()) {
    case '+':
      return Op::add;
    case '-':
      return Op::subtract;
    case '*':
      return Op::multiply;
    case '%':
      return Op::modulo_integer;
    default:
      return is_integer ? Op::divide_integer : Op::divide;
  }
}

std::uint32_t packed_sizes(std::uint32_t rows, std::uint32_t inner, std::uint32_t columns) {
  return rows | (inner << 4U) | (columns << 8U);
}

std::uint32_t packed_picks(const std::vector<std::uint8_t>& picked) {
  std::uint32_t packed = 0;
  for (std::size_t k = 0; k < picked.size(); ++k) packed |= std::uint32_t{picked[k]} << (2 * k);
  return packed;
}

bool keeps_integers(Op op) {
  return op == Op::absolute || op == Op::sign || op == Op::minimum || op == Op::maximum || op == Op::clamp;
}

}  // namespace

// --- Values.

ShaderValue ShaderCompiler::fresh(const ShaderType& type, const ShaderPlace& at) {
  return {.type = type, .slot = code_.take_slots(slots_of(type), at), .at = at};
}

ShaderValue ShaderCompiler::constant(const ShaderType& type, std::span<const double> values, const ShaderPlace& at) {
  return {.type = type, .slot = code_.constants(values, at), .at = at};
}

bool ShaderCompiler::is_known(const ShaderValue& value) const {
  return ShaderCode::is_constant(value.slot) && !value.offset && value.picked.empty();
}

double ShaderCompiler::known(const ShaderValue& value, std::uint32_t component) const {
  return code_.constant(value.slot + component);
}

ShaderValue ShaderCompiler::plain(const ShaderValue& value) {
  if (value.type.base == Base::nothing) refuse(value.at, "this has no value; expected one");
  ShaderValue result = value;
  result.is_place = result.is_variable = false;
  if (value.copied) return {.type = value.type, .slot = *value.copied, .at = value.at};
  if (value.offset) {
    const std::uint32_t width =
        value.picked.empty() ? slots_of(value.type) : *std::ranges::max_element(value.picked) + 1U;
    result.slot = code_.take_slots(width, value.at);
    result.offset.reset();
    code_.emit({.op = Op::load, .n = width, .dst = result.slot, .a = value.slot, .b = *value.offset, .at = value.at});
  } else if (value.picked.empty() && value.is_variable && has_side_effects_) {
    result = fresh(value.type, value.at);
    code_.emit({.op = Op::copy, .n = slots_of(value.type), .dst = result.slot, .a = value.slot, .at = value.at});
  }
  if (value.picked.empty()) return result;
  const std::uint32_t from = result.slot;
  result = fresh(value.type, value.at);
  code_.emit({.op = Op::pick,
              .n = value.type.size(),
              .dst = result.slot,
              .a = from,
              .c = packed_picks(value.picked),
              .at = value.at});
  return result;
}

ShaderValue ShaderCompiler::apply(ShaderOp op, const ShaderType& type, std::span<const ShaderValue> operands,
                                  const ShaderPlace& at) {
  const std::uint32_t n = type.size();
  const auto stride = [&](std::size_t k) -> std::uint8_t { return operands[k].type.size() == 1 ? 0 : 1; };
  const bool divides = op == Op::divide_integer || op == Op::modulo_integer;
  const auto all_known = [&] {
    return operands.size() <= 2 && std::ranges::all_of(operands, [&](const ShaderValue& one) { return is_known(one); });
  };
  if (!divides && all_known()) {
    std::vector<double> values(n);
    for (std::uint32_t k = 0; k < n; ++k) {
      const double b = operands.size() > 1 ? known(operands[1], k * stride(1)) : 0;
      values[k] = shader_value(op, known(operands[0], k * stride(0)), b);
    }
    return constant(type, values, at);
  }
  const ShaderValue result = fresh(type, at);
  ShaderInstruction one{.op = op, .n = n, .dst = result.slot, .at = at};
  for (std::size_t k = 0; k < operands.size(); ++k) {
    one.stride.at(k) = stride(k);
    (k == 0 ? one.a : k == 1 ? one.b : one.c) = operands[k].slot;
  }
  code_.emit(one);
  return result;
}

ShaderValue ShaderCompiler::converted(const ShaderValue& value, ShaderBase base, const ShaderPlace& at) {
  ShaderValue result = plain(value);
  const Base from = value.type.base;
  result.type.base = base;
  if (from == base || base == Base::real || from == Base::truth) return result;
  const Op op = base == Base::integer ? Op::to_integer : base == Base::natural ? Op::to_natural : Op::to_truth;
  result.type.base = from;
  return apply(op, result.type.with_base(base), {{result}}, at);
}

bool ShaderCompiler::converts(const ShaderType& from, const ShaderType& to) {
  if (from == to) return true;
  return from.is_number() && to.is_number() && from.with_base(to.base) == to && from.base != Base::real &&
         to.base != Base::integer;
}

ShaderValue ShaderCompiler::as(const ShaderValue& value, const ShaderType& type, std::string_view what) {
  if (!converts(value.type, type)) {
    refuse(value.at, fmt::format("{} is {}; expected {}", what, name_of(value.type), name_of(type)));
  }
  return value.type == type ? plain(value) : converted(value, type.base, value.at);
}

void ShaderCompiler::assign(const ShaderValue& target, const ShaderValue& value) {
  if (!target.is_place) refuse(target.at, "this cannot be assigned to; expected a variable that is not constant");
  const ShaderValue source = as(value, target.type, "what is assigned");
  const auto move = [&](std::uint32_t to, std::uint32_t from, std::uint32_t n) {
    if (target.offset) {
      code_.emit({.op = Op::store, .n = n, .dst = to, .a = from, .b = *target.offset, .at = target.at});
    } else {
      code_.emit({.op = Op::copy, .n = n, .dst = to, .a = from, .at = target.at});
    }
  };
  if (target.picked.empty()) return move(target.slot, source.slot, slots_of(target.type));
  // The value may be the same vector.
  const ShaderValue copy = fresh(source.type, source.at);
  code_.emit({.op = Op::copy, .n = slots_of(source.type), .dst = copy.slot, .a = source.slot, .at = source.at});
  for (std::uint32_t k = 0; k < target.picked.size(); ++k) move(target.slot + target.picked[k], copy.slot + k, 1);
}

// --- Operators.

ShaderValue ShaderCompiler::read_expression() {
  const Nesting nesting(*this);
  const ShaderValue value = read_operators(kLowestLevel);
  return token_.is("?") ? read_choice(value) : value;
}

ShaderValue ShaderCompiler::read_choice(ShaderValue condition) {
  const ShaderPlace at = token_.at;
  advance();
  if (!condition.type.is_truth()) refuse(condition.at, "the condition before '?' is no bool; expected one");
  condition = plain(condition);
  const std::uint32_t to_second = code_.here();
  code_.emit({.op = Op::jump_if_false, .a = condition.slot, .at = at});
  const ShaderValue first = plain(read_expression());
  expect(":");
  const ShaderValue result = fresh(first.type, at);
  const std::uint32_t n = slots_of(first.type);
  code_.emit({.op = Op::copy, .n = n, .dst = result.slot, .a = first.slot, .at = first.at});
  const std::uint32_t to_end = code_.here();
  code_.emit({.op = Op::jump, .at = at});
  code_.lead_here(to_second);
  ShaderValue second = read_expression();
  ShaderValue chosen = result;
  if (converts(first.type, second.type)) {
    chosen.type = second.type;
    second = plain(second);
  } else {
    second = as(second, first.type, "what stands behind ':'");
  }
  code_.emit({.op = Op::copy, .n = n, .dst = result.slot, .a = second.slot, .at = second.at});
  code_.lead_here(to_end);
  return chosen;
}

ShaderValue ShaderCompiler::read_operators(unsigned lowest) {
  const Nesting nesting(*this);
  ShaderValue left = read_unary();
  for (;;) {
    const auto* found = token_.kind == Kind::sign
                            ? std::ranges::find(kShaderOperators, token_.text, &ShaderOperator::sign)
                            : kShaderOperators.end();
    if (found == kShaderOperators.end() || found->level < lowest) return left;
    const ShaderToken sign = token_;
    advance();
    if (found->level < kComparisonLevel) {
      left = read_logical(left, sign, found->level);
    } else {
      left = plain(left);
      left = operate(sign, left, plain(read_operators(found->level + 1)));
    }
  }
}

ShaderValue ShaderCompiler::read_logical(ShaderValue left, const ShaderToken& sign, unsigned level) {
  const auto require_truth = [&](const ShaderValue& value) {
    if (!value.type.is_truth()) {
      refuse(value.at,
             fmt::format("'{}' joins conditions, and this is {}; expected bool", sign.text, name_of(value.type)));
    }
    return plain(value);
  };
  left = require_truth(left);
  if (sign.is("^^")) {
    const ShaderValue right = require_truth(read_operators(level + 1));
    return apply(Op::unequal, left.type, {{left, right}}, sign.at);
  }
  const ShaderValue result = fresh(left.type, sign.at);
  code_.emit({.op = Op::copy, .dst = result.slot, .a = left.slot, .at = sign.at});
  const ShaderValue decides = sign.is("&&") ? left : apply(Op::opposite, left.type, {{left}}, sign.at);
  const std::uint32_t to_end = code_.here();
  code_.emit({.op = Op::jump_if_false, .a = decides.slot, .at = sign.at});
  const ShaderValue right = require_truth(read_operators(level + 1));
  code_.emit({.op = Op::copy, .dst = result.slot, .a = right.slot, .at = sign.at});
  code_.lead_here(to_end);
  return result;
}

ShaderValue ShaderCompiler::operate(const ShaderToken& sign, const ShaderValue& a, const ShaderValue& b) {
  if (sign.is("==") || sign.is("!=") || sign.is("<") || sign.is(">") || sign.is("<=") || sign.is(">=")) {
    return compare(sign, a, b);
  }
  return arithmetic(sign, a, b);
}

ShaderValue ShaderCompiler::compare(const ShaderToken& sign, const ShaderValue& a, const ShaderValue& b) {
  const bool is_equality = sign.is("==") || sign.is("!=");
  const bool fits = is_equality ? converts(a.type, b.type) || converts(b.type, a.type)
                                : a.type.is_number() && b.type.is_number() && a.type.is_scalar() && b.type.is_scalar();
  if (!fits) {
    refuse(sign.at, fmt::format("'{}' between {} and {}; expected {}", sign.text, name_of(a.type), name_of(b.type),
                                is_equality ? "the same type" : "two numbers"));
  }
  const ShaderType truth = shader_scalar(Base::truth);
  if (!is_equality) return apply(comparison_op(sign.text), truth, {{a, b}}, sign.at);
  const ShaderValue result = fresh(truth, sign.at);
  code_.emit({.op = sign.is("==") ? Op::same : Op::differs,
              .n = slots_of(a.type),
              .dst = result.slot,
              .a = a.slot,
              .b = b.slot,
              .at = sign.at});
  return result;
}

ShaderValue ShaderCompiler::arithmetic(const ShaderToken& sign, ShaderValue a, ShaderValue b) {
  const auto refuse_operands = [&](std::string_view expected) {
    refuse(sign.at,
           fmt::format("'{}' between {} and {}; expected {}", sign.text, name_of(a.type), name_of(b.type), expected));
  };
  if (!a.type.is_number() || !b.type.is_number()) refuse_operands("numbers, vectors or matrices");
  const Base base = common_base(a.type.base, b.type.base);
  if (sign.is("%") && base == Base::real) refuse_operands("integers (of numbers it is mod(a, b))");
  const bool is_product = sign.text.front() == '*';
  if (is_product && (a.type.is_matrix() || b.type.is_matrix()) && !a.type.is_scalar() && !b.type.is_scalar()) {
    return product(sign, a, b);
  }
  a = converted(a, base, sign.at);
  b = converted(b, base, sign.at);
  if (a.type != b.type && !a.type.is_scalar() && !b.type.is_scalar()) {
    refuse_operands("operands of one size, or one number among them");
  }
  const ShaderType& type = a.type.is_scalar() ? b.type : a.type;
  const ShaderValue result = apply(arithmetic_op(sign.text, base != Base::real), type, {{a, b}}, sign.at);
  if (base == Base::real) return result;
  return apply(base == Base::integer ? Op::wrap_integer : Op::wrap_natural, type, {{result}}, sign.at);
}

ShaderValue ShaderCompiler::product(const ShaderToken& sign, const ShaderValue& a, const ShaderValue& b) {
  // A vector is a row before a matrix, and a column behind it.
  const std::uint32_t rows = a.type.is_matrix() ? a.type.rows : 1;
  const std::uint32_t inner = a.type.is_matrix() ? a.type.columns : a.type.rows;
  const std::uint32_t columns = b.type.columns;
  if (inner != b.type.rows) {
    refuse(sign.at, fmt::format("'{}' between {} and {}; expected as many rows of the second as columns of the first",
                                sign.text, name_of(a.type), name_of(b.type)));
  }
  ShaderType type = shader_vector(Base::real, rows);
  type.columns = static_cast<std::uint8_t>(columns);
  if (rows == 1) type = shader_vector(Base::real, columns);
  const ShaderValue result = fresh(type, sign.at);
  code_.emit({.op = Op::matrix,
              .dst = result.slot,
              .a = a.slot,
              .b = b.slot,
              .c = packed_sizes(rows, inner, columns),
              .at = sign.at});
  return result;
}

ShaderValue ShaderCompiler::read_unary() {
  const Nesting nesting(*this);
  const ShaderToken sign = token_;
  if (sign.is("++") || sign.is("--")) {
    refuse(sign.at, fmt::format("'{}' within an expression is not read; expected a statement of its own", sign.text));
  }
  if (!sign.is("-") && !sign.is("+") && !sign.is("!")) return read_postfix();
  advance();
  const ShaderValue operand = plain(read_unary());
  if (sign.is("!")) {
    if (!operand.type.is_truth()) refuse(sign.at, fmt::format("'!' before {}; expected bool", name_of(operand.type)));
    return apply(Op::opposite, operand.type, {{operand}}, sign.at);
  }
  if (!operand.type.is_number()) {
    refuse(sign.at, fmt::format("'{}' before {}; expected a number", sign.text, name_of(operand.type)));
  }
  if (sign.is("+")) return operand;
  const ShaderValue negative = apply(Op::negate, operand.type, {{operand}}, sign.at);
  if (operand.type.base == Base::real) return negative;
  const Op wrap = operand.type.base == Base::integer ? Op::wrap_integer : Op::wrap_natural;
  return apply(wrap, operand.type, {{negative}}, sign.at);
}

// --- Operands.

ShaderValue ShaderCompiler::read_postfix() {
  ShaderValue value = read_primary();
  for (;;) {
    if (token_.is("[")) {
      const ShaderPlace at = token_.at;
      advance();
      const ShaderValue index = read_expression();
      expect("]");
      value = element(value, index, at);
    } else if (token_.is(".")) {
      advance();
      value = member(value, take_name("a component or a member"));
    } else {
      return value;
    }
  }
}

ShaderValue ShaderCompiler::read_primary() {
  const ShaderToken token = token_;
  if (token.kind == Kind::integer || token.kind == Kind::natural || token.kind == Kind::real) return read_number();
  if (token.is("(")) {
    advance();
    ShaderValue value = read_expression();
    if (token_.is("="))
      refuse(token_.at, "an assignment within an expression is not read; expected a statement of its own");
    expect(")");
    value.is_place = false;
    return value;
  }
  if (token.is("true") || token.is("false")) {
    advance();
    const double value = token.is("true") ? 1 : 0;
    return constant(shader_scalar(Base::truth), {&value, 1}, token.at);
  }
  if (at_type()) {
    ShaderType type = read_type();
    if (token_.is("[")) {
      advance();
      type.count = token_.is("]") ? kNoCount : read_count();
      expect("]");
    }
    return construct(type, token.at);
  }
  if (token.kind != Kind::name || is_shader_keyword(token.text)) refuse_here("a value");
  advance();
  if (token_.is("(")) return call(token);
  const ShaderValue* variable = find(token.text);
  if (variable == nullptr) {
    std::vector<std::string_view> names;
    for (const Scope& scope : scopes_) {
      for (const auto& [name, value] : scope) names.push_back(name);
    }
    refuse(token.at, fmt::format("unknown name '{}'{}", excerpt(token.text), suggestion(token.text, names)));
  }
  ShaderValue value = *variable;
  if (value.is_variable && code_.block() == ShaderCode::Block::setup) {
    refuse(token.at,
           fmt::format("'{}' is no constant, which a constant of the file needs; expected one", excerpt(token.text)));
  }
  value.at = token.at;
  return value;
}

ShaderValue ShaderCompiler::read_number() {
  const ShaderToken token = token_;
  advance();
  const Base base = token.kind == Kind::real ? Base::real : token.kind == Kind::integer ? Base::integer : Base::natural;
  return constant(shader_scalar(base), {&token.number, 1}, token.at);
}

ShaderValue ShaderCompiler::member(const ShaderValue& of, const ShaderToken& name) {
  if (of.type.count > 0) {
    if (!name.is("length")) refuse(name.at, "an array has no members; expected an index, or .length()");
    expect("(");
    expect(")");
    const double count = of.type.count;
    return constant(shader_scalar(Base::integer), {&count, 1}, name.at);
  }
  if (of.type.base != Base::structure) return components(of, name);
  const ShaderStructure& structure = structures_[of.type.structure];
  const auto found = std::ranges::find(structure.members, name.text, &ShaderMember::name);
  if (found == structure.members.end()) {
    std::vector<std::string_view> names;
    for (const auto& one : structure.members) names.push_back(one.name);
    refuse(name.at,
           fmt::format("'{}' is no member of {}{}", excerpt(name.text), structure.name, suggestion(name.text, names)));
  }
  ShaderValue value = of;
  value.type = found->type;
  value.slot += found->offset;
  value.at = name.at;
  return value;
}

ShaderValue ShaderCompiler::components(const ShaderValue& of, const ShaderToken& name) {
  constexpr std::array<std::string_view, 3> kLetters{"xyzw", "rgba", "stpq"};
  if (!of.type.is_vector()) {
    refuse(name.at,
           fmt::format("{} has no component '{}'; expected a vector before '.'", name_of(of.type), excerpt(name.text)));
  }
  std::vector<std::uint8_t> picked;
  for (const std::string_view letters : kLetters) {
    if (letters.find(name.text.front()) == std::string_view::npos) continue;
    for (const char letter : name.text.substr(0, kMostComponents + 1)) {
      const std::size_t component = letters.find(letter);
      if (component < of.type.rows) picked.push_back(static_cast<std::uint8_t>(component));
    }
  }
  if (picked.size() != name.text.size() || picked.size() > kMostComponents) {
    refuse(name.at, fmt::format("'{}' picks no components of {}; expected some of {}", excerpt(name.text),
                                name_of(of.type), kLetters[0].substr(0, of.type.rows)));
  }
  ShaderValue value = of;
  value.at = name.at;
  value.type = picked.size() == 1 ? shader_scalar(of.type.base)
                                  : shader_vector(of.type.base, static_cast<std::uint32_t>(picked.size()));
  auto sorted = picked;
  std::ranges::sort(sorted);
  if (std::ranges::adjacent_find(sorted) != sorted.end()) value.is_place = false;
  if (!of.picked.empty()) {
    for (std::uint8_t& one : picked) one = of.picked[one];
  }
  bool is_run = true;
  for (std::size_t k = 1; k < picked.size(); ++k) is_run = is_run && picked[k] == picked[k - 1] + 1;
  value.picked.clear();
  if (is_run) {
    value.slot += picked.front();
  } else {
    value.picked = std::move(picked);
  }
  return value;
}

ShaderValue ShaderCompiler::element(const ShaderValue& of, const ShaderValue& index, const ShaderPlace& at) {
  if (of.type.count == 0 && !of.type.is_vector() && !of.type.is_matrix()) {
    refuse(at, fmt::format("an index behind {}; expected an array, a vector or a matrix", name_of(of.type)));
  }
  if (!index.type.is_integer() || !index.type.is_scalar()) {
    refuse(index.at, fmt::format("the index is {}; expected int", name_of(index.type)));
  }
  ShaderValue value = of.picked.empty() ? of : plain(of);
  const std::uint32_t count = of.type.count > 0 ? of.type.count : of.type.is_matrix() ? of.type.columns : of.type.rows;
  value.type = of.type.count > 0     ? of.type.element()
               : of.type.is_matrix() ? shader_vector(of.type.base, of.type.rows)
                                     : shader_scalar(of.type.base);
  value.at = at;
  const std::uint32_t stride = slots_of(value.type);
  if (is_known(index)) {
    const double k = known(index);
    if (!(k >= 0 && k < count))
      refuse(index.at, fmt::format("index {} of {} elements; expected 0 to {}", k, count, count - 1));
    value.slot += static_cast<std::uint32_t>(k) * stride;
    return value;
  }
  const ShaderValue place = plain(index);
  const std::uint32_t own = code_.take_slots(1, at);
  code_.emit({.op = Op::index, .dst = own, .a = place.slot, .b = count, .c = stride, .at = at});
  if (value.offset) {
    const std::uint32_t both = code_.take_slots(1, at);
    code_.emit({.op = Op::add, .dst = both, .a = *value.offset, .b = own, .at = at});
    value.offset = both;
  } else {
    value.offset = own;
  }
  return value;
}

// --- Constructors.

Values ShaderCompiler::read_arguments() {
  Values arguments;
  expect("(");
  if (token_.is("void")) advance();
  if (accept(")")) return arguments;
  do {
    if (arguments.size() == kMostArguments) refuse_here("fewer arguments");
    arguments.push_back(read_expression());
    // A place that a function writes to stays one.
    if (!arguments.back().is_place) {
      arguments.back() = plain(arguments.back());
    } else if (has_side_effects_) {
      arguments.back().copied = plain(arguments.back()).slot;
    }
  } while (accept(","));
  expect(")");
  return arguments;
}

ShaderValue ShaderCompiler::construct(const ShaderType& given, const ShaderPlace& at) {
  if (!token_.is("(")) refuse_here(fmt::format("'(' behind {}", name_of(given.element())));
  Values parts = read_arguments();
  ShaderType type = given;
  if (type.base == Base::nothing) refuse(at, "void has no values; expected another type");
  if (type.count == kNoCount) type.count = static_cast<std::uint32_t>(parts.size());
  if (type.count > 0 || type.base == Base::structure) {
    const auto* structure = type.count > 0 ? nullptr : &structures_[type.structure];
    const std::size_t expected = structure == nullptr ? type.count : structure->members.size();
    if (parts.size() != expected || parts.empty()) {
      refuse(at, fmt::format("{} has {} parts; expected {}", name_of(type), parts.size(), expected));
    }
    for (std::size_t k = 0; k < parts.size(); ++k) {
      parts[k] = as(parts[k], structure == nullptr ? type.element() : structure->members[k].type, "a part");
    }
    return construct_whole(type, parts, at);
  }
  if (parts.empty()) refuse(at, fmt::format("{}() has no parts; expected some", name_of(type)));
  for (ShaderValue& part : parts) {
    if (!part.type.is_plain() || part.type.base == Base::nothing) {
      refuse(part.at, fmt::format("a part is {}; expected a number or a vector", name_of(part.type)));
    }
    part = converted(part, type.base, part.at);
  }
  if (parts.size() == 1) {
    const ShaderValue& part = parts.front();
    if (part.type == type) return part;
    if (part.type.is_scalar() && type.is_matrix()) return construct_matrix(type, part, at);
    if (part.type.is_scalar()) {
      parts.assign(type.size(), part);
    } else if (part.type.is_matrix() || type.is_matrix()) {
      refuse(at, fmt::format("{} of {} is not read; expected its columns or components", name_of(type),
                             name_of(part.type)));
    }
  }
  std::uint32_t components = 0;
  for (ShaderValue& part : parts) {
    if (components >= type.size())
      refuse(part.at, fmt::format("too many parts of {}; expected {} components", name_of(type), type.size()));
    const std::uint32_t rest = type.size() - components;
    if (part.type.size() > rest) part.type = rest == 1 ? shader_scalar(type.base) : shader_vector(type.base, rest);
    components += part.type.size();
  }
  if (components < type.size()) {
    refuse(at, fmt::format("{} has {} components; expected {}", name_of(type), components, type.size()));
  }
  return construct_whole(type, parts, at);
}

ShaderValue ShaderCompiler::construct_whole(const ShaderType& type, const Values& parts, const ShaderPlace& at) {
  if (std::ranges::all_of(parts, [&](const ShaderValue& one) { return is_known(one); })) {
    std::vector<double> values;
    for (const ShaderValue& part : parts) {
      for (std::uint32_t k = 0; k < slots_of(part.type); ++k) values.push_back(known(part, k));
    }
    return constant(type, values, at);
  }
  const ShaderValue result = fresh(type, at);
  std::uint32_t to = result.slot;
  for (const ShaderValue& part : parts) {
    const std::uint32_t n = slots_of(part.type);
    code_.emit({.op = Op::copy, .n = n, .dst = to, .a = part.slot, .at = part.at});
    to += n;
  }
  return result;
}

ShaderValue ShaderCompiler::construct_matrix(const ShaderType& type, const ShaderValue& scalar, const ShaderPlace& at) {
  const double zero = 0;
  Values parts;
  for (unsigned column = 0; column < type.columns; ++column) {
    for (unsigned row = 0; row < type.rows; ++row) {
      parts.push_back(row == column ? scalar : constant(shader_scalar(Base::real), {&zero, 1}, at));
    }
  }
  return construct_whole(type, parts, at);
}

// --- Calls.

std::string ShaderCompiler::call_text(const ShaderToken& name, std::span<const ShaderValue> arguments) const {
  std::vector<std::string> types;
  for (const ShaderValue& one : arguments) {
    if (types.size() == kMostComponents) {
      types.emplace_back("...");
      break;
    }
    types.push_back(name_of(one.type));
  }
  return fmt::format("{}({})", excerpt(name.text), fmt::join(types, ", "));
}

std::optional<std::size_t> ShaderCompiler::matching_function(const ShaderToken& name,
                                                             std::span<const ShaderValue> arguments) const {
  std::optional<std::size_t> converting;
  for (std::size_t k = 0; k < functions_.size(); ++k) {
    const Function& function = functions_[k];
    if (function.name != name.text || function.parameters.size() != arguments.size()) continue;
    bool is_same = true;
    bool fits = true;
    for (std::size_t i = 0; i < arguments.size(); ++i) {
      const Parameter& parameter = function.parameters[i];
      is_same = is_same && arguments[i].type == parameter.type;
      fits = fits && (parameter.direction == Direction::in ? converts(arguments[i].type, parameter.type)
                                                           : arguments[i].type == parameter.type);
    }
    if (is_same) return k;
    if (fits && !converting) converting = k;
  }
  return converting;
}

ShaderValue ShaderCompiler::call(const ShaderToken& name) {
  Values arguments = read_arguments();
  if (const auto function = matching_function(name, arguments)) {
    return call_function(*function, std::move(arguments), name.at);
  }
  for (ShaderValue& argument : arguments) argument = plain(argument);
  return call_builtin(name, std::move(arguments));
}

ShaderValue ShaderCompiler::call_function(std::size_t index, Values arguments, const ShaderPlace& at) {
  if (!current_)
    refuse(at, "the value of a global calls a function of this file, which is not read; expected an expression");
  const Function function = functions_[index];
  functions_[*current_].calls.emplace(index, at);
  Values places = arguments;
  for (std::size_t k = 0; k < arguments.size(); ++k) {
    const Parameter& parameter = function.parameters[k];
    if (parameter.direction != Direction::in && !arguments[k].is_place) {
      refuse(arguments[k].at, fmt::format("'{}' of {} is written to; expected a variable", excerpt(parameter.name),
                                          excerpt(function.name)));
    }
    if (parameter.direction != Direction::out) arguments[k] = as(arguments[k], parameter.type, "an argument");
  }
  for (std::size_t k = 0; k < arguments.size(); ++k) {
    const Parameter& parameter = function.parameters[k];
    const bool is_out = parameter.direction == Direction::out;
    code_.emit({.op = is_out ? Op::undefine : Op::copy,
                .n = slots_of(parameter.type),
                .dst = parameter.slot,
                .a = is_out ? 0 : arguments[k].slot,
                .at = at});
  }
  code_.emit({.op = Op::call, .dst = static_cast<std::uint32_t>(index), .at = at});
  for (std::size_t k = 0; k < places.size(); ++k) {
    const Parameter& parameter = function.parameters[k];
    if (parameter.direction == Direction::in) continue;
    assign(places[k], {.type = parameter.type, .slot = parameter.slot, .at = at});
  }
  if (function.type.base == Base::nothing) return {.type = {}, .at = at};
  const ShaderValue result = fresh(function.type, at);
  code_.emit({.op = Op::copy, .n = slots_of(function.type), .dst = result.slot, .a = function.result, .at = at});
  return result;
}

ShaderValue ShaderCompiler::by_components(const ShaderBuiltin& builtin, const ShaderToken& name, Values arguments) {
  Op op = builtin.op;
  ShaderType type = arguments.front().type;
  bool are_integers = true;
  for (const ShaderValue& one : arguments) {
    if (one.type.size() > type.size()) type = one.type;
    are_integers = are_integers && one.type.is_integer();
  }
  if (op == Op::mix && arguments.back().type.base == Base::truth) op = Op::choose;
  const Base base = keeps_integers(op) && are_integers
                        ? common_base(arguments.front().type.base, arguments.back().type.base)
                        : Base::real;
  type.base = base;
  for (std::size_t k = 0; k < arguments.size(); ++k) {
    ShaderValue& one = arguments[k];
    const bool is_condition = op == Op::choose && k + 1 == arguments.size();
    const bool is_size = one.type.size() == type.size();
    const bool fits = (one.type.is_number() || is_condition) && one.type.is_plain() && !one.type.is_matrix() &&
                      (is_size || (one.type.is_scalar() && !is_condition && ((builtin.scalars >> k) & 1U) != 0));
    if (!fits) {
      refuse(one.at,
             fmt::format("no function {}; expected numbers or vectors of one size", call_text(name, arguments)));
    }
    if (!is_condition) one = converted(one, base, one.at);
  }
  const ShaderValue result = apply(op, type, arguments, name.at);
  if (op != Op::is_nan && op != Op::is_infinite) return result;
  ShaderValue truths = result;
  truths.type.base = Base::truth;
  return truths;
}

ShaderValue ShaderCompiler::call_builtin(const ShaderToken& name, Values arguments) {
  const ShaderBuiltin* builtin = shader_builtin(name.text, arguments.size());
  const auto refuse_call = [&](std::string_view expected) {
    refuse(name.at, fmt::format("no function {}; expected {}", call_text(name, arguments), expected));
  };
  if (builtin == nullptr) {
    auto names = shader_builtin_names();
    const bool is_builtin = std::ranges::find(names, name.text) != names.end();
    std::vector<std::string_view> own;
    for (const Function& function : functions_) own.push_back(function.name);
    if (is_builtin || std::ranges::find(own, name.text) != own.end()) refuse_call("other arguments");
    names.insert(names.end(), own.begin(), own.end());
    const std::string near = nearest_word(name.text, names);
    refuse(name.at, fmt::format("unknown function '{}'; {}", excerpt(name.text),
                                near.empty() ? "expected one of GLSL, without textures, or one of this file"
                                             : fmt::format("did you mean '{}'?", near)));
  }
  if (builtin->shape == Shape::components) return by_components(*builtin, name, std::move(arguments));
  const bool takes_truths = builtin->shape == Shape::truths || builtin->shape == Shape::opposite;
  const bool takes_matrices = builtin->shape == Shape::transpose || builtin->shape == Shape::by_components;
  const ShaderType first = arguments.front().type;
  for (std::size_t k = 0; k < arguments.size(); ++k) {
    const ShaderType& type = arguments[k].type;
    const bool is_scalar_here = ((builtin->scalars >> k) & 1U) != 0;
    const bool has_base = takes_truths ? type.is_plain() && type.base == Base::truth
                                       : type.is_number() || (builtin->shape == Shape::comparison && type.is_plain());
    const bool has_size = is_scalar_here ? type.is_scalar()
                          : takes_matrices
                              ? type.is_matrix() && type == first
                              : !type.is_matrix() && (type.size() == first.size() || builtin->shape == Shape::outer);
    if (!has_base || !has_size) refuse_call(takes_matrices ? "matrices" : "vectors of one size");
    if (!takes_truths && builtin->shape != Shape::comparison)
      arguments[k] = converted(arguments[k], Base::real, name.at);
  }
  if (builtin->shape == Shape::cross && first.size() != 3) refuse_call("vectors of three components");
  const ShaderType real = first.with_base(Base::real);
  ShaderType type = real;
  std::uint32_t n = first.size();
  std::uint32_t c = arguments.size() > 2 ? arguments[2].slot : 0;
  switch (builtin->shape) {
    case Shape::comparison:
      return apply(builtin->op, first.with_base(Base::truth), arguments, name.at);
    case Shape::opposite:
      return apply(builtin->op, first, arguments, name.at);
    case Shape::by_components:
      return apply(builtin->op, real, arguments, name.at);
    case Shape::to_scalar:
      type = shader_scalar(Base::real);
      break;
    case Shape::truths:
      type = shader_scalar(Base::truth);
      break;
    case Shape::transpose:
      std::swap(type.rows, type.columns);
      c = first.rows;
      break;
    case Shape::outer:
      type.columns = arguments[1].type.rows;
      if (!first.is_vector() || !arguments[1].type.is_vector()) refuse_call("two vectors");
      n = type.size();
      c = first.rows;
      break;
    default:
      break;
  }
  const ShaderValue result = fresh(type, name.at);
  code_.emit({.op = builtin->op,
              .n = n,
              .dst = result.slot,
              .a = arguments[0].slot,
              .b = arguments.size() > 1 ? arguments[1].slot : 0,
              .c = c,
              .at = name.at});
  return result;
}

}  // namespace lobe
