#pragma once

/// The claims every model's kernel is held to; each model's test file instantiates them with its cases.

#include <gtest/gtest.h>

#include <functional>
#include <ostream>
#include <string>

#include "reference/models.hpp"
#include "support/names.hpp"

namespace lobe::test {

using reference::Real;
using reference::Vector;

struct ModelCase {
  std::string name;  ///< the material specification
  std::function<Real(const Vector& light, const Vector& view)> f;
  /// See support/error_budget.hpp.
  std::function<Real(const Vector& light, const Vector& view)> condition;
  double width = 1;  ///< angle (radians) over which the lobe falls off
  /// Largest value where the exact one may be 0 for want of an ulp in a cosine; none: 0 stays 0.
  std::function<Real(Real eps)> floor = {};
};

inline std::ostream& operator<<(std::ostream& out, const ModelCase& model) {
  return out << model.name;
}

class ModelKernel : public ::testing::TestWithParam<ModelCase> {};

/// Name of the model in a specification.
inline std::string model_of(const std::string& specification) {
  return specification.substr(0, specification.find(':'));
}

}  // namespace lobe::test
