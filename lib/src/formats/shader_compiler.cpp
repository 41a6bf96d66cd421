// Declarations and statements of shaders.
#include "formats/shader_compiler.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/text.hpp"
#include "lobe/core/error.hpp"

namespace lobe {
namespace {

using Kind = ShaderToken::Kind;
using Op = ShaderOp;
using Base = ShaderBase;
using Block = ShaderCode::Block;

constexpr std::size_t kMostText = std::size_t{1} << 17;  // bytes
constexpr std::size_t kDeepest = 256;
constexpr std::size_t kMostFunctions = 512;
constexpr std::size_t kMostParameters = 256;
constexpr std::size_t kMostStructures = 256;
constexpr std::uint32_t kMostElements = std::uint32_t{1} << 16;

constexpr std::uint32_t kRoles = 5;
constexpr std::uint32_t kAxes = 3;

/// Usual names of the directions, in lower case and without '_'.
constexpr std::array<std::array<std::string_view, 9>, kRoles> kRoleNames{
    {{"l", "light", "lightdir", "lightdirection", "tolight", "ldir", "wi", "omegai", "wl"},
     {"v", "view", "viewdir", "viewdirection", "eye", "toview", "wo", "omegao", "wv"},
     {"n", "normal", "norm", "nrm", "surfacenormal", "shadingnormal", "ns", "ng", "worldnormal"},
     {"x", "t", "tangent", "tx", "dpdu", "xaxis", "tu", "u", "tangentx"},
     {"y", "b", "bitangent", "binormal", "dpdv", "yaxis", "tv", "ty", "tangenty"}}};

std::optional<std::uint32_t> role_of(std::string_view name) {
  std::string word = lowercase(name);
  std::erase(word, '_');
  for (std::uint32_t role = 0; role < kRoles; ++role) {
    if (std::ranges::find(kRoleNames[role], word) != kRoleNames[role].end()) return role;
  }
  return std::nullopt;
}

std::string numbers_text(std::span<const double> values) {
  std::vector<std::string> texts;
  for (const double value : values) texts.push_back(shortest(value));
  return fmt::format("{}", fmt::join(texts, "/"));
}

}  // namespace

ShaderCompiler::ShaderCompiler(const FileBytes& file, const ReadOptions& options)
    : file_(file), options_(options), tokens_(file), code_(file) {
  if (file.size() > kMostText) {
    file.refuse_line(1, fmt::format("the shader has {} bytes; expected at most {}", file.size(), kMostText));
  }
}

ShaderCompiler::Nesting::Nesting(ShaderCompiler& compiler) : compiler_(compiler) {
  if (++compiler_.depth_ > kDeepest) compiler_.refuse(compiler_.token_.at, "this is nested too deep; expected less");
}

CompiledShader compile_shader(const FileBytes& file, const ReadOptions& options) {
  return ShaderCompiler(file, options).compile();
}

CompiledShader ShaderCompiler::compile() {
  advance();
  advance();
  while (token_.kind != Kind::end) read_global();
  CompiledShader made;
  const std::size_t chosen = choose_function(made);
  require_uniforms();
  require_calls();
  write_entry(chosen, made);
  return made;
}

// --- Tokens.

void ShaderCompiler::refuse(const ShaderPlace& at, const std::string& complaint) const {
  refuse_shader(file_, at, complaint);
}

void ShaderCompiler::refuse_here(std::string_view expected) const {
  refuse(token_.at, fmt::format("unexpected {}; expected {}", shown(token_), expected));
}

void ShaderCompiler::advance() {
  token_ = next_;
  next_ = tokens_.next();
}

bool ShaderCompiler::accept(std::string_view sign) {
  if (!token_.is(sign)) return false;
  advance();
  return true;
}

void ShaderCompiler::expect(std::string_view sign) {
  if (!accept(sign)) refuse_here(fmt::format("'{}'", sign));
}

ShaderToken ShaderCompiler::take_name(std::string_view of_what) {
  const ShaderToken name = token_;
  if (name.kind != Kind::name || is_shader_keyword(name.text)) refuse_here(fmt::format("the name of {}", of_what));
  advance();
  return name;
}

// --- Types and names.

bool ShaderCompiler::at_type() const {
  if (token_.kind != Kind::name) return false;
  return shader_type(token_.text).has_value() ||
         std::ranges::find(structures_, token_.text, &ShaderStructure::name) != structures_.end();
}

bool ShaderCompiler::skip_precision() {
  return accept("highp") || accept("mediump") || accept("lowp");
}

ShaderType ShaderCompiler::read_type() {
  while (skip_precision()) {
  }
  if (token_.kind != Kind::name) refuse_here("a type");
  const ShaderToken name = token_;
  const auto structure = std::ranges::find(structures_, name.text, &ShaderStructure::name);
  const auto type = shader_type(name.text);
  if (!type && structure == structures_.end()) {
    refuse(name.at, fmt::format("{} is no type that is read; expected float, int, uint, bool, a vector, a matrix or a "
                                "structure of this file",
                                shown(name)));
  }
  advance();
  if (type) return *type;
  return {.base = Base::structure, .structure = static_cast<std::uint16_t>(structure - structures_.begin())};
}

std::uint32_t ShaderCompiler::read_count() {
  const ShaderValue count = read_expression();
  const bool is_number = count.type.is_integer() && count.type.is_scalar() && is_known(count);
  if (!is_number || !(known(count) >= 1 && known(count) <= kMostElements)) {
    refuse(count.at,
           fmt::format("the size of an array is not known here; expected a constant from 1 to {}", kMostElements));
  }
  return static_cast<std::uint32_t>(known(count));
}

void ShaderCompiler::read_array(ShaderType& type) {
  if (!accept("[")) return;
  if (type.count > 0) refuse(token_.at, "an array of arrays is not read; expected one size");
  type.count = token_.is("]") ? kNoCount : read_count();
  expect("]");
}

std::uint32_t ShaderCompiler::slots_of(const ShaderType& type) const {
  const std::uint64_t one = type.base == Base::structure ? structures_[type.structure].slots : type.size();
  const std::uint64_t all = one * (type.count == 0 ? 1 : type.count);
  return static_cast<std::uint32_t>(std::min<std::uint64_t>(all, kMostElements + 1));
}

std::string ShaderCompiler::name_of(const ShaderType& type) const {
  const auto plain_name = [&]() -> std::string {
    constexpr std::array<std::string_view, 6> kScalars{"void", "float", "int", "uint", "bool", "struct"};
    constexpr std::array<std::string_view, 6> kLetters{"", "", "i", "u", "b", ""};
    const auto base = static_cast<std::size_t>(type.base);
    if (type.base == Base::structure) return excerpt(structures_[type.structure].name);
    if (type.columns > 1 && type.rows == type.columns) return fmt::format("mat{}", type.rows);
    if (type.columns > 1) return fmt::format("mat{}x{}", type.columns, type.rows);
    return type.rows > 1 ? fmt::format("{}vec{}", kLetters[base], type.rows) : std::string(kScalars[base]);
  };
  if (type.count == 0) return plain_name();
  return type.count == kNoCount ? plain_name() + "[]" : fmt::format("{}[{}]", plain_name(), type.count);
}

void ShaderCompiler::declare(const ShaderToken& name, ShaderValue value) {
  value.at = name.at;
  if (!scopes_.back().emplace(name.text, std::move(value)).second) {
    refuse(name.at, fmt::format("'{}' is declared twice; expected another name", excerpt(name.text)));
  }
}

const ShaderValue* ShaderCompiler::find(std::string_view name) const {
  for (auto scope = scopes_.rbegin(); scope != scopes_.rend(); ++scope) {
    if (const auto found = scope->find(name); found != scope->end()) return &found->second;
  }
  return nullptr;
}

// --- Declarations.

void ShaderCompiler::read_precision() {
  advance();
  if (!skip_precision()) refuse_here("highp, mediump or lowp");
  if (token_.kind != Kind::name) refuse_here("a type");
  advance();
  expect(";");
}

void ShaderCompiler::read_global() {
  const Nesting nesting(*this);
  if (accept(";")) return;
  if (token_.is("precision")) return read_precision();
  if (token_.is("struct")) return read_structure();
  if (token_.is("uniform")) return read_uniform();
  if (token_.is("const")) return read_constants();
  constexpr std::array<std::string_view, 8> kOutside{"in",     "out",    "varying", "attribute",
                                                     "layout", "buffer", "shared",  "flat"};
  if (std::ranges::any_of(kOutside, [&](std::string_view word) { return token_.is(word); })) {
    refuse(token_.at,
           fmt::format("'{}' connects stages of a pipeline; expected uniforms, constants and functions alone",
                       token_.text));
  }
  ShaderType type = read_type();
  read_array(type);
  const ShaderToken name = take_name("a function or a variable");
  if (token_.is("(")) return read_function(type, name);
  read_variables(type, false, name);
}

void ShaderCompiler::read_constants() {
  advance();
  ShaderType type = read_type();
  read_array(type);
  read_variables(type, true, take_name("a constant"));
}

void ShaderCompiler::read_structure() {
  advance();
  const ShaderToken name = take_name("a structure");
  if (at_type() || structures_.size() == kMostStructures ||
      std::ranges::find(structures_, name.text, &ShaderStructure::name) != structures_.end()) {
    refuse(name.at,
           fmt::format("structure '{}' is declared twice, or one too many; expected another name", excerpt(name.text)));
  }
  ShaderStructure structure{name.text, {}, 0};
  expect("{");
  while (!accept("}")) read_members(structure);
  if (structure.members.empty()) refuse(name.at, "a structure without members; expected some");
  structures_.push_back(std::move(structure));
  expect(";");
}

void ShaderCompiler::read_members(ShaderStructure& structure) {
  const ShaderType common = read_type();
  do {
    ShaderType type = common;
    read_array(type);
    const ShaderToken name = take_name("a member");
    read_array(type);
    if (type.base == Base::nothing || type.count == kNoCount) {
      refuse(name.at, fmt::format("member '{}' has no size; expected another type", excerpt(name.text)));
    }
    if (std::ranges::find(structure.members, name.text, &ShaderMember::name) != structure.members.end()) {
      refuse(name.at, fmt::format("member '{}' is declared twice; expected another name", excerpt(name.text)));
    }
    structure.members.push_back({name.text, type, structure.slots});
    structure.slots += slots_of(type);
    if (structure.slots > kMostElements) refuse(name.at, "the structure is too large; expected fewer members");
  } while (accept(","));
  expect(";");
}

void ShaderCompiler::read_uniform() {
  advance();
  ShaderType type = read_type();
  read_array(type);
  do {
    ShaderType own = type;
    const ShaderToken name = take_name("a uniform");
    read_array(own);
    if (own.base == Base::structure || own.base == Base::nothing || own.count == kNoCount) {
      refuse(name.at, fmt::format("uniform '{}' is {}; expected numbers, vectors or matrices", excerpt(name.text),
                                  name_of(own)));
    }
    set_uniform(name, own);
  } while (accept(","));
  expect(";");
}

void ShaderCompiler::set_uniform(const ShaderToken& name, const ShaderType& type) {
  uniform_names_.push_back(name.text);
  std::vector<double> values(slots_of(type), 0);
  bool is_set = false;
  if (accept("=")) {
    const ShaderValue value = as(read_expression(), type, "the value of the uniform");
    if (!is_known(value)) refuse(value.at, "the value of a uniform is not known here; expected a constant");
    for (std::uint32_t k = 0; k < values.size(); ++k) values[k] = known(value, k);
    is_set = true;
  }
  const auto given = std::ranges::find(options_.uniforms, name.text, &UniformValue::name);
  if (given != options_.uniforms.end()) {
    if (given->values.size() != 1 && given->values.size() != values.size()) {
      throw ArgumentError(fmt::format("uniform '{}' of '{}' is given {} numbers; expected {} for {}", name.text,
                                      file_.stem(), given->values.size(), values.size(), name_of(type)));
    }
    for (std::size_t k = 0; k < values.size(); ++k) values[k] = given->values[given->values.size() == 1 ? 0 : k];
    const bool is_whole =
        std::ranges::all_of(values, [](double x) { return x == std::floor(x) && std::abs(x) < 0x1p31; });
    if (type.base != Base::real &&
        (!is_whole || (type.base == Base::natural && std::ranges::any_of(values, [](double x) { return x < 0; })))) {
      throw ArgumentError(fmt::format("uniform '{}' of '{}' is {}; expected whole numbers for {}", name.text,
                                      file_.stem(), numbers_text(given->values), name_of(type)));
    }
    is_set = true;
  }
  if (!is_set) missing_.push_back(name);
  if (is_set) uniforms_.push_back(fmt::format("{} = {}", name.text, numbers_text(values)));
  declare(name, constant(type, values, name.at));
}

void ShaderCompiler::read_variables(const ShaderType& type, bool is_constant, ShaderToken name) {
  if (type.base == Base::nothing)
    refuse(name.at, fmt::format("variable '{}' is void; expected another type", excerpt(name.text)));
  read_variable(type, is_constant, name);
  while (accept(",")) {
    name = take_name("a variable");
    read_variable(type, is_constant, name);
  }
  expect(";");
}

void ShaderCompiler::read_variable(ShaderType type, bool is_constant, const ShaderToken& name) {
  read_array(type);
  const bool is_global = !current_;
  if (is_global) code_.go_to(is_constant ? Block::setup : Block::reset);
  if (is_global && !is_constant) has_side_effects_ = true;
  std::optional<ShaderValue> value;
  if (accept("=")) {
    value = read_expression();
    if (type.count == kNoCount && value->type.element() == type.element()) type.count = value->type.count;
    value = as(*value, type, fmt::format("the value of '{}'", excerpt(name.text)));
  }
  if (is_constant && !value)
    refuse(name.at, fmt::format("constant '{}' has no value; expected '='", excerpt(name.text)));
  if (type.count == kNoCount) refuse(name.at, fmt::format("array '{}' has no size; expected one", excerpt(name.text)));
  if (is_constant && is_known(*value)) {
    declare(name, *value);
  } else {
    ShaderValue variable = fresh(type, name.at);
    variable.is_place = variable.is_variable = !is_constant;
    code_.emit({.op = value ? Op::copy : Op::undefine,
                .n = slots_of(type),
                .dst = variable.slot,
                .a = value ? value->slot : 0,
                .at = name.at});
    declare(name, variable);
  }
  if (is_global) code_.go_to(Block::functions);
}

// --- Functions.

ShaderCompiler::Parameter ShaderCompiler::read_parameter() {
  Parameter parameter;
  for (;;) {
    if (accept("inout")) {
      parameter.direction = Direction::inout;
    } else if (accept("out")) {
      parameter.direction = Direction::out;
    } else if (!accept("in") && !accept("const") && !skip_precision()) {
      break;
    }
  }
  parameter.type = read_type();
  read_array(parameter.type);
  if (token_.kind == Kind::name) parameter.name = take_name("a parameter").text;
  read_array(parameter.type);
  if (parameter.type.base == Base::nothing || parameter.type.count == kNoCount) refuse_here("a parameter with a size");
  return parameter;
}

std::vector<ShaderCompiler::Parameter> ShaderCompiler::read_parameters() {
  std::vector<Parameter> parameters;
  expect("(");
  if (token_.is("void") && next_.is(")")) advance();
  if (accept(")")) return parameters;
  do {
    if (parameters.size() == kMostParameters) refuse_here("fewer parameters");
    parameters.push_back(read_parameter());
    if (parameters.back().direction != Direction::in) has_side_effects_ = true;
  } while (accept(","));
  expect(")");
  return parameters;
}

std::size_t ShaderCompiler::declare_function(Function function) {
  const auto is_same = [&](const Function& other) {
    return other.name == function.name &&
           std::ranges::equal(other.parameters, function.parameters, {}, &Parameter::type, &Parameter::type);
  };
  const auto known_one = std::ranges::find_if(functions_, is_same);
  if (known_one != functions_.end()) {
    const bool agrees =
        known_one->type == function.type && std::ranges::equal(known_one->parameters, function.parameters, {},
                                                               &Parameter::direction, &Parameter::direction);
    if (!agrees || (known_one->is_defined && function.is_defined)) {
      refuse(function.at, fmt::format("function '{}' is declared twice; expected another name or other parameters",
                                      excerpt(function.name)));
    }
    for (std::size_t k = 0; k < function.parameters.size(); ++k) {
      known_one->parameters[k].name = function.parameters[k].name;
    }
    known_one->is_defined = known_one->is_defined || function.is_defined;
    known_one->at = function.at;
    return static_cast<std::size_t>(known_one - functions_.begin());
  }
  if (functions_.size() == kMostFunctions)
    refuse(function.at, fmt::format("more than {} functions; expected fewer", kMostFunctions));
  for (Parameter& parameter : function.parameters) {
    parameter.slot = code_.take_slots(slots_of(parameter.type), function.at);
  }
  if (function.type.base != Base::nothing) function.result = code_.take_slots(slots_of(function.type), function.at);
  functions_.push_back(std::move(function));
  return functions_.size() - 1;
}

void ShaderCompiler::read_function(const ShaderType& type, const ShaderToken& name) {
  if (type.count == kNoCount) refuse(name.at, "an array without a size is returned; expected one");
  Function function{.name = name.text, .type = type, .parameters = read_parameters(), .at = name.at};
  if (!token_.is("{") && !token_.is(";")) refuse_here("'{' and the body of the function");
  function.is_defined = token_.is("{");
  const std::size_t index = declare_function(std::move(function));
  if (functions_[index].is_defined && token_.is("{")) return read_body(index);
  expect(";");
}

void ShaderCompiler::read_body(std::size_t index) {
  const ShaderPlace at = token_.at;
  functions_[index].entry = code_.here();
  current_ = index;
  scopes_.emplace_back();
  for (const Parameter& parameter : functions_[index].parameters) {
    if (parameter.name.empty()) continue;
    declare({.kind = Kind::name, .text = parameter.name, .at = functions_[index].at},
            {.type = parameter.type, .slot = parameter.slot, .is_place = true, .is_variable = true});
  }
  read_block();
  scopes_.pop_back();
  current_.reset();
  const Function& function = functions_[index];
  // Behind the last return; what comes here returns nothing.
  if (function.type.base != Base::nothing) {
    code_.emit({.op = Op::undefine, .n = slots_of(function.type), .dst = function.result, .at = at});
  }
  code_.emit({.op = Op::give_back, .at = at});
}

// --- Statements.

void ShaderCompiler::read_block() {
  expect("{");
  while (!token_.is("}")) {
    if (token_.kind == Kind::end) refuse_here("'}'");
    read_statement();
  }
  advance();
}

void ShaderCompiler::read_statement() {
  const Nesting nesting(*this);
  if (accept(";")) return;
  if (token_.is("{")) {
    scopes_.emplace_back();
    read_block();
    scopes_.pop_back();
    return;
  }
  if (token_.is("if")) return read_if();
  if (token_.is("for")) return read_for();
  if (token_.is("while")) return read_while();
  if (token_.is("do")) return read_do();
  if (token_.is("return")) return read_return();
  if (token_.is("break") || token_.is("continue")) return read_jump(token_.is("break"));
  if (token_.is("const")) return read_constants();
  if (token_.is("precision")) return read_precision();
  if (token_.is("switch") || token_.is("discard") || token_.is("struct")) {
    refuse(token_.at, fmt::format("'{}' in a function is not read; expected if, for, while, return or an assignment",
                                  token_.text));
  }
  while (skip_precision()) {
  }
  if (at_type() && !next_.is("(")) {
    ShaderType type = read_type();
    read_array(type);
    return read_variables(type, false, take_name("a variable"));
  }
  read_simple_statement();
  expect(";");
}

void ShaderCompiler::read_simple_statement() {
  const double one = 1;
  const auto step = [&](const ShaderValue& target, ShaderToken sign) {
    sign.text = sign.text.substr(0, 1);
    const ShaderValue unit = constant(shader_scalar(Base::integer), {&one, 1}, sign.at);
    assign(target, arithmetic(sign, plain(target), unit));
  };
  do {
    const ShaderToken first = token_;
    if (first.is("++") || first.is("--")) {
      advance();
      step(read_postfix(), first);
      continue;
    }
    const ShaderValue value = read_expression();
    const ShaderToken sign = token_;
    if (sign.is("++") || sign.is("--")) {
      advance();
      step(value, sign);
    } else if (sign.kind == Kind::sign && sign.text.ends_with('=')) {
      read_assignment(value);
    }
  } while (accept(","));
}

void ShaderCompiler::read_assignment(const ShaderValue& target) {
  const Nesting nesting(*this);
  const ShaderToken sign = token_;
  constexpr std::array<std::string_view, 6> kSigns{"=", "+=", "-=", "*=", "/=", "%="};
  if (std::ranges::find(kSigns, sign.text) == kSigns.end()) refuse_here("an assignment or ';'");
  if (!target.is_place) refuse(target.at, "this cannot be assigned to; expected a variable that is not constant");
  advance();
  ShaderValue value = read_expression();
  if (token_.is("=")) read_assignment(value);
  if (sign.is("=")) return assign(target, value);
  ShaderToken operation = sign;
  operation.text = sign.text.substr(0, 1);
  assign(target, arithmetic(operation, plain(target), plain(value)));
}

std::uint32_t ShaderCompiler::read_condition() {
  ShaderValue condition = read_expression();
  if (!condition.type.is_truth()) {
    refuse(condition.at, fmt::format("the condition is {}; expected bool", name_of(condition.type)));
  }
  condition = plain(condition);
  const std::uint32_t jump = code_.here();
  code_.emit({.op = Op::jump_if_false, .a = condition.slot, .at = condition.at});
  return jump;
}

void ShaderCompiler::read_if() {
  advance();
  expect("(");
  const std::uint32_t to_else = read_condition();
  expect(")");
  const auto read_branch = [&] {
    scopes_.emplace_back();
    read_statement();
    scopes_.pop_back();
  };
  read_branch();
  if (!token_.is("else")) return code_.lead_here(to_else);
  const std::uint32_t to_end = code_.here();
  code_.emit({.op = Op::jump, .at = token_.at});
  advance();
  code_.lead_here(to_else);
  read_branch();
  code_.lead_here(to_end);
}

void ShaderCompiler::end_loop(std::uint32_t continue_at) {
  for (const std::uint32_t jump : loops_.back().breaks) code_.lead_here(jump);
  for (const std::uint32_t jump : loops_.back().continues) code_.lead(jump, continue_at);
  loops_.pop_back();
  scopes_.pop_back();
}

void ShaderCompiler::read_for() {
  const ShaderPlace at = token_.at;
  advance();
  expect("(");
  scopes_.emplace_back();
  loops_.emplace_back();
  if (at_type() && !next_.is("(")) {
    const ShaderType type = read_type();
    read_variables(type, false, take_name("a variable"));
  } else if (!accept(";")) {
    read_simple_statement();
    expect(";");
  }
  const std::uint32_t condition = code_.here();
  if (!token_.is(";")) loops_.back().breaks.push_back(read_condition());
  expect(";");
  const std::uint32_t to_body = code_.here();
  code_.emit({.op = Op::jump, .at = at});
  const std::uint32_t step = code_.here();
  if (!token_.is(")")) read_simple_statement();
  expect(")");
  code_.emit({.op = Op::jump, .dst = condition, .at = at});
  code_.lead_here(to_body);
  read_statement();
  code_.emit({.op = Op::jump, .dst = step, .at = at});
  end_loop(step);
}

void ShaderCompiler::read_while() {
  const ShaderPlace at = token_.at;
  advance();
  scopes_.emplace_back();
  loops_.emplace_back();
  const std::uint32_t begin = code_.here();
  expect("(");
  loops_.back().breaks.push_back(read_condition());
  expect(")");
  read_statement();
  code_.emit({.op = Op::jump, .dst = begin, .at = at});
  end_loop(begin);
}

void ShaderCompiler::read_do() {
  const ShaderPlace at = token_.at;
  advance();
  scopes_.emplace_back();
  loops_.emplace_back();
  const std::uint32_t begin = code_.here();
  read_statement();
  const std::uint32_t condition = code_.here();
  if (!accept("while")) refuse_here("'while'");
  expect("(");
  loops_.back().breaks.push_back(read_condition());
  expect(")");
  code_.emit({.op = Op::jump, .dst = begin, .at = at});
  expect(";");
  end_loop(condition);
}

void ShaderCompiler::read_return() {
  const ShaderPlace at = token_.at;
  advance();
  const Function& function = functions_[*current_];
  const ShaderType type = function.type;
  const std::uint32_t result = function.result;
  if (type.base != Base::nothing) {
    const ShaderValue value = as(read_expression(), type, "what is returned");
    code_.emit({.op = Op::copy, .n = slots_of(type), .dst = result, .a = value.slot, .at = at});
  }
  expect(";");
  code_.emit({.op = Op::give_back, .at = at});
}

void ShaderCompiler::read_jump(bool is_break) {
  if (loops_.empty()) refuse(token_.at, fmt::format("'{}' outside a loop; expected one around it", token_.text));
  (is_break ? loops_.back().breaks : loops_.back().continues).push_back(code_.here());
  code_.emit({.op = Op::jump, .at = token_.at});
  advance();
  expect(";");
}

// --- The end.

void ShaderCompiler::require_uniforms() const {
  for (const UniformValue& given : options_.uniforms) {
    if (std::ranges::find(uniform_names_, given.name) != uniform_names_.end()) continue;
    throw ArgumentError(fmt::format("'{}' has no uniform '{}'{}", file_.stem(), excerpt(given.name),
                                    uniform_names_.empty() ? "; it has none" : suggestion(given.name, uniform_names_)));
  }
  if (missing_.empty()) return;
  std::vector<std::string> names;
  for (const ShaderToken& name : missing_) {
    if (names.size() == 8) {
      names.emplace_back("...");
      break;
    }
    names.push_back(excerpt(name.text));
  }
  refuse(missing_.front().at, fmt::format("no value of the uniform{} {}; expected a value for each",
                                          names.size() == 1 ? "" : "s", fmt::join(names, ", ")));
}

std::size_t ShaderCompiler::deepest_calls(std::size_t function, std::vector<std::size_t>& depths,
                                          std::vector<bool>& is_open) const {
  if (depths[function] > 0) return depths[function];
  is_open[function] = true;
  std::size_t deepest = 0;
  for (const auto& [called, at] : functions_[function].calls) {
    if (!functions_[called].is_defined) {
      refuse(at, fmt::format("function '{}' has no body; expected one", excerpt(functions_[called].name)));
    }
    if (is_open[called]) {
      refuse(at, fmt::format("function '{}' calls itself, at last; expected no recursion",
                             excerpt(functions_[called].name)));
    }
    deepest = std::max(deepest, deepest_calls(called, depths, is_open));
  }
  is_open[function] = false;
  return depths[function] = deepest + 1;
}

void ShaderCompiler::require_calls() const {
  std::vector<std::size_t> depths(functions_.size(), 0);
  std::vector<bool> is_open(functions_.size(), false);
  for (std::size_t k = 0; k < functions_.size(); ++k) (void)deepest_calls(k, depths, is_open);
}

std::optional<std::vector<std::uint32_t>> ShaderCompiler::roles_of(const Function& function) {
  const auto count = static_cast<std::uint32_t>(function.parameters.size());
  const ShaderType vec3 = shader_vector(Base::real, 3);
  const bool has_shape = function.is_defined && (function.type == shader_scalar(Base::real) || function.type == vec3) &&
                         (count == 2 || count == 3 || count == kRoles) &&
                         std::ranges::all_of(function.parameters, [&](const Parameter& one) {
                           return one.type == vec3 && one.direction == Direction::in;
                         });
  if (!has_shape) return std::nullopt;
  std::vector<std::uint32_t> roles(count, kRoles);
  std::vector<bool> is_taken(kRoles, false);
  for (std::uint32_t k = 0; k < count; ++k) {
    const auto role = role_of(function.parameters[k].name);
    if (!role || (*role >= kAxes && count < kRoles)) continue;
    if (*role >= count || is_taken[*role]) return std::nullopt;
    roles[k] = *role;
    is_taken[*role] = true;
  }
  for (std::uint32_t& role : roles) {
    if (role != kRoles) continue;
    role = static_cast<std::uint32_t>(std::ranges::find(is_taken, false) - is_taken.begin());
    is_taken[role] = true;
  }
  return roles;
}

std::size_t ShaderCompiler::choose_function(CompiledShader& made) const {
  constexpr std::string_view kExpected =
      "expected float or vec3 NAME(vec3 light, vec3 view), perhaps with the normal and both tangents behind";
  std::optional<std::size_t> chosen;
  std::vector<std::string_view> names;
  bool is_named = false;
  for (std::size_t k = 0; k < functions_.size(); ++k) {
    const bool is_wanted = options_.entry.empty() || functions_[k].name == options_.entry;
    is_named = is_named || (is_wanted && !options_.entry.empty());
    if (!roles_of(functions_[k])) continue;
    names.push_back(functions_[k].name);
    if (!is_wanted) continue;
    chosen = k;
    ++made.candidates;
  }
  if (chosen) return *chosen;
  if (options_.entry.empty()) {
    refuse(functions_.empty() ? token_.at : functions_.back().at,
           fmt::format("no function of two directions; {}", kExpected));
  }
  if (is_named) {
    throw ArgumentError(fmt::format("function '{}' of '{}' is none of two directions; {}", excerpt(options_.entry),
                                    file_.stem(), kExpected));
  }
  throw ArgumentError(fmt::format("'{}' has no function '{}'{}", file_.stem(), excerpt(options_.entry),
                                  names.empty() ? fmt::format("; {}", kExpected) : suggestion(options_.entry, names)));
}

void ShaderCompiler::write_entry(std::size_t index, CompiledShader& made) {
  const Function& function = functions_[index];
  const auto roles = *roles_of(function);
  code_.go_to(Block::reset);
  const std::uint32_t inputs = code_.take_slots(3 * kRoles, function.at);
  for (std::size_t k = 0; k < roles.size(); ++k) {
    const Parameter& parameter = function.parameters[k];
    code_.emit({.op = Op::copy, .n = 3, .dst = parameter.slot, .a = inputs + 3 * roles[k], .at = function.at});
    if (roles[k] == 0) made.light = parameter.name;
    if (roles[k] == 1) made.view = parameter.name;
  }
  code_.emit({.op = Op::call, .dst = static_cast<std::uint32_t>(index), .at = function.at});
  code_.emit({.op = Op::halt, .at = function.at});
  std::vector<std::uint32_t> entries;
  for (const Function& one : functions_) entries.push_back(one.entry);
  made.program = code_.link(entries);
  made.program.deepest = functions_.size();
  made.program.inputs = inputs;
  made.program.result = function.result;
  made.program.channels = function.type.size();
  made.function = function.name;
  made.uniforms = uniforms_;
  run_setup(made.program);
}

void ShaderCompiler::run_setup(ShaderProgram& program) const {
  const ShaderOutcome outcome = run_shader(program, program.slots, program.setup);
  if (outcome.end != ShaderEnd::normal) {
    refuse(outcome.at, fmt::format("{}; expected constants that can be computed", shader_end_text(outcome.end)));
  }
}

}  // namespace lobe
