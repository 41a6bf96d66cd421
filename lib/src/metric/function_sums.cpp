// Sums over slabs for products of functions, and the errors of these.
#include "metric/function_sums.hpp"

#include <cmath>

#include "metric/function_values.hpp"

namespace lobe {
namespace {

/// Products of a channel with their errors, from sums at two levels and the functions' own errors.
class Products {
 public:
  explicit Products(std::size_t functions) : sums_(functions) {}

  /// Adds a slab at successive levels, at least two.
  void add(std::span<const FunctionSums> levels, std::size_t channel) {
    std::vector<Eigen::MatrixXd> grams;
    std::vector<Eigen::MatrixXd> distances;
    for (const FunctionSums& level : levels) {
      grams.push_back(level.gram[channel]);
      distances.push_back(squared_distances(grams.back()));
    }
    ChannelProducts& products = sums_.products;
    products.gram += grams.back();
    products.gram_error += error_of_levels(grams);
    products.squared_distance += distances.back();
    products.squared_distance_error += error_of_levels(distances);
    sums_.square_error += levels.back().square_error[channel];
  }

  [[nodiscard]] ChannelProducts finished() const {
    FunctionProducts sums = sums_;
    add_common_share(sums.products);
    return with_own_errors(std::move(sums));
  }

 private:
  /// Two levels may agree by accident in single entries: no product is better known, relatively, than both norms.
  static void add_common_share(ChannelProducts& products) {
    const Eigen::ArrayXd squares = products.gram.diagonal().array();
    const Eigen::ArrayXd own = (squares > 0).select(products.gram_error.diagonal().array() / squares, 0.0);
    const Eigen::Index n = own.size();
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index j = 0; j < n; ++j) {
        const double share = std::max(own(i), own(j));
        products.gram_error(i, j) += share * std::abs(products.gram(i, j));
        products.squared_distance_error(i, j) += share * std::max(products.squared_distance(i, j), 0.0);
      }
    }
  }

  static Eigen::MatrixXd squared_distances(const Eigen::MatrixXd& gram) {
    const Eigen::VectorXd squares = gram.diagonal();
    return squares.replicate(1, gram.cols()) + squares.transpose().replicate(gram.rows(), 1) - 2 * gram;
  }

  FunctionProducts sums_;
};

/// Error estimates of f.f relative to it, of a slab's share: functions of all channels, one after the other.
Eigen::VectorXd relative_errors(const FunctionLevels& slab, const Eigen::VectorXd& squares) {
  Eigen::VectorXd errors(squares.size());
  Eigen::Index at = 0;
  for (std::size_t c = 0; c < slab.back().gram.size(); ++c) {
    std::vector<Eigen::MatrixXd> diagonals;
    for (const FunctionSums& level : slab) diagonals.emplace_back(level.gram[c].diagonal());
    const Eigen::VectorXd error = error_of_levels(diagonals);
    errors.segment(at, error.size()) = error;
    at += error.size();
  }
  return (squares.array() > 0).select(errors.array() / squares.array(), 0.0);
}

}  // namespace

FunctionSums::FunctionSums(std::size_t channels, std::size_t functions) {
  const auto n = static_cast<Eigen::Index>(functions);
  gram.assign(channels, Eigen::MatrixXd::Zero(n, n));
  square_error.assign(channels, Eigen::VectorXd::Zero(n));
}

FunctionColumns::FunctionColumns(std::span<const BrdfFunction> functions, Eigen::Index rows) {
  const auto n = static_cast<Eigen::Index>(functions.size());
  mean_ = Eigen::MatrixXd::Zero(rows, n);
  mean_error_ = Eigen::MatrixXd::Zero(rows, n);
  for (std::size_t f = 0; f < functions.size(); ++f) {
    if (functions[f].is_isotropic) continue;
    anisotropic_.push_back(static_cast<Eigen::Index>(f));
    turned_.emplace_back(Eigen::MatrixXd::Zero(rows, static_cast<Eigen::Index>(kFunctionAzimuths)));
  }
}

void FunctionColumns::set(std::size_t function, const Eigen::MatrixXd& value, const Eigen::MatrixXd& error) {
  const auto f = static_cast<Eigen::Index>(function);
  mean_.col(f) = value.rowwise().mean();
  mean_error_.col(f) = error.cwiseAbs2().rowwise().mean().cwiseSqrt();
  const auto found = std::ranges::find(anisotropic_, f);
  if (found != anisotropic_.end()) turned_[static_cast<std::size_t>(found - anisotropic_.begin())] = value;
}

void FunctionColumns::add_to(Eigen::MatrixXd& gram, Eigen::VectorXd& square_error) const {
  Eigen::MatrixXd products = mean_.transpose() * mean_;
  for (std::size_t a = 0; a < anisotropic_.size(); ++a) {
    for (std::size_t b = 0; b < anisotropic_.size(); ++b) {
      products(anisotropic_[a], anisotropic_[b]) =
          turned_[a].cwiseProduct(turned_[b]).sum() / static_cast<double>(kFunctionAzimuths);
    }
  }
  gram += products;
  square_error += mean_error_.cwiseAbs2().colwise().sum().transpose();
}

std::vector<FunctionLevels> refined_slabs(std::size_t slabs, std::size_t levels, double tolerance,
                                          const SlabIntegrator& evaluate) {
  std::vector<FunctionLevels> all(slabs);
  Eigen::VectorXd squares;
  for (std::size_t slab = 0; slab < slabs; ++slab) {
    for (const std::size_t level : {0U, 1U}) all[slab].push_back(evaluate(slab, level));
    Eigen::VectorXd own(static_cast<Eigen::Index>(all[slab][1].gram.size()) * all[slab][1].gram[0].rows());
    for (std::size_t c = 0; c < all[slab][1].gram.size(); ++c) {
      const Eigen::MatrixXd& gram = all[slab][1].gram[c];
      own.segment(static_cast<Eigen::Index>(c) * gram.rows(), gram.rows()) = gram.diagonal();
    }
    squares = slab == 0 ? own : Eigen::VectorXd(squares + own);
  }
  Eigen::MatrixXd errors(squares.size(), static_cast<Eigen::Index>(slabs));
  for (std::size_t slab = 0; slab < slabs; ++slab) {
    errors.col(static_cast<Eigen::Index>(slab)) = relative_errors(all[slab], squares);
  }
  Eigen::VectorXd can_improve = Eigen::VectorXd::Ones(squares.size());
  for (;;) {
    Eigen::Index worst = 0;
    if (errors.rowwise().sum().cwiseProduct(can_improve).maxCoeff(&worst) <= tolerance) return all;
    std::size_t next = slabs;
    for (std::size_t slab = 0; slab < slabs; ++slab) {
      if (all[slab].size() == levels) continue;
      const auto error = [&](std::size_t k) { return errors(worst, static_cast<Eigen::Index>(k)); };
      if (next == slabs || error(slab) > error(next)) next = slab;
    }
    // No use in refining what is not to blame.
    constexpr double kBlame = 1e-2;
    if (next == slabs || errors(worst, static_cast<Eigen::Index>(next)) <= kBlame * tolerance) {
      can_improve(worst) = 0;
      continue;
    }
    all[next].push_back(evaluate(next, all[next].size()));
    errors.col(static_cast<Eigen::Index>(next)) = relative_errors(all[next], squares);
  }
}

ChannelProducts finished_products(const std::vector<FunctionLevels>& slabs, std::size_t functions,
                                  std::size_t channel) {
  Products products(functions);
  for (const FunctionLevels& slab : slabs) products.add(slab, channel);
  return products.finished();
}

Eigen::MatrixXd channel_rows(const Eigen::MatrixXd& values, std::size_t channel, std::size_t azimuths) {
  const Eigen::Index column = values.cols() == 1 ? 0 : static_cast<Eigen::Index>(channel);
  const auto width = static_cast<Eigen::Index>(azimuths);
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  return Eigen::Map<const Rows>(values.col(column).data(), values.rows() / width, width);
}

}  // namespace lobe
