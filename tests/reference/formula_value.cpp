#include "reference/formula_value.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "reference/fresnel.hpp"

namespace lobe::reference {
namespace {

using List = std::vector<double>;
using FormulaFunction = std::function<double(const List&)>;

double smoothstep(double from, double to, double x) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

/// By the definitions of OpenCL C 1.2, sections 6.12.2 and 6.12.4.
const std::map<std::string, FormulaFunction, std::less<>>& functions() {
  static const std::map<std::string, FormulaFunction, std::less<>> all{
      {"exp", [](const List& x) { return std::exp(x[0]); }},
      {"exp2", [](const List& x) { return std::exp2(x[0]); }},
      {"exp10", [](const List& x) { return std::pow(10.0, x[0]); }},
      {"expm1", [](const List& x) { return std::expm1(x[0]); }},
      {"log", [](const List& x) { return std::log(x[0]); }},
      {"log2", [](const List& x) { return std::log2(x[0]); }},
      {"log10", [](const List& x) { return std::log10(x[0]); }},
      {"log1p", [](const List& x) { return std::log1p(x[0]); }},
      {"pow", [](const List& x) { return std::pow(x[0], x[1]); }},
      {"powr", [](const List& x) { return std::pow(x[0], x[1]); }},
      {"sqrt", [](const List& x) { return std::sqrt(x[0]); }},
      {"rsqrt", [](const List& x) { return 1 / std::sqrt(x[0]); }},
      {"cbrt", [](const List& x) { return std::cbrt(x[0]); }},
      {"hypot", [](const List& x) { return std::hypot(x[0], x[1]); }},
      {"sin", [](const List& x) { return std::sin(x[0]); }},
      {"cos", [](const List& x) { return std::cos(x[0]); }},
      {"tan", [](const List& x) { return std::tan(x[0]); }},
      {"asin", [](const List& x) { return std::asin(x[0]); }},
      {"acos", [](const List& x) { return std::acos(x[0]); }},
      {"atan", [](const List& x) { return std::atan(x[0]); }},
      {"atan2", [](const List& x) { return std::atan2(x[0], x[1]); }},
      {"sinh", [](const List& x) { return std::sinh(x[0]); }},
      {"cosh", [](const List& x) { return std::cosh(x[0]); }},
      {"tanh", [](const List& x) { return std::tanh(x[0]); }},
      {"asinh", [](const List& x) { return std::asinh(x[0]); }},
      {"acosh", [](const List& x) { return std::acosh(x[0]); }},
      {"atanh", [](const List& x) { return std::atanh(x[0]); }},
      {"erf", [](const List& x) { return std::erf(x[0]); }},
      {"erfc", [](const List& x) { return std::erfc(x[0]); }},
      {"fabs", [](const List& x) { return std::fabs(x[0]); }},
      {"sign", [](const List& x) { return x[0] > 0   ? 1.0
                                          : x[0] < 0 ? -1.0
                                                     : x[0]; }},
      {"floor", [](const List& x) { return std::floor(x[0]); }},
      {"ceil", [](const List& x) { return std::ceil(x[0]); }},
      {"round", [](const List& x) { return std::round(x[0]); }},
      {"trunc", [](const List& x) { return std::trunc(x[0]); }},
      {"fmod", [](const List& x) { return std::fmod(x[0], x[1]); }},
      {"fmin", [](const List& x) { return std::fmin(x[0], x[1]); }},
      {"fmax", [](const List& x) { return std::fmax(x[0], x[1]); }},
      {"min", [](const List& x) { return std::min(x[0], x[1]); }},
      {"max", [](const List& x) { return std::max(x[0], x[1]); }},
      {"fdim", [](const List& x) { return std::fdim(x[0], x[1]); }},
      {"clamp", [](const List& x) { return std::min(std::max(x[0], x[1]), x[2]); }},
      {"mix", [](const List& x) { return x[0] + (x[1] - x[0]) * x[2]; }},
      {"step", [](const List& x) { return x[1] < x[0] ? 0.0 : 1.0; }},
      {"smoothstep", [](const List& x) { return smoothstep(x[0], x[1], x[2]); }},
      {"fma", [](const List& x) { return std::fma(x[0], x[1], x[2]); }},
      {"mad", [](const List& x) { return x[0] * x[1] + x[2]; }},
      {"radians", [](const List& x) { return x[0] * std::numbers::pi / 180; }},
      {"degrees", [](const List& x) { return x[0] * 180 / std::numbers::pi; }},
      {"fresnel", [](const List& x) { return static_cast<double>(fresnel(x[0], x[1], x[2])); }},
      {"where", [](const List& x) { return x[0] != 0 ? x[1] : x[2]; }}};
  return all;
}

/// Signs are "u-" and "u+", the beginning of a call is its name and "(".
int rank_of(const std::string& sign) {
  const std::map<std::string, int> ranks{{"||", 1}, {"&&", 2}, {"==", 3}, {"!=", 3}, {"<", 4},
                                         {"<=", 4}, {">", 4},  {">=", 4}, {"+", 5},  {"-", 5},
                                         {"*", 6},  {"/", 6},  {"u-", 7}, {"u+", 7}, {"u!", 7}};
  const auto found = ranks.find(sign);
  return found == ranks.end() ? 0 : found->second;
}

double applied(const std::string& sign, double a, double b) {
  if (sign == "||") return a != 0 || b != 0 ? 1 : 0;
  if (sign == "&&") return a != 0 && b != 0 ? 1 : 0;
  if (sign == "==") return a == b ? 1 : 0;
  if (sign == "!=") return a != b ? 1 : 0;
  if (sign == "<") return a < b ? 1 : 0;
  if (sign == "<=") return a <= b ? 1 : 0;
  if (sign == ">") return a > b ? 1 : 0;
  if (sign == ">=") return a >= b ? 1 : 0;
  if (sign == "+") return a + b;
  if (sign == "-") return a - b;
  if (sign == "*") return a * b;
  return a / b;
}

class Stacks {
 public:
  void put(double value) { values_.push_back(value); }
  void open(const std::string& sign) { signs_.push_back(sign); }
  void join(const std::string& sign) {
    while (!signs_.empty() && rank_of(signs_.back()) >= rank_of(sign)) reduce();
    signs_.push_back(sign);
  }
  void reduce() {
    const std::string sign = signs_.back();
    signs_.pop_back();
    const double b = take();
    if (sign == "u-") {
      put(-b);
    } else if (sign == "u+") {
      put(b);
    } else if (sign == "u!") {
      put(b == 0 ? 1 : 0);
    } else {
      const double a = take();
      put(applied(sign, a, b));
    }
  }
  /// Up to the last "(", which may be that of a call; a comma stands before the call's next argument.
  void reduce_inner() {
    while (!signs_.empty() && rank_of(signs_.back()) > 0) reduce();
    if (signs_.empty()) throw std::logic_error("a parenthesis is missing");
  }
  void separate() {
    reduce_inner();
    signs_.emplace_back(",");
  }
  void close() {
    std::size_t arguments = 1;
    for (reduce_inner(); signs_.back() == ","; reduce_inner()) {
      ++arguments;
      signs_.pop_back();
    }
    const std::string opening = signs_.back();
    signs_.pop_back();
    if (opening == "(") return;
    List list(arguments);
    for (std::size_t k = arguments; k > 0; --k) list[k - 1] = take();
    put(functions().at(opening.substr(0, opening.size() - 1))(list));
  }
  double result() {
    while (!signs_.empty()) reduce();
    const double value = take();
    if (!values_.empty()) throw std::logic_error("too many values");
    return value;
  }

 private:
  double take() {
    if (values_.empty()) throw std::logic_error("a value is missing");
    const double value = values_.back();
    values_.pop_back();
    return value;
  }
  List values_;
  std::vector<std::string> signs_;
};

}  // namespace

double formula_value(std::string_view text, const std::map<std::string, double, std::less<>>& names) {
  const std::string all(text);
  Stacks stacks;
  bool wants_value = true;
  for (std::size_t at = 0; at < all.size();) {
    const char c = all[at];
    if (std::isspace(static_cast<unsigned char>(c)) != 0) {
      ++at;
    } else if (std::isdigit(static_cast<unsigned char>(c)) != 0 || c == '.') {
      char* end = nullptr;
      stacks.put(std::strtod(all.c_str() + at, &end));
      at = static_cast<std::size_t>(end - all.c_str());
      wants_value = false;
    } else if (std::isalpha(static_cast<unsigned char>(c)) != 0) {
      std::size_t end = at;
      while (end < all.size() && (std::isalnum(static_cast<unsigned char>(all[end])) != 0 || all[end] == '_')) ++end;
      const std::string name = all.substr(at, end - at);
      while (end < all.size() && std::isspace(static_cast<unsigned char>(all[end])) != 0) ++end;
      wants_value = end < all.size() && all[end] == '(';
      if (wants_value) {
        stacks.open(name + "(");
        ++end;
      } else {
        stacks.put(names.at(name));
      }
      at = end;
    } else if (c == '(') {
      stacks.open("(");
      ++at;
    } else if (c == ')') {
      stacks.close();
      wants_value = false;
      ++at;
    } else if (c == ',') {
      stacks.separate();
      wants_value = true;
      ++at;
    } else if (wants_value) {
      stacks.open(std::string("u") + c);
      ++at;
    } else {
      const std::string pair = all.substr(at, 2);
      const std::string sign = rank_of(pair) > 0 ? pair : std::string(1, c);
      stacks.join(sign);
      at += sign.size();
      wants_value = true;
    }
  }
  return stacks.result();
}

}  // namespace lobe::reference
