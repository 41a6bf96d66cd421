#include "device/accumulate_differences.hpp"
#include "device/accumulate_gram.hpp"
#include "device/sum_segments.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <ostream>
#include <string>
#include <vector>

#include "hemisphere/geometry.hpp"
#include "support/device.hpp"
#include "support/error_budget.hpp"
#include "support/names.hpp"
#include "support/scale.hpp"

namespace lobe::test {
namespace {

struct Shape {
  std::string name;
  std::size_t lobes;
  std::size_t nodes;
};

std::ostream& operator<<(std::ostream& out, const Shape& shape) {
  return out << shape.name;
}

Shape shape(std::size_t lobes, std::size_t nodes) {
  return {std::to_string(lobes) + "_lobes_" + std::to_string(nodes) + "_nodes", lobes, nodes};
}

std::vector<LobeBatch> phong_lobes(std::size_t count) {
  LobeBatch batch{{.model = "phong"}, {}};
  for (std::size_t i = 0; i < count; ++i) {
    batch.coefficients.push_back({1.0 + static_cast<double>(i), 2.0 + static_cast<double>(i), 0, 0});
  }
  return {batch};
}

NodeBlock block_of(std::size_t nodes) {
  NodeBlock block(nodes);
  for (std::size_t i = 0; i < nodes; ++i) {
    const double t = static_cast<double>(i + 1) / static_cast<double>(nodes + 1);
    auto node = node_of_directions({1.5 * t, 0.2 + 1.2 * t, 3.1 - t});
    node[NodeBlock::factor] = 0.5 + t;
    block.push(node);
  }
  return block;
}

class Accumulators : public ::testing::TestWithParam<Shape> {
 protected:
  Accumulators()
      : block_(block_of(GetParam().nodes)),
        evaluator_(device(), phong_lobes(GetParam().lobes), Precision::double_precision, GetParam().nodes) {
    evaluator_.evaluate(block_);
    samples_ = read_values(evaluator_, GetParam().nodes);
  }

  Eigen::Index row(std::size_t lobe) const { return static_cast<Eigen::Index>(evaluator_.rows()[lobe]); }

  NodeBlock block_;
  LobeEvaluator evaluator_;
  Eigen::MatrixXd samples_;  ///< lobes x nodes
};

TEST_P(Accumulators, GramIsTheSumOfProductsOfSamples) {
  GramAccumulator accumulator(evaluator_, 0, evaluator_.padded_lobes());
  const Eigen::MatrixXd expected = 2 * samples_ * samples_.transpose();

  accumulator.add(GetParam().nodes);
  accumulator.add(GetParam().nodes);

  const auto gram = accumulator.take();
  for (std::size_t i = 0; i < GetParam().lobes; ++i) {
    for (std::size_t j = i; j < GetParam().lobes; ++j) {
      const double wanted = expected(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
      ASSERT_NEAR(gram(row(i), row(j)), wanted, 1e-14 * wanted) << "entry " << i << ", " << j;
    }
  }
}

TEST_P(Accumulators, GramStartsAgainAfterTake) {
  GramAccumulator accumulator(evaluator_, 0, evaluator_.padded_lobes());
  accumulator.add(GetParam().nodes);
  const auto first = accumulator.take();

  accumulator.add(GetParam().nodes);

  EXPECT_EQ(accumulator.take(), first);
}

TEST_P(Accumulators, DifferenceIsSquaredBeforeItIsSummed) {
  const std::size_t last = GetParam().lobes - 1;
  const std::vector<Combination> combinations{{{{evaluator_.rows()[0], 1.0}}},
                                              {{{evaluator_.rows()[0], 1.0}, {evaluator_.rows()[last], -1.0}}},
                                              {{{evaluator_.rows()[last], 1e-9}}}};
  DifferenceAccumulator accumulator(evaluator_, combinations);

  accumulator.add(GetParam().nodes);

  const auto sums = accumulator.take();
  const Eigen::VectorXd first = samples_.row(0);
  const Eigen::VectorXd other = samples_.row(static_cast<Eigen::Index>(last));
  ASSERT_EQ(sums.size(), 3U);
  EXPECT_NEAR(sums[0], first.squaredNorm(), 1e-14 * first.squaredNorm());
  EXPECT_NEAR(sums[1], (first - other).squaredNorm(), 1e-14 * (first - other).squaredNorm());
  EXPECT_NEAR(sums[2], 1e-18 * other.squaredNorm(), 1e-32 * other.squaredNorm());
}

TEST_P(Accumulators, SegmentsSumRunsOfNodes) {
  const auto nodes = static_cast<unsigned>(GetParam().nodes);
  SegmentAccumulator accumulator(evaluator_, 3);

  accumulator.add({0, nodes / 3, nodes}, 1);

  const auto sums = accumulator.take();
  const auto cut = static_cast<Eigen::Index>(nodes / 3);
  for (std::size_t i = 0; i < GetParam().lobes; ++i) {
    const Eigen::VectorXd lobe = samples_.row(static_cast<Eigen::Index>(i));
    const double head = lobe.head(cut).sum();
    const double tail = lobe.tail(lobe.size() - cut).sum();
    ASSERT_EQ(sums(row(i), 0), 0) << "lobe " << i;
    ASSERT_NEAR(sums(row(i), 1), head, 1e-14 * head) << "lobe " << i;
    ASSERT_NEAR(sums(row(i), 2), tail, 1e-14 * tail) << "lobe " << i;
  }
}

// Around a pack (8), a triple of packs (24) and a local tile (16), in lobes and in nodes; a prime.
INSTANTIATE_TEST_SUITE_P(device, Accumulators,
                         ::testing::Values(shape(1, 1), shape(7, 8), shape(8, 7), shape(9, 17), shape(16, 16),
                                           shape(24, 9), shape(25, 15), shape(49, 127)),
                         ByName{});

/// More row packs than a work-item owns (6), and more nodes than a block (512) or a pass (2048).
TEST(GramAccumulatorRows, AreSummedBeyondOneItemBlockAndPass) {
  if (small_scale()) GTEST_SKIP() << "a minute each on the instrumented runtime";
  for (const Shape& size : {shape(97, 513), shape(50, 2049)}) {
    SCOPED_TRACE(::testing::Message() << size.lobes << " lobes, " << size.nodes << " nodes");
    const NodeBlock block = block_of(size.nodes);
    LobeEvaluator evaluator(device(), phong_lobes(size.lobes), Precision::double_precision, size.nodes);
    evaluator.evaluate(block);
    const Eigen::MatrixXd samples = read_values(evaluator, size.nodes);
    const Eigen::MatrixXd expected = samples * samples.transpose();
    GramAccumulator accumulator(evaluator, 0, evaluator.padded_lobes());

    accumulator.add(size.nodes);

    const auto gram = accumulator.take();
    for (Eigen::Index i = 0; i < expected.rows(); ++i) {
      for (Eigen::Index j = i; j < expected.cols(); ++j) {
        ASSERT_NEAR(gram(i, j), expected(i, j), 1e-14 * expected(i, j)) << "entry " << i << ", " << j;
      }
    }
  }
}

TEST(GramAccumulatorRows, MayBeAPartOfAllRows) {
  const std::size_t nodes = 33;
  auto block = block_of(nodes);
  LobeEvaluator evaluator(device(), phong_lobes(40), Precision::double_precision, nodes);
  evaluator.evaluate(block);
  const Eigen::MatrixXd samples = read_values(evaluator, nodes);
  const std::size_t first = 16;
  GramAccumulator accumulator(evaluator, first, 16);

  accumulator.add(nodes);

  const auto gram = accumulator.take();
  const Eigen::MatrixXd expected = samples * samples.transpose();
  for (Eigen::Index i = 0; i < 16; ++i) {
    for (Eigen::Index j = i + 16; j < 40; ++j) {
      ASSERT_NEAR(gram(i, j), expected(i + 16, j), 1e-14 * expected(i + 16, j)) << "entry " << i << ", " << j;
    }
  }
}

}  // namespace
}  // namespace lobe::test
