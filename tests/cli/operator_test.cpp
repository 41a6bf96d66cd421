// The commands on operators: what they answer, what they leave, what they refuse.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "cli/command_test.hpp"
#include "lobe/hdf5/table_file.hpp"

namespace lobe::test {
namespace {

using cli::ExitCode;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const std::string kSmallOperator = "gauss:12x24";

class Operators : public CommandTest {
 protected:
  [[nodiscard]] BrdfTable table(const std::string& name) const { return load_table(file(name)); }
};

TEST_F(Operators, SpectrumOfLambertHasOneValue) {
  const Json answer = json({"spectrum", "lambert:scale=0.5", "--grid", kSmallOperator});

  EXPECT_EQ(answer["schema"], "lobe.spectrum/1");
  const Json& channel = answer["spectra"][0];
  EXPECT_NEAR(channel["norm"]["value"], 0.5, 1e-14);
  EXPECT_EQ(channel["numerical_rank"], 1);
  EXPECT_EQ(channel["orders"].size(), 13U);
  EXPECT_EQ(channel["orders"][3]["multiplicity"], 2);
}

TEST_F(Operators, SpectrumPrintsOrdersSumsAndWhatComposingLoses) {
  const auto outcome = make({"spectrum", "phong:n=5", "--grid", kSmallOperator, "--orders", "2", "--values", "1"});

  EXPECT_THAT(outcome.output, HasSubstr("eigenvalues (reciprocal"));
  EXPECT_THAT(outcome.output, HasSubstr("0.784578"));
  EXPECT_THAT(outcome.output, HasSubstr("-0.47873"));
  EXPECT_THAT(outcome.output, HasSubstr("components left"));
  EXPECT_THAT(outcome.error, IsEmpty());
}

TEST_F(Operators, SpectrumOfATableIsThatOfItsMaterial) {
  make({"tabulate", "blinn:n=5", "--grid", kSmallOperator, "-o", "a.h5"});

  EXPECT_EQ(json({"spectrum", "a.h5"})["spectra"],
            json({"spectrum", "blinn:n=5", "--grid", kSmallOperator})["spectra"]);
}

TEST_F(Operators, SpectrumOfAMixedOrderOfFactorsHasSingularValues) {
  make({"compose", "phong:n=5", "ward:m=0.5", "--grid", kSmallOperator, "-o", "c.h5"});
  const Json channel = json({"spectrum", "c.h5"})["spectra"][0];

  EXPECT_EQ(channel["is_self_adjoint"], false);
  EXPECT_FALSE(channel.contains("trace"));
  EXPECT_THAT(make({"spectrum", "c.h5"}).output, HasSubstr("singular values (not reciprocal"));
}

TEST_F(Operators, SquareRootOfASelfCompositionComposesBack) {
  make({"self-compose", "phong:n=5", "--grid", kSmallOperator, "-o", "square.h5"});
  const Json answer = json({"square-root", "square.h5", "-o", "root.h5"});
  make({"self-compose", "root.h5", "-o", "again.h5"});

  EXPECT_EQ(answer["expression"], "square-root(self_compose(phong:n=5, times=1))");
  EXPECT_NE(answer["roots"][0]["definiteness"], "indefinite");
  const auto square = table("square.h5").values;
  const auto again = table("again.h5").values;
  EXPECT_THAT(again, ::testing::Pointwise(::testing::DoubleNear(1e-12), square));
}

TEST_F(Operators, SquareRootOfAnIndefiniteMaterialSaysHowFarItIs) {
  const auto outcome = make({"square-root", "phong:n=5", "--grid", kSmallOperator});

  EXPECT_THAT(outcome.output, HasSubstr("no: it has negative eigenvalues"));
  EXPECT_THAT(outcome.output, HasSubstr("0.7283"));
  EXPECT_THAT(outcome.output, HasSubstr("root's least value"));
}

TEST_F(Operators, SquareRootRefusesTheMirrorAndWhatIsNotReciprocal) {
  make({"compose", "phong:n=5", "ward:m=0.5", "--grid", kSmallOperator, "-o", "c.h5"});

  expect_refusal({"square-root", "mirror", "--grid", kSmallOperator}, ExitCode::numeric, "no self-adjoint root");
  const Json root = json({"square-root", "c.h5"})["roots"][0];
  EXPECT_GT(root["skew"]["value"], 0);
  EXPECT_GT(root["distance"]["value"], root["skew"]["value"]);
}

TEST_F(Operators, SolveUndoesAComposition) {
  make({"tabulate", "blinn:n=5", "--grid", kSmallOperator, "-o", "blinn.h5"});
  make({"compose", "rrim:rho=0.8+phong:n=5,scale=0.2", "blinn.h5", "-o", "g.h5"});
  const Json answer = json({"solve", "rrim:rho=0.8+phong:n=5,scale=0.2", "g.h5", "-o", "x.h5"});

  EXPECT_EQ(answer["solutions"][0]["regularisation"], "none");
  EXPECT_LT(answer["solutions"][0]["relative_discrepancy"], 1e-14);
  const auto x = table("x.h5").values;
  const auto blinn = table("blinn.h5").values;
  EXPECT_THAT(x, ::testing::Pointwise(::testing::DoubleNear(1e-12), blinn));
}

TEST_F(Operators, SolveSaysHowItRegularised) {
  make({"compose", "phong:n=5", "blinn:n=5", "--grid", kSmallOperator, "-o", "g.h5"});

  EXPECT_THAT(make({"solve", "phong:n=5", "g.h5"}).output, HasSubstr("by the stated errors of F and G"));
  EXPECT_THAT(make({"solve", "phong:n=5", "g.h5", "--lambda", "0.01"}).output, HasSubstr("0.01, given"));
  expect_refusal({"solve", "phong:n=5", "g.h5", "--lambda", "-1"}, ExitCode::usage, "expected a number, 0 or more");
  expect_refusal({"solve", "phong:n=5", "mirror", "--grid", kSmallOperator}, ExitCode::numeric, "no X makes them");
}

}  // namespace
}  // namespace lobe::test
