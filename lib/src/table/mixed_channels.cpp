#include "table/mixed_channels.hpp"

namespace lobe {
namespace {

template <typename Numbers>
Numbers mixed(const Numbers& numbers, const Eigen::MatrixXd& weights) {
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  if (numbers.empty()) return numbers;
  const auto length = static_cast<Eigen::Index>(numbers.size()) / weights.cols();
  Numbers result(static_cast<std::size_t>(weights.rows() * length));
  Eigen::Map<Rows>(result.data(), weights.rows(), length) =
      weights * Eigen::Map<const Rows>(numbers.data(), weights.cols(), length);
  return result;
}

}  // namespace

BrdfTable mixed_channels(BrdfTable table, const Eigen::MatrixXd& weights) {
  table.values = mixed(table.values, weights);
  table.mirror = mixed(table.mirror, weights);
  table.retro = mixed(table.retro, weights);
  table.error = mixed(table.error, weights.cwiseAbs());
  table.even_error = mixed(table.even_error, weights.cwiseAbs());
  table.odd_part = mixed(table.odd_part, weights.cwiseAbs());
  table.channels = static_cast<std::size_t>(weights.rows());
  table.channel_names.clear();
  table.source.clear();
  table.factors.clear();
  return table;
}

}  // namespace lobe
