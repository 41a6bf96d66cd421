#include <algorithm>
#include <stdexcept>

#include "models/model_test.hpp"

namespace lobe::test {

// A line LOBE_MODEL(<model>) for each file of tests/models (tests/CMakeLists.txt).
using MakeTest = ModelTest();
#define LOBE_MODEL(model) MakeTest model##_test;
#include "model_tests.inc"
#undef LOBE_MODEL

namespace {

ModelTest named(std::string model, ModelTest test) {
  test.model = std::move(model);
  for (ModelCase& one : test.cases) one.budget = test.budget;
  return test;
}

}  // namespace

const std::vector<ModelTest>& model_tests() {
  static const std::vector<ModelTest> tests{
#define LOBE_MODEL(model) named(#model, model##_test()),
#include "model_tests.inc"
#undef LOBE_MODEL
  };
  return tests;
}

const ModelTest& model_test(const std::string& model) {
  const auto found = std::ranges::find(model_tests(), model, &ModelTest::model);
  if (found == model_tests().end()) throw std::out_of_range("tests/models has no " + model + ".cpp");
  return *found;
}

}  // namespace lobe::test
