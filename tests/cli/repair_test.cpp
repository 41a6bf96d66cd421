// The commands that repair reflectances, and mean-albedo: what they print, what they leave, what they refuse.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "cli/command_test.hpp"
#include "lobe/hdf5/table_file.hpp"

namespace lobe::test {
namespace {

using cli::ExitCode;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const std::string kSmallRepair = "gauss:12x24";

class Repair : public CommandTest {};

TEST_F(Repair, PumpsAMaterialAndPrintsHowToWriteIt) {
  const auto outcome = make({"pump", "phong:n=5", "--correction", "controlled", "--times", "2", "--theta", "0,75"});

  EXPECT_THAT(outcome.output, HasSubstr("step 2"));
  EXPECT_THAT(outcome.output, HasSubstr("mirror radiance"));
  EXPECT_THAT(outcome.output, HasSubstr("specification  phong:n=5@pump:correction=controlled,times=2"));
  const Json json = this->json({"pump", "phong:n=5", "--correction", "controlled", "--times", "2", "--theta", "75"});
  const Json direct = this->json({"albedo", "phong:n=5@pump:correction=controlled,times=2", "--theta", "75"});
  EXPECT_NEAR(json["curves"]["steps"][2]["albedo"][0][0]["value"].get<double>(),
              direct["albedos"][0]["albedo"][0]["value"].get<double>(), 1e-6);
}

// After a step the albedos of these have kinks, around which a curve has parts of its own.
TEST_F(Repair, PumpsPastKinks) {
  for (const char* const specification : {"ward:m=0.05@pump:times=2", "ward:m=0.2@pump:correction=g2,times=2"}) {
    const Json json = this->json({"albedo", specification, "--theta", "45"});
    const Json albedo = json["albedos"][0]["albedo"][0];
    EXPECT_GT(albedo["value"].get<double>(), 0.97) << specification;
    EXPECT_LE(albedo["value"].get<double>(), 1) << specification;
    EXPECT_LE(albedo["error"].get<double>(), 1e-6) << specification;
  }
  // The next program reads what they are.
  make({"tabulate", "cook_torrance:m=0.5@pump:correction=g2", "--grid", kSmallRepair, "-o", "kinked.h5"});
  const Json table = this->json({"norm", file("kinked.h5")})["norm"];
  const Json formula = this->json({"norm", "cook_torrance:m=0.5@pump:correction=g2"})["norm"];
  EXPECT_NEAR(table["value"].get<double>(), formula["value"].get<double>(),
              table["error"].get<double>() + formula["error"].get<double>());
}

// They were refused where the albedos of the first step have a kink.
TEST_F(Repair, PumpsTwiceByTheAlbedosOfTheFirstStep) {
  const auto value = [&](const std::string& specification) {
    const Json answer =
        this->json({"eval", specification, "--theta-in", "30", "--theta-out", "63", "--delta-phi", "180"});
    return answer["values"][0]["brdf"][0].get<double>();
  };
  const Json once = this->json({"albedo", "ward:m=0.2@pump:times=1", "--theta", "30,63"})["albedos"];
  const Json larger = once[0]["albedo"][0];
  ASSERT_GT(larger["value"].get<double>(), once[1]["albedo"][0]["value"].get<double>());
  // f / max(a(L), a(V)); albedos of steps may be off by 2e-6.
  EXPECT_NEAR(value("ward:m=0.2@pump:times=1") / value("ward:m=0.2@pump:times=2"), larger["value"].get<double>(),
              larger["error"].get<double>() + 2e-6);
  EXPECT_LT(this->json({"distance", "ward:m=0.2@pump:times=2", "lambert"})["distance"]["error"].get<double>(), 1e-4);
}

TEST_F(Repair, TabulatesAPumpedMaterial) {
  make({"pump", "phong:n=5", "--correction", "g1", "--grid", kSmallRepair, "-o", "p.h5"});

  const BrdfTable table = load_table(file("p.h5"));
  EXPECT_EQ(table.expression, "phong:n=5@pump:correction=g1,times=1");
  EXPECT_EQ(table.grid.name(), kSmallRepair);
}

TEST_F(Repair, PumpsATableAndRecordsHow) {
  make({"tabulate", "lambert:scale=0.3+phong:n=5,scale=0.5", "--grid", kSmallRepair, "-o", "a.h5"});
  const Words words{"pump", "a.h5", "--correction", "g1", "--times", "until-converged", "-o", "p.h5"};
  const auto outcome = make(words);

  EXPECT_THAT(outcome.output, HasSubstr(", converged"));
  EXPECT_THAT(outcome.output, HasSubstr("moved by"));
  EXPECT_THAT(load_table(file("p.h5")).expression, HasSubstr("pump(lambert:scale=0.3+phong:n=5,scale=0.5, g1, "));
  std::ifstream stream(file("p.h5"), std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  EXPECT_THAT(bytes, HasSubstr("lobe pump a.h5 --correction g1 --times until-converged -o p.h5"));
  const auto header = run({"info", "p.h5", "--json"});
  EXPECT_NEAR(Json::parse(header.output)["albedo_in"][0]["min"]["value"].get<double>(), 1, 0.02);
  EXPECT_EQ(make({"check", "p.h5"}).status, 0);
}

TEST_F(Repair, DrawsAlbedosAndMirrorRadiances) {
  make({"pump", "lambert:scale=0.5", "--correction", "g1", "--plot", "curves.png"});

  EXPECT_THAT(files(), ::testing::IsSupersetOf({"curves.gp", "curves.dat", "curves.mirror-radiance.gp"}));
}

TEST_F(Repair, BalanceLeavesNoAlbedoAboveOneAndWhatIsBalancedAlone) {
  make({"tabulate", "lambert:scale=0.5+phong:n=5,scale=0.8", "--grid", kSmallRepair, "-o", "a.h5"});
  EXPECT_EQ(run({"check", "a.h5"}).status, 1);

  const Json balanced = json({"balance", "a.h5", "-o", "b.h5"});
  const Json again = json({"balance", "b.h5", "-o", "c.h5", "--tolerance", "1e-11"});

  EXPECT_NEAR(balanced["albedo_in"][0]["max"]["value"].get<double>(), 1, 1e-11);
  EXPECT_GT(balanced["moved"]["relative"]["value"], 0);
  EXPECT_EQ(balanced["moved"]["lighting"], "point");
  EXPECT_EQ(again["sweeps"], 0);
  EXPECT_EQ(again["moved"]["absolute"]["value"], 0);
  EXPECT_EQ(load_table(file("c.h5")).values, load_table(file("b.h5")).values);
  EXPECT_EQ(make({"check", "b.h5"}).status, 0);
}

TEST_F(Repair, SymmetriseComesBeforeBalanceOfAComposition) {
  make({"compose", "phong:n=5,scale=1.5", "lambert:scale=1.4", "--grid", kSmallRepair, "-o", "c.h5"});
  expect_refusal({"balance", "c.h5", "--strict"}, ExitCode::numeric, "make it reciprocal by symmetrise()");
  EXPECT_THAT(make({"balance", "c.h5", "-o", "b.h5"}).error, HasSubstr("the reciprocal part is balanced"));

  make({"symmetrise", "c.h5", "-o", "s.h5"});

  EXPECT_EQ(load_table(file("s.h5")).expression, "symmetrise(" + load_table(file("c.h5")).expression + ")");
  EXPECT_NEAR(json({"balance", "s.h5"})["albedo_in"][0]["max"]["value"].get<double>(), 1, 1e-11);
  make({"balance", "s.h5", "-o", "bs.h5"});
  EXPECT_EQ(load_table(file("b.h5")).values, load_table(file("bs.h5")).values);
}

TEST_F(Repair, NormaliseTakesMaterialsOnAGrid) {
  const Json answer = json({"normalise", "phong:n=5,scale=0.5", "--grid", kSmallRepair, "-o", "n.h5"});

  EXPECT_NEAR(answer["albedo_in"][0]["max"]["value"].get<double>(), 1, 1e-13);
  EXPECT_EQ(load_table(file("n.h5")).expression, "normalise(phong:n=5,scale=0.5)");
}

TEST_F(Repair, RefusesWhatItCannotDo) {
  expect_refusal({"pump", "phong:n=5", "--correction", "g3"}, ExitCode::usage, "g3");
  expect_refusal({"pump", "phong:n=5", "--correction", "g1", "--times", "often"}, ExitCode::usage,
                 "a whole number from 1 to 1000, or until-converged");
  expect_refusal({"pump", "phong:n=5", "--correction", "g1", "--times", "11"}, ExitCode::usage, "at most 10");
  expect_refusal({"pump", "phong:n=5", "--correction", "g1", "--plot", "curves"}, ExitCode::usage, ".png");
  expect_refusal({"balance", "li_sparse", "--grid", kSmallRepair, "--allow-unresolved"}, ExitCode::numeric,
                 "expected values of 0 and above");
  EXPECT_THAT(files(), IsEmpty());
}

TEST_F(Repair, MeanAlbedoTakesMaterialsAndTables) {
  make({"tabulate", "lambert:scale=0.1/0.2/0.4", "--grid", kSmallRepair, "-o", "a.h5"});

  const Json answer = json({"mean-albedo", "phong:n=20", "a.h5"});

  const double phong = json({"albedo", "phong:n=20", "--mean"})["mean_albedo"][0]["value"];
  EXPECT_EQ(answer["materials"][0]["mean_albedo"][0]["value"], phong);
  EXPECT_NEAR(answer["materials"][1]["mean_albedo"][2]["value"].get<double>(), 0.4, 1e-13);
  EXPECT_THAT(make({"mean-albedo", "phong:n=20", "a.h5"}).output, HasSubstr("channel 3"));
}

TEST_F(Repair, PumpsMaterialsWithMirrors) {
  const auto outcome =
      make({"pump", "lambert:scale=0.2+mirror:rho=0.5*fresnel:ior=1.5", "--correction", "g1", "--theta", "0,60"});

  EXPECT_THAT(outcome.output, HasSubstr("step 1"));
}

TEST_F(Repair, AlbedosAreDrawnBeforeAndAfter) {
  make({"albedo", "phong:n=5", "--plot", "before.png"});
  const auto outcome = make({"albedo", "ward_anisotropic:m_x=0.1,m_y=0.3", "--theta", "30", "--azimuth", "0,90",
                             "--tolerance", "1e-3", "--plot", "azimuths.png"});

  EXPECT_THAT(outcome.output, HasSubstr("phi/deg"));
  for (const char* name : {"before.png", "azimuths.png"})
    EXPECT_GT(std::filesystem::file_size(file(name)), 1000U) << name;
  expect_refusal({"albedo", "phong:n=5", "--plot", "before.png"}, ExitCode::file, "use --force");
  expect_refusal({"albedo", "phong:n=5", "--plot", "before"}, ExitCode::usage, ".png");
}

}  // namespace
}  // namespace lobe::test
