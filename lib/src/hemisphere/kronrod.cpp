#include "hemisphere/kronrod.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include "hemisphere/gauss.hpp"

namespace lobe {
namespace {

/// Odd weights whose sums with the odd powers of all degrees but the highest they can have are 0.
std::vector<double> null_rule(const EmbeddedPair& pair) {
  const std::size_t count = pair.nodes.size();
  const auto half = static_cast<Eigen::Index>(count / 2);
  // One weight per two nodes; the outermost is 1.
  Eigen::MatrixXd powers(half - 1, half);
  for (Eigen::Index i = 0; i < half; ++i) {
    const double x = 1 - 2 * pair.nodes[static_cast<std::size_t>(i)];
    for (Eigen::Index k = 0; k + 1 < half; ++k) powers(k, i) = std::pow(x, static_cast<double>(2 * k + 1));
  }
  const Eigen::VectorXd rest = powers.rightCols(half - 1).partialPivLu().solve(-powers.col(0));
  std::vector<double> weights(count, 0);
  double square = 0;
  double wanted = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double difference = pair.weights[i] - pair.coarse_weights[i];
    wanted += difference * difference;
    const std::size_t mirrored = count - 1 - i;
    if (i == mirrored) continue;
    const std::size_t k = i < mirrored ? i : mirrored;
    const double size = k == 0 ? 1 : rest(static_cast<Eigen::Index>(k) - 1);
    weights[i] = i < mirrored ? size : -size;
    square += size * size;
  }
  for (double& weight : weights) weight *= std::sqrt(wanted / square);
  return weights;
}

/// Null rules of falling degree, rows, as large as the difference of both rules and orthogonal to each other: the
/// barycentric weights times powers of x sum to 0 with all polynomials but those of the highest degrees.
Eigen::MatrixXd null_rules(const EmbeddedPair& pair) {
  constexpr Eigen::Index kRules = 6;
  const auto count = static_cast<Eigen::Index>(pair.nodes.size());
  const Eigen::Map<const Eigen::RowVectorXd> at(pair.nodes.data(), count);
  const Eigen::Map<const Eigen::RowVectorXd> fine(pair.weights.data(), count);
  const Eigen::Map<const Eigen::RowVectorXd> coarse(pair.coarse_weights.data(), count);
  const double size = (fine - coarse).norm();
  Eigen::MatrixXd rules(kRules, count);
  rules.row(0).setOnes();
  for (Eigen::Index i = 0; i < count; ++i) {
    for (Eigen::Index j = 0; j < count; ++j) rules(0, i) /= j == i ? 1 : at(i) - at(j);
  }
  for (Eigen::Index k = 0; k < kRules; ++k) {
    if (k > 0) rules.row(k) = rules.row(k - 1).array() * (2 * at.array() - 1);
    for (int pass = 0; pass < 2; ++pass) {
      for (Eigen::Index j = 0; j < k; ++j) {
        rules.row(k) -= rules.row(k).dot(rules.row(j)) / (size * size) * rules.row(j);
      }
    }
    rules.row(k) *= size / rules.row(k).norm();
  }
  return rules;
}

/// The estimate of the error of a larger rule.
/// \param null_sums by falling degree
double error_of(const Eigen::Matrix<double, 6, 1>& null_sums, std::size_t nodes) {
  constexpr double kSlowest = 0.35;  // ratio from which on nothing is gained
  constexpr double kLeast = 0.1;     // of what the highest null rules give: a faint kink shows in these alone
  const double highest = std::hypot(null_sums(0), null_sums(1));
  if (highest == 0) return 0;
  const double lower = std::hypot(null_sums(2), null_sums(3));
  const double lowest = std::hypot(null_sums(4), null_sums(5));
  const double ratio = std::max(highest / lower, lower / lowest);
  if (!(ratio < kSlowest)) return highest;
  // Of 7, 11 and 15 nodes the highest degrees are 5, 9 and 13, and the larger rule is exact up to 11, 17 and 23: the
  // powers 3, 4 and 5 are at most those that the degrees in between fall by.
  const auto power = static_cast<int>(nodes / 4 + 2);
  return std::max(std::pow(ratio / kSlowest, power), kLeast) * highest;
}

/// \param at nodes on [0, 1] of [-1, 1], falling to the middle; weights theirs
EmbeddedPair make_pair_of(std::span<const double> at, std::span<const double> weights) {
  const std::size_t count = 2 * at.size() - 1;
  const GaussRule gauss = gauss_rule(static_cast<int>(count / 2));
  EmbeddedPair pair;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t mirrored = count - 1 - i;
    const std::size_t k = i < mirrored ? i : mirrored;
    pair.nodes.push_back((i < mirrored ? 1 - at[k] : 1 + at[k]) / 2);
    pair.weights.push_back(weights[k] / 2);
    pair.coarse_weights.push_back(i % 2 == 1 ? gauss.weights[i / 2] : 0);
  }
  pair.null_weights = null_rule(pair);
  const auto nodes = static_cast<Eigen::Index>(count);
  const Eigen::Map<const Eigen::ArrayXd> fine(pair.weights.data(), nodes);
  pair.relative_sums.setOnes(nodes, Eigen::NoChange);
  pair.relative_sums.rightCols(6) = (null_rules(pair).transpose().array().colwise() / fine).matrix();
  for (const double node : pair.nodes) {
    double weight = 1;
    for (const double other : pair.nodes) weight *= other == node ? 1 : other / (other - node);
    pair.end_weights.push_back(weight);
  }
  return pair;
}

}  // namespace

// Nodes and weights: Kronrod 1965.

Eigen::ArrayXd joint_difference(const Eigen::ArrayXd& difference, const Eigen::ArrayXd& null_sum) {
  return difference.binaryExpr(null_sum, [](double a, double b) { return std::hypot(a, b); });
}

PanelIntegrals integrate_panels(const EmbeddedPair& pair, const Eigen::ArrayXXd& terms, Eigen::Index stride) {
  const Eigen::Index channels = terms.rows();
  const Eigen::Index panels = terms.cols() / stride;
  PanelIntegrals result{Eigen::ArrayXXd(channels, panels), Eigen::ArrayXXd(channels, panels)};
  for (Eigen::Index c = 0; c < channels; ++c) {
    using Strides = Eigen::Stride<Eigen::Dynamic, Eigen::Dynamic>;
    const Eigen::Map<const Eigen::MatrixXd, Eigen::Unaligned, Strides> of_channel(
        terms.data() + c, pair.relative_sums.rows(), panels, Strides(stride * channels, channels));
    for (Eigen::Index panel = 0; panel < panels; ++panel) {
      // One by one, so that a panel does not depend on how many there are.
      const Eigen::Matrix<double, 7, 1> sums = pair.relative_sums.transpose().lazyProduct(of_channel.col(panel));
      result.value(c, panel) = sums(0);
      result.error(c, panel) = error_of(sums.tail<6>(), pair.nodes.size());
    }
  }
  return result;
}

const EmbeddedPair& short_pair() {
  static const EmbeddedPair pair = [] {
    constexpr std::array kAt{0.960491268708020283423507092629080, 0.774596669241483377035853079956480,
                             0.434243749346802558002071502844628, 0.0};
    constexpr std::array kWeights{0.104656226026467265193823857192073, 0.268488089868333440728569280666710,
                                  0.401397414775962222905051818618432, 0.450916538658474142345110087045571};
    return make_pair_of(kAt, kWeights);
  }();
  return pair;
}

const EmbeddedPair& middle_pair() {
  static const EmbeddedPair pair = [] {
    constexpr std::array kAt{0.984085360094842464496172934636139, 0.906179845938663992797626878299393,
                             0.754166726570849220440817166946116, 0.538469310105683091036314420700209,
                             0.279630413161783193413466522748976, 0.0};
    constexpr std::array kWeights{0.042582036751081832864509450847144, 0.115233316622473394024626845880573,
                                  0.186800796556492657467800026878486, 0.241040339228647586699942611326242,
                                  0.272849801912558922340993264484455, 0.282987417857491210755107166494120};
    return make_pair_of(kAt, kWeights);
  }();
  return pair;
}

const EmbeddedPair& long_pair() {
  static const EmbeddedPair pair = [] {
    constexpr std::array kAt{0.991455371120812639206854697526329, 0.949107912342758524526189684047851,
                             0.864864423359769072789712788640926, 0.741531185599394439863864773280788,
                             0.586087235467691130294144691693301, 0.405845151377397166906606412076961,
                             0.207784955007898467600689403773245, 0.0};
    constexpr std::array kWeights{0.022935322010529224963732008058970, 0.063092092629978553290700663189204,
                                  0.104790010322250183839876322541518, 0.140653259715525918745189590510238,
                                  0.169004726639267902826583426598550, 0.190350578064785409913256402421014,
                                  0.204432940075298892414161999234649, 0.209482141084727828012999174891714};
    return make_pair_of(kAt, kWeights);
  }();
  return pair;
}

const EmbeddedPair& pair_for(double tolerance) {
  constexpr double kRough = 5e-3;
  constexpr double kFine = 5e-5;
  if (tolerance >= kRough) return short_pair();
  return tolerance >= kFine ? middle_pair() : long_pair();
}

}  // namespace lobe
