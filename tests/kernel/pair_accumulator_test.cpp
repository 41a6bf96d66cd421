#include "device/accumulate_pairs.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <ostream>
#include <string>
#include <vector>

#include "device/evaluate_lobes.hpp"
#include "hemisphere/geometry.hpp"
#include "support/device.hpp"
#include "support/names.hpp"

namespace lobe::test {
namespace {

using Mix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

constexpr std::size_t kPasses = 1100;  // nodes of more than one pass
constexpr std::size_t kFewNodes = 60;
constexpr Eigen::Index kRows = 11;  // more than one pack, and not a whole one
constexpr Eigen::Index kLobes = 3;

struct Case {
  std::string name;
  NodeMap map;
  PairTerm term;
  double tolerance;  ///< relative
};

std::ostream& operator<<(std::ostream& out, const Case& c) {
  return out << c.name;
}

// Sums of a thousand terms; powers are taken in single precision (kernels/products/accumulate_pairs.cl).
constexpr double kRounding = 1e-13;
constexpr double kCubeRoot = 2e-7;

class PairSums : public ::testing::TestWithParam<Case> {
 protected:
  explicit PairSums(std::size_t nodes = kPasses)
      : evaluator_(device(), {{{.model = "phong"}, {{1, 2}, {3, 20}, {10, 300}}}}, Precision::double_precision, nodes) {
    NodeBlock block(nodes);
    for (std::size_t k = 0; k < nodes; ++k) {
      const double t = static_cast<double>(k + 1) / static_cast<double>(nodes + 1);
      block.push(node_of_directions({1.5 * t, 0.2 + 1.2 * t, 3.1 - t}));
      scale_.push_back(0.5 + t);
      weight_.push_back(1e-3 * (2 - t));
    }
    evaluator_.evaluate(block);
    samples_ = read_values(evaluator_, nodes);
    for (int channel = 0; channel < 2; ++channel) {
      Mix mix(kRows, kLobes);
      for (Eigen::Index row = 0; row + 1 < kRows; ++row) {  // the last row is black
        mix.insert(row, row % kLobes) = 0.1 * static_cast<double>(row + 1 + channel);
        if (row % 2 == 0) mix.insert(row, (row + 1) % kLobes) = 0.3;
      }
      mix_.push_back(mix);
    }
  }

  [[nodiscard]] double mapped(const Eigen::MatrixXd& values, Eigen::Index row, std::size_t node) const {
    const double x = scale_[node] * values(row, static_cast<Eigen::Index>(node));
    return GetParam().map == NodeMap::log ? std::log(1 + x) : x;
  }

  [[nodiscard]] double expected(int channel, Eigen::Index i, Eigen::Index j) const {
    const Eigen::MatrixXd values = mix_[static_cast<std::size_t>(channel)] * samples_;
    double sum = 0;
    for (std::size_t node = 0; node < weight_.size(); ++node) {
      const double d = std::abs(mapped(values, i, node) - mapped(values, j, node));
      const double power = GetParam().term == PairTerm::square     ? 2
                           : GetParam().term == PairTerm::absolute ? 1
                                                                   : 2.0 / 3;
      sum += weight_[node] * std::pow(d, power);
    }
    return sum;
  }

  LobeEvaluator evaluator_;
  Eigen::MatrixXd samples_;
  std::vector<Mix> mix_;
  std::vector<double> scale_;
  std::vector<double> weight_;
};

class PairSumsOfFewNodes : public PairSums {
 protected:
  PairSumsOfFewNodes() : PairSums(kFewNodes) {}
};

const auto kCases = ::testing::Values(Case{"square", NodeMap::linear, PairTerm::square, kRounding},
                                      Case{"absolute", NodeMap::linear, PairTerm::absolute, kRounding},
                                      Case{"two_thirds", NodeMap::linear, PairTerm::two_thirds, kCubeRoot},
                                      Case{"square_of_logs", NodeMap::log, PairTerm::square, kRounding});
INSTANTIATE_TEST_SUITE_P(kernel, PairSums, kCases, ByName{});
INSTANTIATE_TEST_SUITE_P(kernel, PairSumsOfFewNodes, kCases, ByName{});

TEST_P(PairSums, AreThoseOfTheDifferencesOfMixtures) {
  PairAccumulator pairs(evaluator_, mix_, GetParam().map, GetParam().term);

  pairs.add(scale_, weight_);
  const auto sums = pairs.take();

  ASSERT_EQ(sums.size(), 2U);
  for (int channel = 0; channel < 2; ++channel) {
    SCOPED_TRACE(channel);
    const Eigen::MatrixXd& found = sums[static_cast<std::size_t>(channel)];
    ASSERT_EQ(found.rows(), kRows);
    EXPECT_EQ(found, Eigen::MatrixXd(found.transpose()));
    EXPECT_EQ(found.diagonal().cwiseAbs().maxCoeff(), 0);
    for (const auto& [i, j] : {std::pair{1, 0}, {10, 3}, {9, 8}, {10, 9}}) {
      const double wanted = expected(channel, i, j);
      EXPECT_NEAR(found(i, j), wanted, GetParam().tolerance * wanted) << "rows " << i << " and " << j;
    }
  }
}

TEST_P(PairSumsOfFewNodes, AddUpUntilTaken) {
  PairAccumulator pairs(evaluator_, mix_, GetParam().map, GetParam().term);

  pairs.add(scale_, weight_);
  const double once = pairs.take()[0](1, 0);
  pairs.add(scale_, weight_);
  pairs.add(scale_, weight_);

  EXPECT_NEAR(pairs.take()[0](1, 0), 2 * once, kRounding * once);
  EXPECT_EQ(pairs.take()[0].cwiseAbs().maxCoeff(), 0);
}

TEST_P(PairSumsOfFewNodes, HaveTheBitsOfAllPairsWhereRowsAreComparedWithOthersAlone) {
  PairAccumulator all(evaluator_, mix_, GetParam().map, GetParam().term);
  all.add(scale_, weight_);
  const auto expected = all.take();
  for (const Eigen::Index split : {1, 8, 9}) {  // ends of packs, and within one
    PairAccumulator some(evaluator_, mix_, GetParam().map, GetParam().term, static_cast<std::size_t>(split));
    some.add(scale_, weight_);
    const auto sums = some.take();
    ASSERT_EQ(sums.size(), expected.size()) << split;
    for (std::size_t channel = 0; channel < sums.size(); ++channel) {
      EXPECT_EQ(sums[channel], expected[channel].topRightCorner(split, kRows - split)) << split << ' ' << channel;
    }
    EXPECT_EQ(some.take().front().cwiseAbs().maxCoeff(), 0) << split;
  }
}

}  // namespace
}  // namespace lobe::test
