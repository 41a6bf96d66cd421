#include "fuzz/fuzz_formula.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "core/text.hpp"
#include "lobe/core/error.hpp"
#include "model/formula.hpp"
#include "model/formula_tree.hpp"

namespace lobe::test {
namespace {

constexpr std::size_t kLongestComplaint = 600;

[[noreturn]] void fail(std::string_view what, std::string_view detail) {
  std::fprintf(stderr, "lobe_fuzz: formula: %.*s: %.*s\n", static_cast<int>(what.size()), what.data(),
               static_cast<int>(detail.size()), detail.data());
  std::abort();
}

/// "formula:LINE:COLUMN: what", in one line.
void expect_clear(std::string_view complaint) {
  if (complaint.size() > kLongestComplaint) fail("a complaint is too long", complaint);
  if (has_control_characters(complaint)) fail("a complaint has control characters", complaint);
  const auto parts = split(complaint, ':');
  const auto is_count = [](std::string_view text) {
    return !text.empty() && text.front() != '0' && text.find_first_not_of("0123456789") == std::string_view::npos;
  };
  if (parts.size() < 4 || parts[0] != "formula" || !is_count(parts[1]) || !is_count(parts[2])) {
    fail("a complaint without place", complaint);
  }
}

void expect_statements(const std::string& source) {
  constexpr std::string_view kSigns = " \n_(){},.;=+-*/<>!&|?:";
  const auto is_plain = [&](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           kSigns.find(c) != std::string_view::npos;
  };
  if (!std::ranges::all_of(source, is_plain)) fail("what is compiled has other characters", source);
  if (source.find("user_") != std::string::npos) fail("what is compiled has a name of the user", source);
  if (source.find("//") != std::string::npos || source.find("/*") != std::string::npos) fail("a comment", source);
}

}  // namespace

void fuzz_formula(std::string_view text) {
  Formula formula{.text = std::string(text), .parameters = {"user_n", "user_exp"}};
  FormulaTree tree;
  try {
    tree = read_formula_tree(formula);
  } catch (const ArgumentError& error) {
    expect_clear(error.what());
    return;
  }
  const std::string canonical = canonical_text(tree, formula.parameters);
  // Blanks and digits of exponents may make it longer than a formula may be.
  if (canonical.size() > kFormulaLength) return;
  const FormulaTree again = read_formula_tree({.text = canonical, .parameters = formula.parameters});
  if (!(again == tree)) fail("another tree", canonical);
  if (canonical_text(again, formula.parameters) != canonical) fail("another text", canonical);

  std::array<std::string, 2> all{formula.parameters[0], formula.parameters[1]};
  formula.parameters.clear();
  for (std::size_t k = 0; k < all.size(); ++k) {
    const auto is_use = [&](const FormulaPart& part) {
      return part.kind == FormulaPart::Kind::parameter && part.index == k;
    };
    if (std::ranges::any_of(tree.parts, is_use)) formula.parameters.push_back(all[k]);
  }
  require_valid(formula);
  expect_statements(formula_source(formula));
}

}  // namespace lobe::test
