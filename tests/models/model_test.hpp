#pragma once

/// What the tests know of a model: tests/models/<model>.cpp defines <model>_test(). The file has a reference of its
/// own, in plain C++ from the publication, or takes one of tests/reference/ that models share.

#include <functional>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "reference/models.hpp"
#include "support/error_budget.hpp"

namespace lobe::test {

using reference::Real;
using reference::Vector;

/// Values of parameters, and the reference for them.
struct ModelCase {
  std::string name;  ///< the material specification
  std::function<Real(const Vector& light, const Vector& view)> f;
  /// See support/error_budget.hpp.
  std::function<Real(const Vector& light, const Vector& view)> condition;
  double width = 1;  ///< angle (radians) over which the lobe falls off
  /// Largest value where the exact one may be 0 for want of an ulp in a cosine; none: 0 stays 0.
  std::function<Real(Real eps)> floor = {};
  ErrorBudget budget = {};  ///< that of the model
};

inline std::ostream& operator<<(std::ostream& out, const ModelCase& model) {
  return out << model.name;
}

/// A material whose albedo is above 1, where, and by how much.
struct AlbedoExcess {
  std::string material;
  double theta_deg;
  double albedo;
};

struct ModelTest {
  ErrorBudget budget;
  std::vector<ModelCase> cases;
  /// Of a model that does not conserve energy.
  std::optional<AlbedoExcess> excess = std::nullopt;
  std::string model = {};  ///< the name of the file
};

/// One for each file of tests/models, in alphabetical order.
[[nodiscard]] const std::vector<ModelTest>& model_tests();

/// \throws std::out_of_range for a model without one
[[nodiscard]] const ModelTest& model_test(const std::string& model);

}  // namespace lobe::test
