#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "lobe/table/brdf_function.hpp"
#include "metric/function_products.hpp"
#include "metric/products.hpp"

namespace lobe {

/// Sums of a quadrature: of products, functions x functions, and of squared errors, by channel.
struct FunctionSums {
  std::vector<Eigen::MatrixXd> gram;
  std::vector<Eigen::VectorXd> square_error;

  /// All 0.
  FunctionSums(std::size_t channels, std::size_t functions);
};

/// Values of functions at the rows of a rule: isotropic ones a column each, anisotropic ones a column per azimuth of L.
class FunctionColumns {
 public:
  FunctionColumns(std::span<const BrdfFunction> functions, Eigen::Index rows);

  /// Sets values and errors, rows x azimuths, times the root of each row's weight.
  void set(std::size_t function, const Eigen::MatrixXd& value, const Eigen::MatrixXd& error);

  /// Adds products and squared errors, summed over the rows and averaged over azimuths.
  void add_to(Eigen::MatrixXd& gram, Eigen::VectorXd& square_error) const;

 private:
  Eigen::MatrixXd mean_;
  Eigen::MatrixXd mean_error_;
  std::vector<Eigen::Index> anisotropic_;
  std::vector<Eigen::MatrixXd> turned_;
};

/// A slab's sums at the levels so far.
using FunctionLevels = std::vector<FunctionSums>;

/// The sums of one slab at one level.
using SlabIntegrator = std::function<FunctionSums(std::size_t slab, std::size_t level)>;

/// Integrates every slab at two levels and refines the slab that counts most in the worst of the norms, one after the
/// other, until the errors of all norms, relative, are below the tolerance or no slab has a finer level.
/// \param levels how many there are, at least two
[[nodiscard]] std::vector<FunctionLevels> refined_slabs(std::size_t slabs, std::size_t levels, double tolerance,
                                                        const SlabIntegrator& integrate);

/// Products of a channel with their errors, from all slabs and the functions' own errors.
[[nodiscard]] ChannelProducts finished_products(const std::vector<FunctionLevels>& slabs, std::size_t functions,
                                                std::size_t channel);

/// A channel of all rows of values, (row, azimuth) x channels, as rows x azimuths; a single channel serves all.
[[nodiscard]] Eigen::MatrixXd channel_rows(const Eigen::MatrixXd& values, std::size_t channel, std::size_t azimuths);

}  // namespace lobe
