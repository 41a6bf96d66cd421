#include "study/write/residual_hdf5.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace lobe {
namespace {

template <typename Matrix>
auto row_major(const Matrix& matrix) {
  std::vector<typename Matrix::Scalar> values;
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) values.push_back(matrix(i, j));
  }
  return values;
}

}  // namespace

void write_residuals(hid_t group, FamilyFit fit, const FamilyResiduals& residuals, const hdf5::Dataset& material,
                     const hdf5::Dataset& basis_family) {
  const hdf5::Dataset* const along[] = {&material, &basis_family};
  const bool is_linear = fit == FamilyFit::linear;
  const std::string name = is_linear ? "linear_residual" : "non_negative_residual";
  const std::string combination = is_linear ? "linear combination" : "linear combination without negative coefficients";
  const auto residual = hdf5::create_dataset(group, name, row_major(residuals.relative_residual), along);
  const std::string meaning = "distance of the material from the nearest " + combination +
                              " of the family's other materials, relative to the material's norm";
  hdf5::write_attributes(residual.id(),
                         {{"long_name", meaning}, {"units", "1"}, {"ancillary_variables", name + "_error"}});
  const auto error = hdf5::create_dataset(group, name + "_error", row_major(residuals.relative_residual_error), along);
  hdf5::write_attributes(error.id(), {{"long_name", "error estimates of these distances"}, {"units", "1"}});
  const std::string rank = is_linear ? "linear_rank" : "non_negative_rank";
  const Eigen::MatrixXi& ranks = residuals.rank;
  const auto dataset = hdf5::create_integer_dataset(group, rank, std::vector<std::int32_t>(row_major(ranks)), along);
  hdf5::write_attribute(dataset.id(), "long_name", "how many of the family's other materials are independent");
}

}  // namespace lobe
