#include "formats/local_interpolation.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <nanoflann.hpp>
#include <utility>

#include "core/parallel.hpp"

namespace lobe {
namespace {

constexpr std::size_t kBlended = 5;

/// Points as nanoflann wants to see them.
struct Cloud {
  Eigen::MatrixXd points;

  [[nodiscard]] std::size_t kdtree_get_point_count() const { return static_cast<std::size_t>(points.cols()); }
  [[nodiscard]] double kdtree_get_pt(std::size_t index, std::size_t dimension) const {
    return points(static_cast<Eigen::Index>(dimension), static_cast<Eigen::Index>(index));
  }
  template <typename Box>
  [[nodiscard]] bool kdtree_get_bbox(Box& /*box*/) const {
    return false;
  }
};

using Search = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Cloud>, Cloud, -1, std::size_t>;

/// An index and the square of a distance.
#if NANOFLANN_VERSION < 0x150
using Found = std::pair<std::size_t, double>;
#else
using Found = nanoflann::ResultItem<std::size_t, double>;
#endif

/// Functions through some points.
struct Fit {
  std::vector<std::size_t> members;
  double radius = 1;             ///< distance of the farthest, to which distances are relative
  Eigen::VectorXd centre;        ///< which linear terms are relative to
  Eigen::MatrixXd coefficients;  ///< members, 1, dimensions x channels
  Eigen::RowVectorXd least;      ///< bounds of what counts, by channel
  Eigen::RowVectorXd most;
};

/// r^exponent of squared distances.
void raise(Eigen::ArrayXd& squares, double exponent) {
  squares = squares.sqrt();
  if (exponent == 1) return;
  const Eigen::ArrayXd root = squares.sqrt();
  squares *= exponent == 1.5 ? root : root * root.sqrt();
}

/// The functions that a point sees: of the members, 1, linear ones.
Eigen::VectorXd basis(const PointIndex& index, const LocalScheme& scheme, const Fit& fit, const double* point) {
  const Eigen::MatrixXd& points = index.points();
  const auto count = static_cast<Eigen::Index>(fit.members.size());
  const Eigen::Map<const Eigen::VectorXd> at(point, points.rows());
  Eigen::ArrayXd radial(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto member = static_cast<Eigen::Index>(fit.members[static_cast<std::size_t>(i)]);
    radial[i] = (points.col(member) - at).squaredNorm();
  }
  radial /= fit.radius * fit.radius;
  raise(radial, scheme.exponent);
  Eigen::VectorXd functions(count + 1 + points.rows());
  functions << -radial.matrix(), 1, (at - fit.centre) / fit.radius;
  return functions;
}

Fit fit_through(const PointIndex& index, const Eigen::MatrixXd& values, const LocalScheme& scheme, const double* centre,
                std::vector<std::size_t> members) {
  const Eigen::MatrixXd& points = index.points();
  const auto count = static_cast<Eigen::Index>(members.size());
  Fit fit;
  fit.centre = Eigen::Map<const Eigen::VectorXd>(centre, points.rows());
  Eigen::MatrixXd offsets(points.rows(), count);
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(count + 1, values.cols());
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto member = static_cast<Eigen::Index>(members[static_cast<std::size_t>(i)]);
    offsets.col(i) = points.col(member) - fit.centre;
    right.row(i) = values.row(member);
  }
  const double radius = std::sqrt(offsets.colwise().squaredNorm().maxCoeff());
  if (radius > 0) fit.radius = radius;
  offsets /= fit.radius;
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(count + 1, count + 1);
  for (Eigen::Index i = 0; i < count; ++i) {
    Eigen::ArrayXd column = (offsets.colwise() - offsets.col(i)).colwise().squaredNorm().transpose();
    raise(column, scheme.exponent);
    matrix.col(i).head(count) = -column.matrix();
  }
  matrix.topLeftCorner(count, count) += scheme.trend * offsets.transpose() * offsets;
  matrix.col(count).head(count).setOnes();
  matrix.row(count).head(count).setOnes();
  const Eigen::MatrixXd weights = matrix.partialPivLu().solve(right);
  fit.coefficients.resize(count + 1 + points.rows(), values.cols());
  fit.coefficients << weights, scheme.trend * offsets * weights.topRows(count);
  const auto inner = right.topRows(count);
  const Eigen::RowVectorXd margin = (LocalScheme::kBeyond * (inner.colwise().maxCoeff() - inner.colwise().minCoeff()))
                                        .cwiseMin(LocalScheme::kMostBeyond);
  fit.most = inner.colwise().maxCoeff() + margin;
  fit.least = (inner.colwise().minCoeff() - margin).cwiseMax(inner.colwise().minCoeff().cwiseMin(0.0));
  fit.members = std::move(members);
  return fit;
}

Eigen::RowVectorXd value_of(const PointIndex& index, const LocalScheme& scheme, const Fit& fit, const double* point) {
  const Eigen::RowVectorXd found = basis(index, scheme, fit, point).transpose() * fit.coefficients;
  return found.cwiseMax(fit.least).cwiseMin(fit.most);
}

}  // namespace

struct PointIndex::Tree {
  explicit Tree(Eigen::MatrixXd points)
      : cloud{std::move(points)}, search(static_cast<int>(cloud.points.rows()), cloud) {}

  Cloud cloud;
  Search search;
};

PointIndex::PointIndex(Eigen::MatrixXd points) : tree_(std::make_shared<const Tree>(std::move(points))) {}

const Eigen::MatrixXd& PointIndex::points() const {
  return tree_->cloud.points;
}

std::vector<PointIndex::Neighbour> PointIndex::nearest(const double* point, std::size_t count) const {
  std::vector<std::size_t> indices(std::min(count, size()));
  std::vector<double> squares(indices.size());
  const std::size_t found = tree_->search.knnSearch(point, indices.size(), indices.data(), squares.data());
  std::vector<Neighbour> neighbours;
  neighbours.reserve(found);
  for (std::size_t i = 0; i < found; ++i) neighbours.push_back({indices[i], std::sqrt(squares[i])});
  return neighbours;
}

std::vector<PointIndex::Neighbour> PointIndex::within(const double* point, double distance) const {
  std::vector<Found> found;
  tree_->search.radiusSearch(point, distance * distance, found, {});
  std::vector<Neighbour> neighbours;
  neighbours.reserve(found.size());
  for (const auto& [index, square] : found) neighbours.push_back({index, std::sqrt(square)});
  return neighbours;
}

Eigen::MatrixXd left_out(const PointIndex& index, const Eigen::MatrixXd& values, const LocalScheme& scheme,
                         std::span<const std::size_t> which, std::span<const double> radii) {
  constexpr std::size_t kLookedAt = 3;  // times the neighbours wanted
  Eigen::MatrixXd found(static_cast<Eigen::Index>(which.size()), values.cols());
  parallel_for(which.size(), [&](std::size_t i) {
    const double* point = index.points().col(static_cast<Eigen::Index>(which[i])).data();
    const double radius = radii[i];
    auto near = index.nearest(point, (radius > 0 ? kLookedAt : 1) * scheme.neighbours + 1);
    std::erase_if(near, [&](const auto& one) { return one.index == which[i]; });
    const std::size_t kept = std::min(near.size(), scheme.neighbours / 2);
    const auto most = near.end() - static_cast<std::ptrdiff_t>(kept);
    near.erase(near.begin(), std::find_if(near.begin(), most, [&](const auto& one) { return one.distance > radius; }));
    std::vector<std::size_t> members;
    for (std::size_t j = 0; j < std::min(near.size(), scheme.neighbours); ++j) members.push_back(near[j].index);
    const Fit fit = fit_through(index, values, scheme, point, std::move(members));
    found.row(static_cast<Eigen::Index>(i)) = value_of(index, scheme, fit, point);
  });
  return found;
}

struct LocalInterpolation::Patches {
  LocalScheme scheme;
  std::vector<Fit> fits;
};

LocalInterpolation::LocalInterpolation(PointIndex index, const Eigen::MatrixXd& values, const LocalScheme& scheme)
    : index_(std::move(index)) {
  auto patches = std::make_shared<Patches>(Patches{scheme, std::vector<Fit>(index_.size())});
  parallel_for(index_.size(), [&](std::size_t i) {
    const double* point = index_.points().col(static_cast<Eigen::Index>(i)).data();
    std::vector<std::size_t> members;
    for (const auto& one : index_.nearest(point, scheme.neighbours)) members.push_back(one.index);
    patches->fits[i] = fit_through(index_, values, scheme, point, std::move(members));
  });
  patches_ = std::move(patches);
}

std::vector<LocalInterpolation::Share> LocalInterpolation::blend(const double* point) const {
  const auto near = index_.nearest(point, kBlended + 1);
  // Where all of them lie at one distance, all count the same.
  const double reach = near.back().distance * (1 + 1e-6);
  const std::size_t count = std::min(near.size(), kBlended);
  std::vector<Share> shares;
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double distance = std::max(near[i].distance, 1e-12 * reach);
    const double weight = reach > 0 ? std::pow((reach - distance) / (reach * distance), 2) : 1;
    shares.push_back({near[i].index, weight, near[i].distance});
    sum += weight;
  }
  for (Share& share : shares) share.weight /= sum;
  return shares;
}

Eigen::Index LocalInterpolation::channels() const {
  return patches_->fits.front().coefficients.cols();
}

Eigen::RowVectorXd LocalInterpolation::value(const double* point, std::span<const Share> blend) const {
  Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(channels());
  for (const Share& share : blend) {
    sum += share.weight * value_of(index_, patches_->scheme, patches_->fits[share.index], point);
  }
  return sum;
}

Eigen::RowVectorXd LocalInterpolation::largest(std::span<const Share> blend) const {
  Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(channels());
  for (const Share& share : blend) {
    const Fit& fit = patches_->fits[share.index];
    sum += share.weight * fit.least.cwiseAbs().cwiseMax(fit.most.cwiseAbs());
  }
  return sum;
}

}  // namespace lobe
