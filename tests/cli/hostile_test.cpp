// Files from strangers: materials, tables and studies that try to run something or to write to the terminal.
#include <fstream>

#include "cli/command_test.hpp"
#include "core/text.hpp"
#include "lobe/hdf5/table_file.hpp"
#include "lobe/model/material.hpp"

namespace lobe::test {
namespace {

using cli::ExitCode;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr const char* kEscape = "1.0); const pack y = (2.0";

class Hostile : public CommandTest {
 protected:
  void write(const std::string& name, const std::string& text) const { std::ofstream(file(name)) << text; }

  /// A table that says to be the tabulation of a formula.
  void write_table(const std::string& name, const Material& source) const {
    make({"tabulate", "lambert:scale=0.5", "--grid", "gauss:8x16", "-o", "plain.h5"});
    BrdfTable table = load_table(file("plain.h5"));
    table.source = {source};
    save(table, file(name));
    std::filesystem::remove(file("plain.h5"));
  }

  static Material written_out(const std::string& text, const std::string& name = "innocent") {
    Term term{.model = std::string(kCustomModel), .values = {}, .weight = {1.0}};
    term.formula = Formula{.text = text, .parameters = {}};
    return {name, "custom", {term}};
  }

  void expect_one_plain_line(const Outcome& outcome, ExitCode code) const {
    EXPECT_EQ(outcome.status, static_cast<int>(code)) << outcome.error;
    EXPECT_THAT(outcome.output, IsEmpty());
    EXPECT_EQ(std::ranges::count(outcome.error, '\n'), 1) << outcome.error;
    EXPECT_FALSE(has_control_characters(outcome.error.substr(0, outcome.error.size() - 1))) << outcome.error;
    EXPECT_FALSE(std::filesystem::exists(file("sentinel")));
  }
};

// --- Formulas.
TEST_F(Hostile, MaterialFilesAreNotCompiled) {
  write("m.toml",
        "model = \"custom\"\nrho = 0.5\nformula = \"\"\"\nrho / pi\n  * " + std::string(kEscape) + "\"\"\"\n");
  expect_refusal({"albedo", "m.toml", "--theta", "0"}, ExitCode::usage,
                 "m.toml:5:8: unexpected ')'; expected an operator or the end of the formula");
}

TEST_F(Hostile, FormulasHaveTheirPlaceHoweverTheyAreQuoted) {
  for (const auto& [text, place] :
       std::vector<std::pair<std::string, std::string>>{{"formula = \"x / pi\"\n", "2:12"},
                                                        {"formula = 'x / pi'\n", "2:12"},
                                                        {"formula = \"\"\"x / pi\"\"\"\n", "2:14"},
                                                        {"formula = '''\nx / pi'''\n", "3:1"},
                                                        {"formula = '''\n\n x / pi\n'''\n", "4:2"},
                                                        {"formula = '''1 +\n x / pi'''\n", "3:2"}}) {
    write("m.toml", "model = \"custom\"\n" + text);
    expect_refusal({"albedo", "m.toml", "--theta", "0"}, ExitCode::usage, "m.toml:" + place + ": unknown name 'x'");
  }
}

TEST_F(Hostile, StudiesAreNotCompiled) {
  write("s.toml", "[[material]]\nname = \"a\"\nmodel = \"custom\"\nformula = \"({ while (1); 1.0; })\"\n");
  expect_refusal({"run", "s.toml", "-o", "out"}, ExitCode::usage, "s.toml:4:13: unexpected '{'");
  expect_refusal({"run", "s.toml", "--dry-run"}, ExitCode::usage, "s.toml:4:13: unexpected '{'");
}

TEST_F(Hostile, FormulasThatAreSetFromOutsideHaveTheirPlaceInThemselves) {
  write("s.toml", "[[material]]\nname = \"a\"\nmodel = \"custom\"\nformula = \"1 / pi\"\n");
  expect_refusal({"run", "s.toml", "--dry-run", "--set", "material.a.formula=\"1 + x\""}, ExitCode::usage,
                 "--set material.a.formula=\"1 + x\":1:5: unknown name 'x'");
}

TEST_F(Hostile, TablesOfAnotherFormulaThanTheyStateAreRefused) {
  write_table("t.h5", written_out("0.4 / pi"));
  for (const Words& words : {Words{"compose", "t.h5", "phong:n=5", "-o", "c.h5"},
                             Words{"self-compose", "t.h5", "-o", "c.h5"}, Words{"spectrum", "t.h5"}}) {
    SCOPED_TRACE(words.front());
    const Outcome outcome = run(words);
    expect_one_plain_line(outcome, ExitCode::usage);
    EXPECT_THAT(outcome.error, HasSubstr("says that it is made of 'innocent', which is 0.127")) << words.front();
    EXPECT_THAT(outcome.error, HasSubstr("where the table has 0.159"));
  }
  // A little is enough.
  write_table("near.h5", written_out("0.50002 / pi"));
  EXPECT_EQ(run({"self-compose", "near.h5", "-o", "c.h5"}).status, static_cast<int>(ExitCode::usage));
  // That of its values is believed, in single precision, too.
  write_table("u.h5", written_out("0.5 / pi"));
  make({"self-compose", "u.h5", "-o", "d.h5"});
  make({"tabulate", "ward:m=0.3", "--grid", "gauss:16x32", "--precision", "single", "-o", "single.h5"});
  make({"self-compose", "single.h5", "-o", "e.h5"});
}

TEST_F(Hostile, TablesAreNotCompiled) {
  write_table("t.h5", written_out(kEscape));
  const std::string place = "t.h5: attribute material_json of /: formula:1:4: unexpected ')'";
  for (const Words& words :
       {Words{"compose", "t.h5", "lambert", "-o", "c.h5"}, Words{"self-compose", "t.h5", "-o", "c.h5"},
        Words{"spectrum", "t.h5"}, Words{"square-root", "t.h5", "-o", "c.h5"}, Words{"info", "t.h5"},
        Words{"albedo", "t.h5", "--theta", "0"}}) {
    expect_refusal(words, ExitCode::file, place);
    expect_one_plain_line(run(words), ExitCode::file);
  }
  EXPECT_FALSE(std::filesystem::exists(file("c.h5")));
}

TEST_F(Hostile, TablesWithFormulasOfTheLanguageAreTaken) {
  write_table("t.h5", written_out("0.5 / pi"));
  EXPECT_THAT(make({"self-compose", "t.h5", "-o", "c.h5"}).error, Not(HasSubstr("error")));
}

// --- Names.
TEST_F(Hostile, NamesInTablesAreOneLine) {
  write_table("t.h5", written_out("0.5 / pi", "a\x1b[2J"));
  expect_refusal({"info", "t.h5"}, ExitCode::file,
                 "attribute material_json of /: cannot read a material from JSON: its name 'a\\x1b[2J' has control "
                 "characters");
  BrdfTable table = load_table([&] {
    make({"tabulate", "lambert", "--grid", "gauss:8x16", "-o", "plain.h5"});
    return file("plain.h5");
  }());
  table.expression = "a\x1b]0;title\x07";
  save(table, file("e.h5"));
  expect_refusal({"info", "e.h5"}, ExitCode::file, "attribute expression of / has control characters");
  table.expression = "a\nlobe: everything is fine";
  save(table, file("n.h5"));
  expect_refusal({"info", "n.h5"}, ExitCode::file, "attribute expression of / has several lines or tabs");
}

TEST_F(Hostile, NamesInStudiesAreOneLine) {
  const std::string matt = "model = \"lambert\"\n";
  const std::vector<std::pair<std::string, std::string>> studies{
      {"[study]\nname = \"a\\nb\"\n[[material]]\nname = \"m\"\n" + matt, "2:8: name 'a\\x0ab' has control characters"},
      {"[study]\ntitle = \"a\\u001b[2J\"\n[[material]]\nname = \"m\"\n" + matt, "2:9: title 'a\\x1b[2J' has control"},
      {"[study]\ntitle = \"\"\"a\nsystem('touch sentinel')\"\"\"\n[[material]]\nname = \"m\"\n" + matt,
       "2:9: title 'a"},
      {"[study]\ntitle = \"a\\u0000\"\n[[material]]\nname = \"m\"\n" + matt, "2:9: title 'a\\x00' has control"},
      {"[study]\ncomment = \"a\\u001b\"\n[[material]]\nname = \"m\"\n" + matt, "2:11: comment has control"},
      {"[study]\nchannels = [\"r\\u009b\"]\n[[material]]\nname = \"m\"\n" + matt, "2:13: an entry of channels"},
      {"[[material]]\nname = \"m\\tn\"\n" + matt, "2:8: name 'm\\x09n' has control"},
      {"[[material]]\nname = \"m\"\nfamily = \"\\u007f\"\n" + matt, "3:10: family '\\x7f' has control"},
      {"[[family]]\nname = \"F\"\nmodel = \"ward\"\nm = \"$m\"\ncolumns = [\"name\", \"m\"]\nrows = [[\"a\\nb\", "
       "0.1]]\n",
       "6:10: "},
      {"[[chart]]\nname = \"c\"\ntitle = \"a\\nsystem('touch sentinel')\"\nquantity = \"albedo\"\n"
       "curves = [{label = \"l\", model = \"lambert\"}]\n",
       "3:9: title 'a\\x0asystem('touch sentinel')' has control"},
      {"[[chart]]\nname = \"c\"\nquantity = \"albedo\"\ncurves = [{label = \"l\\n\", model = \"lambert\"}]\n",
       "4:20: label 'l\\x0a' has control"}};
  for (const auto& [text, message] : studies) {
    write("s.toml", text);
    expect_refusal({"run", "s.toml", "-o", "out"}, ExitCode::usage, "s.toml:" + message);
    expect_one_plain_line(run({"run", "s.toml", "-o", "out"}), ExitCode::usage);
  }
}

TEST_F(Hostile, CommentsOfStudiesMayHaveSeveralLines) {
  write(
      "s.toml",
      "[study]\nlightings = [\"mean-albedo\"]\ncomment = \"\"\"two\n\tlines\"\"\"\n[[material]]\nname = \"m\"\nmodel = "
      "\"lambert\"\n");
  EXPECT_THAT(make({"run", "s.toml", "--dry-run"}).error, Not(HasSubstr("error")));
}

TEST_F(Hostile, WordsOfTheCommandLineArePlain) {
  for (const Words& words :
       {Words{"albedo", "a\x1b[2J.toml", "--theta", "0"}, Words{"info", "a\n.h5"},
        Words{"albedo", "lambert\x1b[2J", "--theta", "0"}, Words{"run", "\x07"},
        Words{"tabulate", "lambert", "-o", "a\x1b.h5"}, Words{"\x1b[2J"}, Words{"run", "\xc2\x9b"}}) {
    SCOPED_TRACE(::testing::PrintToString(words));
    const auto outcome = run(words);
    expect_one_plain_line(outcome, ExitCode::usage);
    EXPECT_THAT(outcome.error, HasSubstr("has control characters; expected a word or a file name without"));
  }
}

TEST_F(Hostile, FilesThatAreFoundByPatternsHavePlainNames) {
  make({"tabulate", "lambert", "--grid", "gauss:8x16", "-o", "plain.h5"});
  make({"export", "plain.h5", "--format", "csv", "-o", "plain.csv"});
  std::filesystem::rename(file("plain.csv"), file("a\x1b[2J.csv"));
  write("s.toml", "[[measured]]\nfiles = \"*.csv\"\n");
  expect_one_plain_line(run({"run", "s.toml", "-o", "out"}), ExitCode::file);
}

// --- Pictures.
TEST_F(Hostile, StudiesThatAreNamedAsCommandsAreDrawn) {
  for (const std::string name : {"<touch sentinel", "|touch sentinel", "`touch sentinel`", "$(touch sentinel)"}) {
    SCOPED_TRACE(name);
    write("s.toml",
          "[study]\nname = \"" + name +
              "\"\ntitle = \"'quoted' \\\" `touch sentinel`\"\nlightings = [\"mean-albedo\"]\n"
              "[[material]]\nname = \"'a'\"\nmodel = \"lambert\"\n[[material]]\nname = \"$(touch sentinel) 5 %\"\n"
              "model = \"phong\"\nn = 20\n[[material]]\nname = \"@x\"\nmodel = \"ward\"\nm = 0.3\n"
              "[[chart]]\nname = \"<c\"\ntitle = \"'; system('touch sentinel')\"\nquantity = \"albedo\"\n"
              "curves = [{label = \"`touch sentinel`\", model = \"lambert\"}]\n");
    const auto outcome = make({"run", "s.toml", "-o", "out", "--force"});
    EXPECT_THAT(outcome.error, Not(HasSubstr("pictures left out")));
    for (const char* kind :
         {".mean-albedo.distance.png", ".mean-albedo.map.png", ".mean-albedo.dendrogram.png", ".chart.<c.png"}) {
      EXPECT_TRUE(std::filesystem::exists(file("out") / (name + kind))) << name << kind;
    }
    for (const char* folder : {".", "out"}) EXPECT_FALSE(std::filesystem::exists(file(folder) / "sentinel"));
  }
}

}  // namespace
}  // namespace lobe::test
