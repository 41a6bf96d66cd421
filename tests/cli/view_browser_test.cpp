// The page of `lobe view` in a browser without a window, driven by WebDriver (chromedriver): every control is used as a
// person would, and what the page then shows is read. LOBE_VIEW_SCREENSHOTS names a folder for pictures of it.
#include <arpa/inet.h>
#include <fcntl.h>
#include <httplib.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <thread>

#include "cli/command_test.hpp"
#include "cli/view_server.hpp"

namespace lobe::test {
namespace {

using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;

/// A port that was free a moment ago: chromedriver tells which one it took, but only in prose.
int free_port() {
  const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  auto* const any = reinterpret_cast<sockaddr*>(&address);
  const bool is_bound = ::bind(socket, any, size) == 0 && ::getsockname(socket, any, &size) == 0;
  ::close(socket);
  EXPECT_TRUE(is_bound);
  return ntohs(address.sin_port);
}

/// A driver and a browser of its own.
class Browser {
 public:
  explicit Browser(const std::filesystem::path& profile) {
    port_ = free_port();
    driver_ = ::fork();
    if (driver_ == 0) {
      const int nothing = ::open("/dev/null", O_RDWR);
      ::dup2(nothing, STDOUT_FILENO);
      ::dup2(nothing, STDERR_FILENO);
      ::setpgid(0, 0);
      const std::string port = "--port=" + std::to_string(port_);
      ::execlp("chromedriver", "chromedriver", port.c_str(), static_cast<char*>(nullptr));
      ::_exit(127);
    }
    const Json options{{"args",
                        {"--headless=new", "--no-sandbox", "--enable-unsafe-swiftshader", "--disable-dev-shm-usage",
                         "--user-data-dir=" + profile.string(), "--window-size=1400,1000", "--no-first-run"}}};
    const Json wanted{
        {"capabilities",
         {{"alwaysMatch", {{"goog:chromeOptions", options}, {"goog:loggingPrefs", {{"browser", "ALL"}}}}}}}};
    for (int attempt = 0; attempt < 100 && session_.empty(); ++attempt) {
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
      const Json made = post("/session", wanted);
      if (made.contains("value")) session_ = "/session/" + made["value"].value("sessionId", "");
    }
    EXPECT_THAT(session_, Not(IsEmpty())) << "no browser";
  }
  ~Browser() {
    if (!session_.empty()) {
      httplib::Client client("127.0.0.1", port_);
      (void)client.Delete(session_);
    }
    ::kill(-driver_, SIGKILL);
    ::kill(driver_, SIGKILL);
    ::waitpid(driver_, nullptr, 0);
  }
  Browser(const Browser&) = delete;
  Browser& operator=(const Browser&) = delete;

  void open(const std::string& address) { (void)command("url", {{"url", address}}); }
  [[nodiscard]] Json evaluate(const std::string& script) {
    return command("execute/sync", {{"script", script}, {"args", Json::array()}});
  }
  /// The text of an element.
  [[nodiscard]] std::string text(const std::string& selector) {
    const Json found = evaluate("return document.querySelector(" + Json(selector).dump() + ")?.textContent ?? 'none'");
    return found.is_string() ? found.get<std::string>() : found.dump();
  }
  /// Types into an element, as keys of a keyboard.
  void type(const std::string& selector, const std::string& keys) {
    (void)command("element/" + element(selector) + "/value", {{"text", keys}});
  }
  void click(const std::string& selector) {
    (void)evaluate("document.querySelector(" + Json(selector).dump() + ").scrollIntoView({block: 'center'})");
    (void)command("element/" + element(selector) + "/click", Json::object());
  }
  /// Chooses an entry of a list, or sets a slider, a field or a box.
  void set(const std::string& selector, const std::string& value) {
    (void)evaluate("const field = document.querySelector(" + Json(selector).dump() +
                   "); field.value = " + Json(value).dump() + "; field.dispatchEvent(new Event('input')); " +
                   "field.dispatchEvent(new Event('change'));");
  }
  void resize(int width, int height) { (void)command("window/rect", {{"width", width}, {"height", height}}); }
  /// Waits until the page has all answers, and a script says yes.
  [[nodiscard]] bool settles(const std::string& condition = "true") {
    for (int i = 0; i < 2400; ++i) {
      if (evaluate("return document.body.dataset.busy === '0' && Boolean(" + condition + ")") == Json(true))
        return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    return false;
  }
  [[nodiscard]] Json log() { return command("se/log", {{"type", "browser"}}); }
  /// A picture of the whole page, where the environment asks for it.
  void picture(const std::string& name) {
    const char* folder = std::getenv("LOBE_VIEW_SCREENSHOTS");
    if (folder == nullptr) return;
    const Json size = evaluate("return [innerWidth, document.documentElement.scrollHeight]");
    const Json shot =
        command("goog/cdp/execute",
                {{"cmd", "Page.captureScreenshot"},
                 {"params",
                  {{"captureBeyondViewport", true},
                   {"clip", {{"x", 0}, {"y", 0}, {"width", size[0]}, {"height", size[1]}, {"scale", 1}}}}}});
    std::ofstream(std::string(folder) + "/" + name + ".base64") << shot.value("data", "");
  }
  /// As wide as a phone's page, which no window of the browser is.
  void be_phone() {
    (void)command("goog/cdp/execute",
                  {{"cmd", "Emulation.setDeviceMetricsOverride"},
                   {"params", {{"width", 380}, {"height", 800}, {"deviceScaleFactor", 1}, {"mobile", false}}}});
  }
  void be_dark() {
    (void)command("goog/cdp/execute",
                  {{"cmd", "Emulation.setEmulatedMedia"},
                   {"params", {{"features", {{{"name", "prefers-color-scheme"}, {"value", "dark"}}}}}}});
  }

 private:
  [[nodiscard]] Json post(const std::string& path, const Json& body) const {
    httplib::Client client("127.0.0.1", port_);
    constexpr time_t kMinute = 60;
    client.set_read_timeout(kMinute);
    const auto response = client.Post(path, body.dump(), "application/json");
    return response ? Json::parse(response->body, nullptr, false) : Json::object();
  }
  Json command(const std::string& name, const Json& body) {
    const Json answer = post(session_ + "/" + name, body);
    const bool is_right =
        answer.contains("value") && !(answer["value"].is_object() && answer["value"].contains("error"));
    EXPECT_TRUE(is_right) << name << " " << body.dump().substr(0, 200) << "\n" << answer.dump().substr(0, 500);
    return is_right ? answer["value"] : Json();
  }
  [[nodiscard]] std::string element(const std::string& selector) {
    const Json found = command("element", {{"using", "css selector"}, {"value", selector}});
    return found.is_object() && !found.empty() ? found.begin().value().get<std::string>() : "none";
  }

  int port_ = 0;
  pid_t driver_ = -1;
  std::string session_;
};

/// Rows of a gloss lobe with deviations: at 30 degrees all around, and eight in the plane of incidence for 60.
void write_rows(const std::filesystem::path& path) {
  std::ofstream file(path);
  file << "theta_in_deg,theta_out_deg,delta_phi_deg,grey,grey_std\n";
  const auto write = [&](double theta_in, double theta_out, double delta_phi) {
    const double value =
        0.1 + std::exp(-std::pow((theta_out - theta_in) / 10, 2) - std::pow((delta_phi - 180) / 20, 2));
    file << theta_in << ',' << theta_out << ',' << delta_phi << ',' << value << ',' << value / 20 << '\n';
  };
  for (const double theta_out : {5., 20., 28., 33., 45.}) {
    for (const double delta_phi : {30., 75., 140., 172., 180.}) write(30, theta_out, delta_phi);
  }
  for (const double theta_out : {10., 25., 40., 55., 60.5, 70., 80.}) write(60, theta_out, 180);
  write(59, 50, 0);
}

/// Difference of a sphere that moves from the one at rest, in levels of 255, up to 0.97 of its radius.
struct LevelsOff {
  int largest = 0;
  double above_two = 0;  ///< share of the levels that are off by more than two
};

/// Differences of all spheres on the page, which the graphics processor draws while they move, if only one of software.
std::vector<LevelsOff> levels_off_while_moving(Browser& browser, int spheres) {
  const std::string levels =
      "return [...document.querySelectorAll('#sphere-row canvas')].map((one) => {"
      "  const size = one.width; const image = one.getContext('2d').getImageData(0, 0, size, size).data;"
      "  const inside = []; for (let y = 0; y < size; ++y) for (let x = 0; x < size; ++x) {"
      "    if (Math.hypot(x + 0.5 - size / 2, y + 0.5 - size / 2) < 0.97 * size / 2)"
      "      for (let c = 0; c < 3; ++c) inside.push(image[4 * (y * size + x) + c]); } return inside; })";
  const Json exact = browser.evaluate(levels);
  const Json frames = browser.evaluate("return gpu.frames");
  const Json moving = browser.evaluate("isInGesture = true; drawMoving(); " + levels);
  (void)browser.evaluate("endGesture()");
  EXPECT_EQ(browser.evaluate("return gpu.frames").get<int>(), frames.get<int>() + spheres);
  std::vector<LevelsOff> off;
  for (std::size_t i = 0; i < std::min(exact.size(), moving.size()); ++i) {
    LevelsOff& one = off.emplace_back();
    EXPECT_EQ(moving.at(i).size(), exact.at(i).size()) << i;
    for (std::size_t k = 0; k < exact.at(i).size(); ++k) {
      const int difference = std::abs(moving.at(i).at(k).get<int>() - exact.at(i).at(k).get<int>());
      one.largest = std::max(one.largest, difference);
      if (difference > 2) one.above_two += 1;
    }
    one.above_two /= static_cast<double>(exact.at(i).size());
  }
  return off;
}

class ViewPage : public CommandTest {
 protected:
  [[nodiscard]] std::filesystem::path here() const { return file(""); }
};

TEST_F(ViewPage, DoesWhatAPersonAsks) {
  make({"export", "ggx:alpha=0.4", "--format", "csv", "-o", "ggx.csv"});
  write_rows(file("rows.csv"));
  const ViewProcess view({"ggx:alpha=0.3", "ward:m=0.2"}, here());
  Browser browser(file("profile"));
  browser.open(view.address());
  ASSERT_TRUE(browser.settles("document.querySelectorAll('#distance-table td').length === 4"));

  // What stands there at first.
  EXPECT_EQ(browser.evaluate("return [...document.querySelectorAll('#cards .name')].map((one) => one.textContent)"),
            Json({"ggx:alpha=0.3", "ward:m=0.2"}));
  EXPECT_THAT(browser.text("#checks"), AllOf(HasSubstr("plausible"), HasSubstr(" ± ")));
  EXPECT_THAT(browser.text("#distance-table"), AllOf(HasSubstr(" ± "), HasSubstr("angle"), HasSubstr("√sr")));
  EXPECT_EQ(browser.evaluate("return document.querySelectorAll('#plane-picture path').length"), Json(4));
  EXPECT_EQ(browser.evaluate("return document.querySelectorAll('#albedo-picture path').length"), Json(4));
  // The grey reference is shown at half of the display's range; the spheres differ.
  const Json pixels = browser.evaluate(
      "return [...document.querySelectorAll('#sphere-row canvas')].map((one) => {"
      "  const image = one.getContext('2d').getImageData(0, 0, one.width, one.height).data;"
      "  const covered = []; for (let i = 0; i < image.length; i += 4) covered.push(image[i]);"
      "  return covered.sort((a, b) => a - b); })");
  ASSERT_EQ(pixels.size(), 3U);
  EXPECT_NE(pixels.at(1), pixels.at(2));
  EXPECT_EQ(browser.evaluate("return document.querySelectorAll('#slice-row canvas').length"), Json(2));
  browser.picture("wide");

  // A slider changes the material, and everything that depends on it.
  const std::string before = browser.text("#checks");
  (void)browser.evaluate(
      "window.sent = []; const send = window.fetch;"
      "window.fetch = (url, options) => { window.sent.push(...JSON.parse(options.body).questions); return send(url, "
      "options); };"
      "window.drawings = 0; const draw = window.drawSlices; window.drawSlices = () => { window.drawings += 1; draw(); "
      "};");
  browser.set("#p-0-0", "0.9");
  ASSERT_TRUE(browser.settles());
  EXPECT_THAT(browser.text("#cards .name"), AllOf(StartsWith("ggx:alpha="), Not(EndsWith("=0.3"))));
  // What was answered of the other material is not asked again, and both are drawn at once.
  EXPECT_EQ(browser.evaluate("return window.sent.filter((one) => one.material === 'ward:m=0.2').length"), Json(0));
  EXPECT_GT(browser.evaluate("return window.sent.filter((one) => one.kind === 'slice').length"), Json(0));
  EXPECT_EQ(browser.evaluate("return window.drawings"), Json(1));
  // A drawing that fails leaves the others, and the page settles.
  (void)browser.evaluate(
      "window.drawn = 0; drawNext(() => { throw new Error('planted'); }); drawNext(() => { drawn += 1; });");
  ASSERT_TRUE(browser.settles("window.drawn === 1"));
  EXPECT_THAT(browser.log().dump(), HasSubstr("planted"));
  EXPECT_NE(browser.text("#checks"), before);
  const auto edited = browser.evaluate("return document.querySelector('#specification').value").get<std::string>();
  EXPECT_THAT(edited, StartsWith("ggx:alpha=0."));
  browser.click("#undo");
  ASSERT_TRUE(browser.settles());
  EXPECT_EQ(browser.text("#cards .name"), "ggx:alpha=0.3");
  EXPECT_EQ(browser.text("#checks"), before);
  browser.click("#redo");
  ASSERT_TRUE(browser.settles());
  EXPECT_EQ(browser.text("#cards .name"), edited);

  // The specification may be typed, and a wrong one is told of while the material stays.
  browser.set("#specification", "lambert:scale=0.2+phong:n=30,scale=0.5*cos_max@normalise");
  browser.click("#specification-form button");
  ASSERT_TRUE(browser.settles("document.querySelectorAll('#terms fieldset').length === 2"));
  EXPECT_THAT(browser.text("#terms"), AllOf(HasSubstr("times cos_max"), HasSubstr("@normalise")));
  browser.set("#specification", "phng:n=2");
  browser.click("#specification-form button");
  ASSERT_TRUE(browser.settles());
  EXPECT_THAT(browser.text("#specification-error"), HasSubstr("unknown model 'phng'"));
  EXPECT_THAT(browser.text("#cards .name"), StartsWith("lambert:scale=0.2"));

  // Terms, factors and colours by buttons.
  browser.set("#add-term", "oren_nayar");
  ASSERT_TRUE(browser.settles("document.querySelectorAll('#terms fieldset').length === 3"));
  browser.click("#terms fieldset .buttons button");
  ASSERT_TRUE(browser.settles());
  EXPECT_THAT(browser.text("#cards .name"), StartsWith("lambert:scale=0.2/0.2/0.2+"));
  browser.click("#terms fieldset legend button");
  ASSERT_TRUE(browser.settles("document.querySelectorAll('#terms fieldset').length === 2"));

  // The plane of incidence.
  browser.set("#theta", "60");
  browser.set("#scale", "log");
  browser.set("#quantity", "fcos");
  ASSERT_TRUE(browser.settles());
  EXPECT_THAT(browser.evaluate("return document.querySelector('#plane-picture svg').getAttribute('aria-label')").dump(),
              HasSubstr("60°"));
  EXPECT_THAT(browser.text("#plane-picture"), HasSubstr("f cos θ out"));
  browser.set("#form", "polar");
  ASSERT_TRUE(browser.settles("document.querySelector('#plane-picture').textContent.includes('light')"));
  browser.picture("polar");
  browser.set("#form", "cartesian");
  browser.set("#scale", "cbrt");
  browser.click("#compose");
  ASSERT_TRUE(browser.settles("document.querySelectorAll('#plane-picture path').length === 8"));
  EXPECT_THAT(browser.text("#plane-note"), HasSubstr("Long dashes"));
  (void)browser.evaluate(
      "const svg = document.querySelector('#plane-picture svg'); const box = svg.getBoundingClientRect();"
      "svg.dispatchEvent(new PointerEvent('pointermove', {clientX: box.left + box.width * 0.7, clientY: box.top + "
      "50}))");
  ASSERT_TRUE(browser.settles("document.querySelector('#value').textContent.includes('1/sr')"));
  EXPECT_THAT(browser.text("#value"), AllOf(HasSubstr("From 60° to"), HasSubstr("B: ")));

  // Answers come in any order, and one that cannot be shown leaves the page able to settle.
  EXPECT_EQ(browser.evaluate(
                "const had = [...lobes]; document.querySelector('#lobe-row').replaceChildren();"
                "lobes.length = 0; lobes.length = 2; lobes[1] = had[1]; drawLobes(); lobes[0] = had[0]; drawLobes();"
                "return document.querySelectorAll('#lobe-row canvas').length"),
            Json(2));
  EXPECT_EQ(browser.evaluate("return ask('nobody', 'slice', { material: state.materials[0] },"
                             "  () => { throw new Error('as planned'); }).catch((error) => error.message)"),
            Json("as planned"));
  ASSERT_TRUE(browser.settles());
  const std::string lobe = "return document.querySelector('#lobe-row canvas').toDataURL()";
  const Json facing = browser.evaluate(lobe);
  EXPECT_GT(facing.get<std::string>().size(), 4000U);
  browser.set("#eye-turn", "100");
  ASSERT_TRUE(browser.settles());
  EXPECT_NE(browser.evaluate(lobe), facing);
  browser.set("#domain", "60");
  ASSERT_TRUE(browser.settles());
  EXPECT_THAT(browser.text("#distance-table"), HasSubstr(" ± "));
  EXPECT_THAT(browser.evaluate("return commandText()").get<std::string>(), HasSubstr("--domain-theta-max 60"));
  browser.set("#domain", "90");

  // Lights.
  const std::string sphere = "return document.querySelectorAll('#sphere-row canvas')[2].toDataURL()";
  const Json lit = browser.evaluate(sphere);
  browser.set("#light-colour", "#ff0000");
  browser.set("#light-azimuth", "90");
  ASSERT_TRUE(browser.settles());
  EXPECT_NE(browser.evaluate(sphere), lit);
  browser.set("#light-mode", "daylight");
  ASSERT_TRUE(browser.settles());

  // What moves is drawn by the graphics processor, if only by one of software, within 2 levels of the library's spheres
  // up to 0.97 of their radius: beyond, the library takes means over pixels that the shader does not.
  browser.set("#light-mode", "both");
  ASSERT_TRUE(browser.settles("gpu !== null && isMovedByGpu(0) && isMovedByGpu(1) && isMovedByGpu(2)"));
  const auto off = levels_off_while_moving(browser, 3);
  ASSERT_EQ(off.size(), 3U);
  for (std::size_t i = 0; i < off.size(); ++i) EXPECT_LE(off[i].largest, 2) << "sphere " << i;
  ASSERT_TRUE(browser.settles());
  browser.set("#light-mode", "daylight");
  ASSERT_TRUE(browser.settles());

  // A scene that refines, though the page has settled; another material, and one of the page's edits.
  const std::string drawn = "document.body.dataset.drawing === '0' && !document.querySelector('#scene-picture').hidden";
  const std::string picture = "return document.querySelector('#scene-picture').src";
  browser.set("#scene-samples", "16");
  browser.click("#scene-draw");
  ASSERT_TRUE(browser.settles(drawn + " && scenePicture.samples >= 16"));
  EXPECT_THAT(browser.text("#scene-note"),
              AllOf(HasSubstr(": 16 samples in each of 240 × 128 pixels"), HasSubstr(" ± ")));
  const Json first = browser.evaluate(picture);
  EXPECT_THAT(first.get<std::string>(), StartsWith("data:image/png;base64,"));
  EXPECT_EQ(browser.evaluate("return document.querySelector('#scene-picture').naturalWidth"), Json(240));
  browser.click("#cards li:last-child .name");
  ASSERT_TRUE(browser.settles(drawn + " && scenePicture.material === 'ward:m=0.2'"));
  EXPECT_NE(browser.evaluate(picture), first);
  EXPECT_THAT(browser.evaluate("return commandText()").get<std::string>(),
              HasSubstr("lobe render lobe-view.toml --replace thing=ward:m=0.2 --width 240 --samples 16 -o scene.png"));
  browser.picture("scene");
  browser.click("#cards .name");
  browser.set("#scene-replaced", "0");
  ASSERT_TRUE(browser.settles(drawn + " && scenePicture.replaced === 'ground' && scenePicture.samples >= 16"));

  // A link restores all of it.
  const Json link = browser.evaluate("return location.href");
  const std::string shown = browser.text("#distance-table");
  browser.open("about:blank");
  browser.open(link.get<std::string>());
  ASSERT_TRUE(browser.settles("document.querySelectorAll('#distance-table td').length === 4"));
  EXPECT_EQ(browser.text("#distance-table"), shown);
  ASSERT_TRUE(browser.settles(drawn + " && scenePicture.replaced === 'ground' && scenePicture.samples >= 16"));
  browser.click("#scene-draw");
  ASSERT_TRUE(browser.settles("document.querySelector('#scene-picture').hidden"));
  EXPECT_EQ(browser.text("#scene-note"), "");
  // Of a link that makes no sense what makes some counts.
  EXPECT_EQ(browser.evaluate("return [null, {index: 'length', replaced: -1, samples: 64.5, draw: 1}, {index: 7},"
                             "  {index: 0, replaced: 0, samples: 256, draw: true}].map(sceneOf)"),
            Json::parse(R"([{"draw": false, "index": 0, "replaced": 1, "samples": 64},
                            {"draw": false, "index": 0, "replaced": 1, "samples": 64},
                            {"draw": false, "index": 0, "replaced": 1, "samples": 64},
                            {"draw": true, "index": 0, "replaced": 0, "samples": 256}])"));
  EXPECT_EQ(
      browser.evaluate("return [document.querySelector('#theta').value, document.querySelector('#light-mode').value]"),
      Json({"60", "daylight"}));

  // A file, the nearest, a fit.
  browser.type("#file", file("ggx.csv").string());
  ASSERT_TRUE(browser.settles("document.querySelectorAll('#cards li').length === 3"));
  EXPECT_THAT(browser.text("#cards"), HasSubstr("ggx.csv"));
  EXPECT_THAT(browser.text("#terms"), HasSubstr("csv"));
  browser.click("#find-nearest");
  ASSERT_TRUE(browser.settles("document.querySelectorAll('#nearest-list li').length === 3"));
  EXPECT_THAT(browser.text("#nearest-list li"), StartsWith("ggx.csv"));
  EXPECT_THAT(browser.text("#nearest-note"), StartsWith("Nearest to ggx.csv of 3 materials"));
  browser.set("#family", "phong");
  browser.set("#fit-target", "ward:m=0.2");
  browser.click("#fit-form button");
  ASSERT_TRUE(browser.settles("document.querySelectorAll('#cards li').length === 4"));
  EXPECT_THAT(browser.text("#fit-note"), AllOf(StartsWith("phong:n="), HasSubstr("of the norm of ward:m=0.2")));
  EXPECT_THAT(browser.evaluate("return commandText()").get<std::string>(),
              AllOf(StartsWith("lobe view "), HasSubstr("ggx.csv"), HasSubstr("lobe distance ")));
  // One that takes seconds says how far it is, and may be given up.
  browser.set("#family", "ward+ward+phong+oren_nayar");
  browser.set("#fit-target", browser.evaluate("return state.materials[2]").get<std::string>());
  browser.click("#fit-form button");
  const std::string curves = "return document.querySelectorAll('#plane-picture path').length";
  const Json without = browser.evaluate(curves);
  bool has_told = false;
  for (int i = 0; i < 400 && !has_told; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    has_told = browser.text("#fit-note").find(" %; so far ward:") != std::string::npos;
  }
  EXPECT_TRUE(has_told) << browser.text("#fit-note");
  EXPECT_THAT(browser.text("#fit-note"), StartsWith("Fits ward+ward+phong+oren_nayar to ggx.csv"));
  EXPECT_GT(browser.evaluate(curves).get<int>(), without.get<int>());
  browser.click("#fit-cancel");
  ASSERT_TRUE(browser.settles());
  EXPECT_EQ(browser.text("#fit-note"), "");
  EXPECT_EQ(browser.evaluate(curves), without);
  browser.picture("four");

  // Rows of a measurement are dots over the curves.
  browser.type("#file", file("rows.csv").string());
  ASSERT_TRUE(browser.settles("document.querySelectorAll('#cards li').length === 5"));
  EXPECT_EQ(browser.evaluate("return document.querySelectorAll('#plane-picture circle.dot').length"), Json(8));
  EXPECT_THAT(browser.text("#samples-note"), StartsWith("Dots: 8 samples within 1.5°"));
  browser.set("#form", "polar");
  ASSERT_TRUE(browser.settles());
  EXPECT_EQ(browser.evaluate("return document.querySelectorAll('#plane-picture circle.dot').length"), Json(8));
  browser.set("#form", "cartesian");
  browser.picture("dots");
  browser.click("#cards li:last-child button:last-child");
  ASSERT_TRUE(browser.settles("document.querySelectorAll('#plane-picture circle.dot').length === 0"));

  // A metal to start from; a table of it.
  browser.set("#add", "ggx_fresnel:alpha=0.2,ior=0.17/0.4/1.45,k=3.2/2.4/1.9");
  ASSERT_TRUE(browser.settles("document.querySelectorAll('#cards li').length === 5"));
  EXPECT_THAT(browser.text("#checks"), HasSubstr("ggx_fresnel"));
  browser.click("#save-table");
  ASSERT_TRUE(browser.settles());
  EXPECT_THAT(browser.text("#message"), HasSubstr("is saved on the grid gauss:64x128"));
  browser.click("#cards li:last-child button:last-child");
  ASSERT_TRUE(browser.settles("document.querySelectorAll('#cards li').length === 4"));
  browser.click("#cards li:last-child .name");
  ASSERT_TRUE(browser.settles());

  // Many channels: a spectrum at the pair that is pointed at.
  browser.set("#specification", "lambert:scale=0.1/0.2/0.3/0.4/0.5/0.6/0.7/0.8");
  browser.click("#specification-form button");
  ASSERT_TRUE(browser.settles("document.querySelector('#checks').textContent.includes('(8 channels)')"));
  (void)browser.evaluate("showValue(30)");
  ASSERT_TRUE(browser.settles("document.querySelectorAll('#spectrum-picture path').length === 2"));
  EXPECT_THAT(browser.text("#value"), HasSubstr("0.031830989 / … / 0.25464791 (8 channels)"));
  browser.click("#undo");
  ASSERT_TRUE(browser.settles());
  EXPECT_THAT(browser.text("#value"), StartsWith("Point at"));
  EXPECT_EQ(browser.text("#spectrum-picture"), "");

  // As wide as a phone: nothing sticks out. In the dark.
  browser.be_phone();
  browser.be_dark();
  ASSERT_TRUE(browser.settles());
  EXPECT_EQ(browser.evaluate("return document.documentElement.scrollWidth - document.documentElement.clientWidth"),
            Json(0));
  browser.picture("phone");

  // Everything that takes a value has a name for those who do not see it.
  EXPECT_EQ(
      browser.evaluate("return [...document.querySelectorAll('input, select, button')].filter((one) =>"
                       " !(one.labels?.length > 0) && !one.getAttribute('aria-label') && one.textContent.trim() === '')"
                       ".map((one) => one.outerHTML)"),
      Json::array());
  // Nothing came from elsewhere, and the browser had nothing to complain of.
  const Json loaded = browser.evaluate("return performance.getEntriesByType('resource').map((one) => one.name)");
  EXPECT_GT(loaded.size(), 10U);
  for (const auto& name : loaded) EXPECT_THAT(name.get<std::string>(), StartsWith(view.address())) << name;
  for (const auto& entry : browser.log()) {
    // Warnings are of the driver, about the test's own reading of pixels. Refusals are answers with a status, which the
    // browser's log counts as errors.
    if (entry.value("level", "") != "SEVERE") continue;
    EXPECT_THAT(entry.value("message", ""), HasSubstr("422")) << entry.dump();
  }
}

TEST_F(ViewPage, MovesTablesFilesAndAnisotropicMaterials) {
  make({"export", "ggx:alpha=0.3", "--format", "csv", "-o", "ggx.csv"});
  make({"tabulate", "ward_anisotropic:m_x=0.2,m_y=0.5", "--grid", "gauss:24x48", "-o", "brushed.h5"});
  Browser browser(file("profile"));
  struct Case {
    std::vector<std::string> materials;
    int largest;
    double above_two;
  };
  // Between nodes of a texture anisotropic lobes are off by more, mostly where light grazes.
  for (const auto& [materials, largest, above_two] :
       {Case{{"ggx.csv", "ggx:alpha=0.5@turquin", "ggx:alpha=0.3@pump"}, 2, 0},
        Case{{"ward_anisotropic:m_x=0.2,m_y=0.5"}, 2, 0}, Case{{"brushed.h5"}, 10, 0.02}}) {
    const ViewProcess view(materials, here());
    browser.open(view.address());
    ASSERT_TRUE(browser.settles()) << materials.front();
    browser.set("#light-mode", "both");
    ASSERT_TRUE(browser.settles("gpu !== null && sphereTexts().every((_, i) => isMovedByGpu(i))")) << materials.front();
    const auto off = levels_off_while_moving(browser, static_cast<int>(materials.size()) + 1);
    ASSERT_EQ(off.size(), materials.size() + 1) << materials.front();
    for (std::size_t i = 0; i < off.size(); ++i) {
      EXPECT_LE(off[i].largest, largest) << materials.front() << ", sphere " << i;
      EXPECT_LE(off[i].above_two, above_two) << materials.front() << ", sphere " << i;
    }
    (void)browser.evaluate("isInGesture = true; drawMoving()");
    browser.picture("moving_" + materials.front());
  }
}

TEST_F(ViewPage, DrawsDraftsOfWhatTheGraphicsProcessorCannotYetDraw) {
  const ViewProcess view({"lambert", "ggx:alpha=0.3"}, here());
  Browser browser(file("profile"));
  browser.open(view.address());
  const std::string is_moved = "gpuParts[2].text === state.materials[1] && isMovedByGpu(2)";
  ASSERT_TRUE(browser.settles("gpu !== null && " + is_moved));
  const auto become = [&](const std::string& text, bool is_gesture) {
    (void)browser.evaluate("change((now) => { now.materials[1] = '" + text + "'; }, " +
                           (is_gesture ? "true" : "false") + ")");
  };
  const auto constants = [&] { return browser.evaluate("return gpuParts[2].shader.constants"); };

  // A slider that is faster than the answers: the newest is what stays.
  const Json first = constants();
  for (const char* text : {"ggx:alpha=0.4", "ggx:alpha=0.5", "ggx:alpha=0.6"}) become(text, true);
  ASSERT_TRUE(browser.settles(is_moved));
  const Json last = constants();
  become("lambert", false);
  ASSERT_TRUE(browser.settles(is_moved));
  become("ggx:alpha=0.6", false);
  ASSERT_TRUE(browser.settles(is_moved));
  EXPECT_EQ(constants(), last);
  EXPECT_NE(last, first);
  become("ggx:alpha=0.3", true);
  ASSERT_TRUE(browser.settles(is_moved));
  EXPECT_EQ(constants(), first);

  // A texture is made when the slider rests.
  const std::string is_draft =
      "!(" + is_moved + ") && document.querySelectorAll('#sphere-row canvas')[2].width === draftSize";
  become("ggx:alpha=0.3@pump", true);
  ASSERT_TRUE(browser.settles(is_draft));
  (void)browser.evaluate("endGesture()");
  ASSERT_TRUE(browser.settles(is_moved + " && gpuParts[2].shader.numbers !== undefined"));
  become("ggx:alpha=0.4@pump", true);
  ASSERT_TRUE(browser.settles(is_draft));
  (void)browser.evaluate("endGesture()");
  ASSERT_TRUE(browser.settles(is_moved));
  // Also where the slider passes other places while it is made.
  become("ggx:alpha=0.45@pump", false);
  become("ggx:alpha=0.5@pump", true);
  become("ggx:alpha=0.45@pump", true);
  (void)browser.evaluate("endGesture()");
  ASSERT_TRUE(browser.settles(is_moved + " && gpuParts[2].shader.numbers !== undefined"));

  // What was there before draws nothing of another material.
  become("ward_anisotropic:m_x=0.2,m_y=0.5", false);
  ASSERT_TRUE(browser.settles(is_moved + " && gpuParts[2].sky.azimuths > 1"));
  browser.set("#light-mode", "daylight");
  become("ward_anisotropic:m_x=0.3,m_y=0.5", true);
  ASSERT_TRUE(browser.settles(is_draft));
  (void)browser.evaluate("endGesture()");
  ASSERT_TRUE(browser.settles(is_moved));
  become("mirror", false);
  ASSERT_TRUE(browser.settles("!(" + is_moved + ")"));
  become("ggx:alpha=0.3", false);
  ASSERT_TRUE(browser.settles(is_moved + " && gpuParts[2].sky.azimuths === 1"));
  EXPECT_EQ(constants(), first);
}

TEST_F(ViewPage, SaysWhenTheCommandHasEnded) {
  ViewProcess view({"lambert"}, here());
  Browser browser(file("profile"));
  browser.open(view.address());
  ASSERT_TRUE(browser.settles("document.querySelectorAll('#checks dd').length > 1"));
  EXPECT_EQ(view.end(), 0);
  browser.set("#specification", "phong:n=3");
  browser.click("#specification-form button");
  ASSERT_TRUE(browser.settles());
  EXPECT_THAT(browser.text("#specification-error"), HasSubstr("the command no longer answers"));
}

}  // namespace
}  // namespace lobe::test
