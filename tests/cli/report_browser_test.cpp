// The page of `lobe report` in a browser without a window: a script beside the page's own (report_reader.js) moves,
// clicks and types as a reader does, and leaves what it saw in the document, which Chromium prints.
#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>

#include "cli/command_test.hpp"
#include "core/files.hpp"

namespace lobe::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;
using ::testing::UnorderedElementsAre;

constexpr const char* kHostileName = "</script><script>hacked = 1</script><img src=x onerror='hacked = 2'>";

constexpr const char* kShownStudy = R"(
[study]
name = "four"
title = "Four & <b>more</b>"
lightings = ["point", "daylight"]
comparison_metrics = ["ngan-l2"]
approximations = ["non-negative"]
tolerance = 1e-4
comparison_tolerance = 1e-2

[[material]]
name = "matt"
model = "lambert"

[[material]]
name = "gloss"
model = "phong"
n = 20

[[material]]
name = "NAME"
model = "phong"
n = 5

[[material]]
name = "metal"
model = "ward"
m = 0.2
)";

/// Chromium has no window as narrow as a phone.
constexpr const char* kPhone = R"(<!DOCTYPE html><html><body>
<iframe src="page.html" width="390" height="844" style="border: 0"></iframe>
<script>
addEventListener("message", (event) => {
  const outcome = document.createElement("pre");
  outcome.id = "outcome";
  outcome.textContent = event.data;
  document.body.append(outcome);
});
</script></body></html>
)";

std::string replaced(std::string text, const std::string& mark, const std::string& by) {
  const std::size_t at = text.find(mark);
  return at == std::string::npos ? text : text.replace(at, mark.size(), by);
}

/// Text of an element that Chromium prints.
std::string plain(std::string html) {
  for (const auto& [code, character] : {std::pair("&lt;", "<"), std::pair("&gt;", ">"), std::pair("&amp;", "&")}) {
    for (std::size_t at = html.find(code); at != std::string::npos; at = html.find(code, at + 1)) {
      html.replace(at, std::string(code).size(), character);
    }
  }
  return html;
}

constexpr std::array<std::pair<double, int>, 10> kNumbers{{{0.1, 3},
                                                           {123456.5, 3},
                                                           {1e-5, 2},
                                                           {0.0001234567, 4},
                                                           {-2.5, 8},
                                                           {99.996, 4},
                                                           {1e22, 6},
                                                           {1.0 / 3, 17},
                                                           {5, 1},
                                                           {9.99e-5, 2}}};

/// A page, and what a reader sees of it.
class BrowserPage {
 public:
  BrowserPage() {
    std::ofstream(file("four.toml")) << replaced(kShownStudy, "NAME", kHostileName);
    for (const std::string line : {"lobe run four.toml", "lobe report four.h5 -o plain.html"}) {
      const auto outcome = run_line(line, {.directory = directory_.path()});
      EXPECT_EQ(outcome.status, 0) << outcome.error;
    }
    std::string page = read_text(file("plain.html"));
    Json numbers = Json::array();
    for (const auto& [value, digits] : kNumbers) numbers.push_back(Json::array({value, digits}));
    const std::string scripts = LOBE_BROWSER_SCRIPTS;
    page = replaced(page, "<head>", "<head>\n<script>\n" + read_text(scripts + "/report_listener.js") + "</script>\n");
    const std::string reader = "<script>\nconst printedNumbers = " + numbers.dump() + ";\n" +
                               read_text(scripts + "/report_reader.js") + "</script>\n";
    std::ofstream(file("page.html")) << page.insert(page.rfind("</body>"), reader);
    std::ofstream(file("phone.html")) << kPhone;
  }

  /// \param file "page.html", or the same on a phone, "phone.html"
  [[nodiscard]] Json look(const std::string& file, const std::string& options = "") const {
    const auto outcome = run_line(
        "timeout 120 chromium --headless --no-sandbox --disable-gpu --disable-dev-shm-usage --user-data-dir=profile "
        "--enable-logging=stderr --v=0 --virtual-time-budget=5000 --window-size=1400,1000 " +
            options + " --dump-dom \"file://$PWD/" + file + "\"",
        {.directory = directory_.path()});
    EXPECT_EQ(outcome.status, 0) << outcome.error;
    EXPECT_THAT(outcome.error, Not(HasSubstr("CONSOLE")));
    const std::string mark = "<pre id=\"outcome\">";
    const std::size_t begin = outcome.output.find(mark);
    if (begin == std::string::npos) {
      ADD_FAILURE() << "the reader did not come to an end\n" << outcome.error;
      return Json::object();
    }
    const std::size_t end = outcome.output.find("</pre>", begin);
    return Json::parse(plain(outcome.output.substr(begin + mark.size(), end - begin - mark.size())));
  }

 private:
  [[nodiscard]] std::filesystem::path file(const std::string& name) const { return directory_.path() / name; }

  TemporaryDirectory directory_;
};

const BrowserPage& page() {
  static const BrowserPage made;
  return made;
}

const Json& on_a_desk() {
  static const Json seen = page().look("page.html");
  return seen;
}

std::string text_of(const Json& json) {
  return json.get<std::string>();
}

class ReportBrowser : public ::testing::Test {
 protected:
  void SetUp() override {
    if (run_line("command -v chromium").status != 0) GTEST_SKIP() << "chromium is missing; install it to test the page";
  }
};

TEST_F(ReportBrowser, ShowsWhatIsPointedAtClickedAndTyped) {
  const Json& seen = on_a_desk();

  EXPECT_EQ(seen.at("failures"), Json::array());
  EXPECT_EQ(seen.at("isTooWide"), false);
  EXPECT_EQ(seen.at("title"), "Four & <b>more</b>");
  EXPECT_EQ(seen.at("heading"), "Four & <b>more</b>");
  EXPECT_EQ(seen.at("tip").at("isHidden"), false);
  EXPECT_THAT(text_of(seen.at("tip").at("text")), AllOf(StartsWith("metal\nmatt\n"), HasSubstr(" ± ")));
  EXPECT_EQ(seen.at("clicked").at("names"), (Json{"metal", "gloss"}));
  EXPECT_EQ(seen.at("clicked").at("notes"), (Json{"Ward", "four.toml:25", "Phong", "four.toml:15"}));
  EXPECT_EQ(seen.at("copied"), Json::array({seen.at("clicked").at("code")}));
  EXPECT_EQ(seen.at("curves"), (Json{{"albedos", 2}, {"slices", 6}}));
  EXPECT_THAT(text_of(seen.at("keyboard").at("cell")), StartsWith("gloss · matt · "));
  EXPECT_EQ(seen.at("keyboard").at("chosen"), (Json{"gloss", "matt"}));
}

TEST_F(ReportBrowser, ShowsEveryDistanceOfTheStudyInAnyOrderAndScale) {
  const Json& seen = on_a_desk();

  const Json& daylight = seen.at("daylight");
  EXPECT_THAT(text_of(daylight.at("definition")), StartsWith("Distances under daylight lighting: "));
  EXPECT_THAT(text_of(daylight.at("definition")), HasSubstr("Where the study asks for it: four.toml:5."));
  EXPECT_THAT(text_of(daylight.at("code")), HasSubstr("--lighting daylight"));
  EXPECT_EQ(daylight.at("isRepainted"), true);
  EXPECT_EQ(seen.at("comparison"), (Json{{"code", "lobe run four.toml"}, {"leaves", 4}}));
  EXPECT_THAT(seen.at("order").get<std::vector<int>>(), UnorderedElementsAre(0, 1, 2, 3));
  EXPECT_THAT(text_of(seen.at("scale")), HasSubstr("logarithmic"));
}

TEST_F(ReportBrowser, FindsMaterialsAndFamilies) {
  const Json& seen = on_a_desk();

  EXPECT_EQ(seen.at("found"), (Json{{"text", "1 material"}, {"materials", Json::array({3})}}));
  EXPECT_EQ(seen.at("family").at("pressed"), text_of(seen.at("family").at("search")) + " (1)");
}

TEST_F(ReportBrowser, HasTheTablesAndTheProvenance) {
  const Json& seen = on_a_desk();

  EXPECT_EQ(seen.at("neighbours"), 6) << "three of either";
  EXPECT_EQ(seen.at("approximations"), 4);
  EXPECT_EQ(seen.at("agreement"), 3);
  EXPECT_THAT(text_of(seen.at("provenance")), HasSubstr("lobe 0."));
  EXPECT_THAT(text_of(seen.at("study")), HasSubstr("comparison_tolerance = 1e-2"));
}

TEST_F(ReportBrowser, HasSpheresBesideNames) {
  const Json& seen = on_a_desk();

  EXPECT_EQ(seen.at("spheres").at("widths"), (Json{64, 64})) << "those of the pair";
  EXPECT_EQ(seen.at("spheres").at("nearest"), 6) << "three of either";
}

TEST_F(ReportBrowser, HasLinksToPairs) {
  const Json& seen = on_a_desk();

  EXPECT_THAT(text_of(seen.at("link")), HasSubstr("page.html#distance=point&first=metal&second=gloss"));
  EXPECT_EQ(seen.at("linked").at("names"), (Json{"metal", "gloss"}));
  EXPECT_EQ(seen.at("linked").at("distance"), seen.at("clicked").at("distance"));
  EXPECT_EQ(seen.at("linked").at("measure"), "0");
  EXPECT_EQ(seen.at("unknownLink"), seen.at("linked").at("names"));
}

TEST_F(ReportBrowser, SavesDistancesAndResidualsAsCsv) {
  const Json& seen = on_a_desk();

  const std::string distances = text_of(seen.at("distances"));
  EXPECT_THAT(distances, StartsWith("first,second,distance,error\r\nmatt,gloss,"));
  EXPECT_EQ(std::ranges::count(distances, '\n'), 7) << "six pairs";
  EXPECT_THAT(distances, HasSubstr(std::string(kHostileName) + ",metal,"));
  EXPECT_EQ(text_of(seen.at("csv")), "\"a,b\",\"c\"\"d\",1.5,\r\n") << "quoted where needed, empty where not known";
  EXPECT_THAT(text_of(seen.at("residuals")), StartsWith("material,family of the material,"));
}

TEST_F(ReportBrowser, TakesHostileNamesForText) {
  const Json& seen = on_a_desk();

  EXPECT_EQ(seen.at("hacked"), 0);
  EXPECT_EQ(text_of(seen.at("hostile")), kHostileName);
}

TEST_F(ReportBrowser, GivesCommandsThatGiveTheDistanceAgain) {
  const Json& clicked = on_a_desk().at("clicked");

  const std::string line = text_of(clicked.at("code"));
  EXPECT_THAT(line, StartsWith("lobe distance "));
  const auto outcome = run_line(line + " --json");
  ASSERT_EQ(outcome.status, 0) << line << outcome.error;
  const Json found = Json::parse(outcome.output)["distance"];
  double value = 0;
  double error = 0;
  ASSERT_EQ(std::sscanf(text_of(clicked.at("distance")).c_str(), "%lf ± %lf", &value, &error), 2);
  EXPECT_NEAR(found["value"].get<double>(), value, error + found["error"].get<double>());
  EXPECT_LT(error, 1e-2 * value);
}

TEST_F(ReportBrowser, WritesNumbersAsTheCommandDoes) {
  const Json& seen = on_a_desk();

  Json expected = Json::array();
  for (const auto& [value, digits] : kNumbers) {
    std::array<char, 40> text{};
    std::snprintf(text.data(), text.size(), "%.*g", digits, value);
    expected.push_back(text.data());
  }
  EXPECT_EQ(seen.at("numbers"), expected);
  EXPECT_EQ(seen.at("estimates"),
            (Json{"0.56751271 ± 1.8e-07", "1 ± 0", "2 (error unknown)", "not known", "0.001 ± 0.1"}));
}

TEST_F(ReportBrowser, IsLightOrDarkAsTheSystemIsOrAsWanted) {
  const Json& light = on_a_desk();
  const Json dark = page().look("page.html", "--blink-settings=preferredColorScheme=0");

  EXPECT_EQ(light.at("theme"), "light");
  EXPECT_EQ(dark.at("theme"), "dark");
  EXPECT_EQ(dark.at("failures"), Json::array());
  // As it is, light, dark.
  EXPECT_EQ(light.at("papers"), (Json{"rgb(255, 255, 255)", "rgb(255, 255, 255)", "rgb(22, 23, 26)"}));
  EXPECT_EQ(dark.at("papers"), (Json{"rgb(22, 23, 26)", "rgb(255, 255, 255)", "rgb(22, 23, 26)"}));
}

TEST_F(ReportBrowser, FitsAPhone) {
  const Json seen = page().look("phone.html");

  EXPECT_LT(seen.at("tallestHead"), 30) << "heads are one line, not one letter per line";
  EXPECT_EQ(seen.at("failures"), Json::array());
  EXPECT_EQ(seen.at("isTooWide"), false);
  EXPECT_THAT(text_of(seen.at("tip").at("text")), StartsWith("metal\nmatt\n"));
}

}  // namespace
}  // namespace lobe::test
