// `lobe new-study`: what it writes runs as it stands, and whatever is switched on in it.
#include <fstream>
#include <sstream>

#include "cli/command_test.hpp"
#include "lobe/model/model.hpp"
#include "lobe/study/study.hpp"
#include "lobe/study/study_schema.hpp"

namespace lobe::test {
namespace {

namespace fs = std::filesystem;
using cli::ExitCode;
using ::testing::HasSubstr;
using ::testing::StartsWith;

std::vector<std::string> rows_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// Switched off: a # without a blank after it.
bool is_off(const std::string& line) {
  return line.size() > 1 && line[0] == '#' && line[1] != ' ' && !line.starts_with("#:schema");
}

/// First and last line, the last not included, of what stands together switched off.
std::vector<std::pair<std::size_t, std::size_t>> blocks(const std::vector<std::string>& lines) {
  std::vector<std::pair<std::size_t, std::size_t>> list;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (!is_off(lines[i])) continue;
    const std::size_t begin = i;
    while (i < lines.size() && is_off(lines[i])) ++i;
    list.emplace_back(begin, i);
  }
  return list;
}

class NewStudy : public CommandTest {
 protected:
  NewStudy() {
    fs::create_directory(file("measurements"));
    std::ofstream(file("measurements") / "plate.csv") << "1, 1, 0, 0, 0, 0, 0, 1\n";
    fs::create_directory(file("families"));
    std::ofstream(file("families") / "metals.toml") << "[[material]]\nname = \"steel\"\nmodel = \"phong\"\nn = 9\n";
  }

  /// The study with blocks switched on.
  [[nodiscard]] Study load(const std::vector<std::string>& lines,
                           const std::vector<std::pair<std::size_t, std::size_t>>& on) const {
    const fs::path path = file("switched.toml");
    std::ofstream stream(path);
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const bool is_on =
          std::ranges::any_of(on, [&](const auto& block) { return i >= block.first && i < block.second; });
      stream << (is_on ? lines[i].substr(1) : lines[i]) << '\n';
    }
    stream.close();
    return load_study(path);
  }
};

TEST_F(NewStudy, RunsAsItStands) {
  EXPECT_EQ(make({"new-study", "-o", "new.toml"}).output, "new.toml\n");
  EXPECT_THAT(make({"run", "new.toml", "-o", "out"}).output, StartsWith("out/new.h5\n"));
}

TEST_F(NewStudy, IsReadWithAnyBlockSwitchedOnAndWithAll) {
  const auto lines = rows_of(make({"new-study"}).output);
  const auto off = blocks(lines);
  EXPECT_GE(off.size(), 14U);
  for (const auto& block : off) {
    EXPECT_NO_THROW((void)load(lines, {block})) << lines[block.first];
  }
  const Study study = load(lines, off);
  EXPECT_GT(study.materials.size(), load(lines, {}).materials.size());
  EXPECT_EQ(study.channels.size(), 3U);
  EXPECT_EQ(study.charts.size(), 1U);
  EXPECT_EQ(study.published.size(), 1U);
}

TEST_F(NewStudy, TakesEveryModelOfTheCatalogue) {
  std::string all;
  for (const auto& model : catalogue()) all += (all.empty() ? "" : ",") + std::string(model.name);
  const auto lines = rows_of(make({"new-study", "--models", all}).output);
  for (const auto& blocks_on : {blocks(lines), {}}) {
    const Study study = load(lines, blocks_on);
    for (const auto& model : catalogue()) {
      EXPECT_TRUE(std::ranges::any_of(study.materials, [&](const StudyMaterial& m) {
        return m.family() == model.name;
      })) << model.name;
    }
  }
}

TEST_F(NewStudy, HasLightingsUnderWhichItsModelsHaveNorms) {
  const auto lightings = [&](const std::string& models) {
    std::ofstream(file("models.toml")) << make({"new-study", "--models", models}).output;
    std::string names;
    for (const auto& lighting : load_study(file("models.toml")).lightings) names += lighting.name() + " ";
    return names;
  };
  EXPECT_EQ(lightings("phong,ward"), "point daylight ");
  EXPECT_EQ(lightings("phong,mirror"), "daylight ");
  EXPECT_EQ(lightings("mirror,ward_duer"), "mean-albedo ");
  EXPECT_EQ(lightings("basic_patch_anisotropic,retro_patch_anisotropic"), "point daylight ");
  make({"new-study", "--models", "mirror,rrim", "-o", "mirrors.toml"});
  EXPECT_THAT(make({"run", "mirrors.toml", "-o", "out"}).output, StartsWith("out/mirrors.h5\n"));
}

TEST_F(NewStudy, TakesMeasuredFilesFromItsOwnFolder) {
  fs::create_directory(file("studies"));
  make({"new-study", "--measured", "measurements/*.csv", "-o", "studies/plates.toml"});
  const Study study = load_study(file("studies") / "plates.toml");
  const auto plate = std::ranges::find(study.materials, "plate", &StudyMaterial::name);
  ASSERT_NE(plate, study.materials.end());
  expect_refusal({"new-study", "--measured", "nowhere/*.csv"}, ExitCode::file, "no file matches 'nowhere/*.csv'");
}

TEST_F(NewStudy, NamesTheSchemaThatIsInstalledBesideIt) {
  EXPECT_THAT(make({"new-study"}).output, StartsWith(fs::exists(fs::path(LOBE_COMMAND).parent_path().parent_path() /
                                                                "share/lobe/studies/study.schema.json")
                                                         ? "#:schema /"
                                                         : "# A study"));
  EXPECT_EQ(make({"new-study", "--schema"}).output, study_schema());
}

TEST_F(NewStudy, LeavesFilesThatExist) {
  make({"new-study", "-o", "new.toml"});
  expect_refusal({"new-study", "-o", "new.toml"}, ExitCode::file, "new.toml exists; use --force to replace it");
  make({"new-study", "-o", "new.toml", "--force", "--models", "ggx"});
  expect_refusal({"new-study", "-o", "new.txt"}, ExitCode::usage, "expected FILE.toml");
  expect_refusal({"new-study", "--models", "wrad"}, ExitCode::usage, "did you mean 'ward'?");
}

}  // namespace
}  // namespace lobe::test
