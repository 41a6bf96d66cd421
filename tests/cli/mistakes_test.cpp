// Mistakes that people make on their first afternoon: each is one line that says what is wrong, where, and what to do.
#include <fstream>
#include <ostream>

#include "cli/command_test.hpp"

namespace lobe::test {
namespace {

using cli::ExitCode;
using ::testing::HasSubstr;

struct Mistake {
  std::string name;
  std::string line;    ///< as typed
  std::string what;    ///< what is wrong, and where
  std::string advice;  ///< what to do
  ExitCode code = ExitCode::usage;
};

/// GoogleTest shows a case by its name.
std::ostream& operator<<(std::ostream& stream, const Mistake& mistake) {
  return stream << mistake.name;
}

const std::vector<Mistake>& mistakes() {
  using enum ExitCode;
  static const std::vector<Mistake> kMistakes{
      // Typing.
      {"command", "lobe distnace lambert ward:m=0.2", "unknown command 'distnace'", "did you mean 'distance'?"},
      {"command_unlike_any", "lobe foo", "unknown command 'foo'", "'lobe --help' lists them"},
      {"topic", "lobe help lighting", "no help on 'lighting'", "did you mean 'lightings'?"},
      {"option", "lobe distance lambert ward:m=0.2 --lightning point", "unknown option '--lightning'",
       "did you mean '--lighting'?"},
      {"former_option", "lobe tabulate lambert --samples 4 -o new.h5", "option '--samples' is called",
       "'--cell-points'"},
      {"choice", "lobe norm lambert --precision Single", "unknown value 'Single' of --precision",
       "did you mean 'single'?"},
      {"model", "lobe norm wrad:m=0.2", "unknown model 'wrad'", "did you mean 'ward'?"},
      {"capital", "lobe norm Lambert", "unknown model 'Lambert'", "did you mean 'lambert'?"},
      {"model_unlike_any", "lobe norm plastic", "unknown model 'plastic'", "'lobe models' lists"},
      {"parameter", "lobe norm oren_nayar:sigmo=0.2", "model 'oren_nayar' has no parameter 'sigmo'",
       "did you mean 'sigma'?"},
      {"factor", "lobe norm 'phong:n=3*cosmax'", "unknown factor 'cosmax'", "did you mean 'cos_max'?"},
      {"adjustment", "lobe norm phong:n=3@pmup", "unknown adjustment 'pmup'", "did you mean 'pump'?"},
      {"lighting", "lobe norm lambert --lighting dailight", "unknown lighting 'dailight'", "did you mean 'daylight'?"},
      {"grid", "lobe tabulate lambert --grid gaus:8x16 -o new.h5", "unknown grid 'gaus'", "did you mean 'gauss'?"},
      {"format", "lobe export lambert --format MERL -o new.binary", "no format 'MERL'", "did you mean 'merl'?"},
      {"family", "lobe gram studies/classical-families.toml --family Wrad", "unknown family 'Wrad'",
       "did you mean 'Ward'?"},
      {"file", "lobe info tabel.h5", "cannot read tabel.h5: No such file", "did you mean 'table.h5'?", file},
      {"study", "lobe run studies/clasical-families.toml", "cannot read studies/clasical-families.toml",
       "did you mean 'studies/classical-families.toml'?", file},
      {"set_value", "lobe run text.toml --set study.tolerance=small",
       "--set study.tolerance=small: tolerance is a text", "expected a number"},
      {"set_key", "lobe run text.toml --set study.tolrance=1e-3", "--set study.tolrance=1e-3: unknown key 'tolrance'",
       "did you mean 'tolerance'?"},
      {"set_name", "lobe run studies/classical-families.toml --set family.Wrad.m=1", "there is no [[family]] 'Wrad'",
       "did you mean 'Ward'?"},
      {"key", "lobe run key.toml", "key.toml:2:1: unknown key 'lightnings' in [study]", "did you mean 'lightings'?"},
      // How things are written.
      {"parenthesis", "lobe norm 'phong(n=20)'", "cannot read material 'phong(n=20)'", "such as phong:n=20"},
      {"comma", "lobe norm ward,m=0.2", "cannot read material 'ward,m=0.2'", "expected MODEL[:key=value,...]"},
      {"value_without_key", "lobe norm phong:20", "cannot read '20' in material 'phong:20'",
       "expected MODEL[:key=value,...]"},
      {"sum_without_end", "lobe norm lambert+", "a material, or a part of one, is empty",
       "expected MODEL[:key=value,...]"},
      {"missing_parameter", "lobe norm phong", "model 'phong' needs the parameter 'n'", "give n=VALUE"},
      {"lighting_with_equals", "lobe norm lambert --lighting patch=0.5", "cannot read lighting 'patch=0.5'",
       "expected patch:R"},
      {"lighting_without_value", "lobe norm lambert --lighting mixture:0.5",
       "'0.5' in lighting 'mixture:0.5' has no '='", "expected RADIUS=VALUE,..."},
      {"option_without_value", "lobe norm lambert --lighting", "option --lighting needs a value",
       "see 'lobe norm --help'"},
      {"toml", "lobe run broken.toml", "broken.toml:3:", "see 'lobe help studies'"},
      {"text_for_number", "lobe run text.toml", "text.toml:2:13: tolerance is a text", "expected a number"},
      // Units and ranges.
      {"unit", "lobe albedo lambert --theta 45deg", "'45deg' in --theta is not a number",
       "expected one without a unit"},
      {"unit_of_a_parameter", "lobe norm oren_nayar:sigma=20deg", "value '20deg' of 'sigma'",
       "expected one without a unit"},
      {"degrees_for_radians", "lobe norm oren_nayar:sigma=20", "parameter 'sigma' of model 'oren_nayar' is 20",
       "(20 degrees are 0.349066)"},
      {"angle_out_of_range", "lobe albedo lambert --theta 95", "--theta 95 is out of range", "less than 90 degrees"},
      {"radius_out_of_range", "lobe norm lambert --lighting patch:3", "radius 3 of a patch light is out of range",
       "expected a value in (0, 2]"},
      {"percent_for_share", "lobe norm lambert --tolerance 5", "--tolerance 5 is out of range", "such as 1e-6"},
      {"grid_too_coarse", "lobe tabulate phong:n=10000 --grid gauss:8x16 --strict -o new.h5",
       "grid gauss:8x16 does not resolve", "it needs gauss:", numeric},
      // Wrong place, wrong kind.
      {"option_first", "lobe --lighting point norm lambert", "option '--lighting' in the wrong place",
       "give it after the command's name"},
      {"missing_argument", "lobe distance lambert", "'lobe distance' needs B", "see 'lobe distance --help'"},
      {"argument_too_many", "lobe albedo lambert 45", "too many arguments, from '45' on", "see 'lobe albedo --help'"},
      {"swapped_arguments", "lobe scale 2 lambert -o new.h5", "FACTOR 'lambert' is not a number",
       "as in 'lobe scale A 0.5'"},
      {"study_for_material", "lobe norm studies/classical-families.toml", "is a study file",
       "'lobe gram' and 'lobe distance-matrix' take"},
      {"table_for_study", "lobe run table.h5", "table.h5 is a table", "expected a study file (.toml)"},
      {"model_for_file", "lobe info ward", "'ward' is a model and no file", "'lobe models ward' explains it"},
      {"picture_for_stem", "lobe plot lambert -o new.png", "--output new.png is the name of one picture",
       "as in --output new"},
      {"too_few_weights", "lobe mix lambert phong:n=3 --weights 1 -o new.h5", "1 weights for 2 materials",
       "as in --weights 0.3,0.7"},
      // Files.
      {"file_that_exists", "lobe tabulate lambert -o table.h5", "table.h5 exists", "use --force to replace it", file},
      {"folder_that_does_not", "lobe tabulate lambert -o nowhere/new.h5", "cannot write into directory nowhere",
       "give another by --output", file},
      {"folder_for_file", "lobe run studies", "cannot read studies: is a directory", "give the path of a file", file},
      {"text_for_table", "lobe info notes.txt", "notes.txt: it is of no known format",
       "'lobe import --help' names those", file},
      {"cut_off_file", "lobe info cut.h5", "cannot read cut.h5", "give a file that lobe has written", file},
      {"newer_schema", "lobe info newer.h5", "it was written by a newer lobe, as lobe-table/2", "read it with that one",
       file},
      {"measured_file_missing", "lobe run measured.toml", "measured.toml:3:8: there is no file 'felt.binary'",
       "expected a path from the folder of this study file"},
      {"devices", "lobe norm lambert --device 0:0,0:0", "'0:0,0:0' names several devices", "expected one",
       ExitCode::device},
      {"device", "lobe norm lambert --device gpu", "device selector 'gpu' matches no OpenCL device",
       "there is:", device}};
  return kMistakes;
}

class Mistakes : public CommandTest, public ::testing::WithParamInterface<Mistake> {
 protected:
  void SetUp() override {
    std::filesystem::create_directory_symlink(LOBE_STUDIES_DIRECTORY, file("studies"));
    make({"tabulate", "lambert", "--grid", "gauss:4x8", "--no-compress", "-o", "table.h5"});
    write("key.toml", "[study]\nlightnings = [\"point\"]\n[[material]]\nname = \"a\"\nmodel = \"lambert\"\n");
    write("broken.toml", "[[material]]\nname = \"a\"\nmodel = \"lambert\n");
    write("text.toml", "[study]\ntolerance = \"1e-4\"\n[[material]]\nname = \"a\"\nmodel = \"lambert\"\n");
    write("measured.toml", "[[measured]]\nname = \"felt\"\nfile = \"felt.binary\"\n");
    write("notes.txt", "compare felt with velvet\n");
    std::string table = read("table.h5");
    write("cut.h5", table.substr(0, table.size() / 2));
    const auto schema = table.find("lobe-table/1");
    ASSERT_NE(schema, std::string::npos);
    table.resize(table.size() - 8);  // without the mark of its checksum
    write("newer.h5", table.replace(schema, 12, "lobe-table/2"));
  }

 private:
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(file(name), std::ios::binary) << text;
  }
  [[nodiscard]] std::string read(const std::string& name) const {
    std::ifstream stream(file(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
};

TEST_P(Mistakes, AreToldInOneLineWithWhatToDo) {
  const Mistake& mistake = GetParam();
  const auto before = files();

  const auto outcome = run_line(mistake.line, {.directory = file("")});

  EXPECT_EQ(outcome.status, static_cast<int>(mistake.code)) << outcome.error;
  EXPECT_THAT(outcome.output, ::testing::IsEmpty());
  EXPECT_THAT(outcome.error, ::testing::StartsWith("lobe: error: "));
  EXPECT_EQ(std::ranges::count(outcome.error, '\n'), 1) << outcome.error;
  EXPECT_THAT(outcome.error, HasSubstr(mistake.what));
  EXPECT_THAT(outcome.error.substr(std::min(outcome.error.find(mistake.what), outcome.error.size())),
              HasSubstr(mistake.advice));
  EXPECT_EQ(files().size(), before.size()) << "leaves no files";
}

INSTANTIATE_TEST_SUITE_P(People, Mistakes, ::testing::ValuesIn(mistakes()),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace lobe::test
