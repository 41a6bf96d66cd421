// The server of `lobe view`: who is let in, what is answered, and how it ends.
#include <arpa/inet.h>
#include <httplib.h>
#include <sched.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <numbers>
#include <optional>
#include <thread>

#include "cli/command_test.hpp"
#include "cli/view_server.hpp"
#include "lobe/core/error.hpp"
#include "support/environment.hpp"
#include "view/kept_answers.hpp"

namespace lobe::test {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::Gt;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr int kForbidden = 403;
constexpr int kStale = 409;
constexpr int kRefused = 422;

class View : public CommandTest {
 protected:
  [[nodiscard]] std::filesystem::path here() const { return file(""); }
};

Json material(const std::string& text) {
  return {{"material", text}};
}

/// A connection that sends what it is told to, and is read to its end.
class RawClient {
 public:
  RawClient(int port, const std::string& text) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    is_connected_ = ::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 &&
                    ::send(socket_, text.data(), text.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(text.size());
  }
  ~RawClient() {
    if (socket_ >= 0) ::close(socket_);
  }
  RawClient(const RawClient&) = delete;
  RawClient(RawClient&& other) noexcept : socket_(other.socket_), is_connected_(other.is_connected_) {
    other.socket_ = -1;
  }

  [[nodiscard]] bool is_connected() const { return is_connected_; }
  /// Reads up to a text. \return whether it comes
  [[nodiscard]] bool reads(const std::string& text) const {
    std::string all;
    char letter = 0;
    while (!all.ends_with(text) && ::recv(socket_, &letter, 1, 0) == 1) all += letter;
    return all.ends_with(text);
  }
  /// "HTTP/1.1 403 Forbidden"
  [[nodiscard]] std::string status_line() const {
    std::string line;
    char letter = 0;
    while (::recv(socket_, &letter, 1, 0) == 1 && letter != '\r') line += letter;
    return line;
  }

 private:
  int socket_;
  bool is_connected_ = false;
};

TEST_F(View, TellsSamplesNearThePlaneOfIncidence) {
  std::ofstream(file("rows.csv"))
      << "theta_in_deg,theta_out_deg,delta_phi_deg,red,green,blue,red_std,green_std,blue_std\n"
         "30,40,180,1,2,3,0.1,0.2,0.3\n"
         "40.5,30,180,2,4,6,0.1,0.1,0.1\n"  // by reciprocity, at 40.5
         "31,50,1.5,3,3,3,0,0,0\n"          // on the side of the light
         "30,50,20,4,4,4,0,0,0\n"           // off the plane
         "30,0,77,5,5,5,0,0,0\n"            // along the normal there is no azimuth
         "33,60,180,6,6,6,0,0,0\n"          // another angle of light
         "30.2,30.4,180,7,7,7,0,0,0\n"      // both angles: once
         "50,60,90,8,8,8,0,0,0\n";
  const ViewProcess view({"rows.csv", "lambert"}, here());
  const auto found = view.ask("samples", {{"material", "file:1"}, {"theta_in", 30}});
  ASSERT_EQ(found.status, 200) << found.body.dump();
  std::vector<std::pair<double, double>> values;
  for (const auto& one : found.body["samples"]) {
    values.emplace_back(one["theta_out"].get<double>(), one["value"].get<double>());
  }
  constexpr double kRed = 0.2126;
  constexpr double kGreen = 0.7152;
  constexpr double kBlue = 0.0722;
  const double luminance = kRed + 2 * kGreen + 3 * kBlue;
  const auto near = [](double angle, double value) {
    return ::testing::Pair(::testing::DoubleNear(angle, 1e-9), ::testing::DoubleNear(value, 1e-9));
  };
  EXPECT_THAT(values, ::testing::ElementsAre(near(40, luminance), near(40.5, 2 * luminance), near(-50, 3), near(0, 5),
                                             near(30.4, 7)));
  const double deviation = std::hypot(0.1 * kRed, 0.2 * kGreen, 0.3 * kBlue);
  EXPECT_NEAR(found.body["samples"][0]["deviation"].get<double>(), deviation, 1e-12);
  EXPECT_THAT(view.ask("samples", {{"material", "lambert"}, {"theta_in", 30}}).body["samples"], IsEmpty());
}

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

std::string decoded(const std::string& base64) {
  std::string bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char letter : base64) {
    constexpr std::string_view kLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const auto value = kLetters.find(letter);
    if (value == std::string_view::npos) break;
    bits = bits << 6 | static_cast<std::uint32_t>(value);
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += static_cast<char>(bits >> count & 0xff);
  }
  return bytes;
}

TEST_F(View, RefinesAScene) {
  std::ofstream(file("ball.toml")) << "[camera]\nposition = [0, -5, 2]\ntarget = [0, 0, 1]\nsize = [40, 30]\n"
                                      "[materials]\na = \"lambert:scale=0.4\"\nb = \"lambert:scale=0.9\"\n"
                                      "[sky]\nradiance = 0.5\n[[light]]\nposition = [-2, -3, 5]\nintensity = 20\n"
                                      "[[plane]]\nmaterial = \"a\"\ncentre = [0, 0, 0]\n"
                                      "[[sphere]]\nmaterial = \"b\"\ncentre = [0, 0, 1]\nradius = 1\n";
  const ViewProcess view({"lambert", "--scene", "ball.toml"}, here());
  const auto told = view.ask("catalogue", Json::object()).body;
  EXPECT_EQ(told["has_given_scene"], true);
  ASSERT_EQ(told["scenes"].size(), 2U);
  EXPECT_EQ(told["scenes"][0]["word"], "ball.toml");
  EXPECT_EQ(told["scenes"][0]["materials"], Json({"a", "b"}));
  EXPECT_EQ(told["scenes"][0]["replaced"], 1);  // that of the ball, not of the ground
  EXPECT_EQ(told["scenes"][0]["text"], "");

  // Asked again and again, it has the samples that are wanted, and is the picture that the command draws.
  const auto scene = [&](int samples, const std::string& text, int which = 0, int replaced = 1) {
    return view.ask(
        "scene", {{"scene", which}, {"replaced", replaced}, {"material", text}, {"width", 20}, {"samples", samples}});
  };
  const auto refined = [&](int samples, const std::string& text, int which) {
    Json body = Json::object();
    for (int i = 0; i < 1000 && body.value("samples", 0) < samples; ++i) body = scene(samples, text, which).body;
    return body;
  };
  const std::string gloss = "phong:n=20,scale=0.1/0.5/0.9";
  EXPECT_GE(scene(2, gloss).body["samples"].get<int>(), 2);
  const Json body = refined(24, gloss, 0);
  ASSERT_EQ(body.value("samples", 0), 24) << body.dump().substr(0, 500);
  EXPECT_EQ(body["width"], 20);
  EXPECT_EQ(body["height"], 15);
  const Json drawn =
      json({"render", "ball.toml", "--replace", "b=" + gloss, "--width", "20", "--samples", "24", "-o", "a.png"});
  EXPECT_EQ(decoded(body["png"]), bytes_of(file("a.png")));
  EXPECT_EQ(body["mean_radiance"], drawn["mean_radiance"]);
  EXPECT_EQ(body["noise"], drawn["relative_noise"]);
  const double green = body["mean_radiance"][1]["value"];
  EXPECT_GT(body["mean_luminance"]["value"], 0.7152 * green);
  EXPECT_NEAR(body["mean_luminance"]["value"],
              0.2126 * body["mean_radiance"][0]["value"].get<double>() + 0.7152 * green +
                  0.0722 * body["mean_radiance"][2]["value"].get<double>(),
              1e-12);
  EXPECT_EQ(body["exposure"], drawn["exposure"]);
  EXPECT_NE(scene(24, "lambert").body["png"], body["png"]);
  EXPECT_NE(scene(24, gloss, 0, 0).body["png"], body["png"]);

  // The one that is built in can be saved, and drawn by the command.
  const Json own = told["scenes"][1];
  std::ofstream(file(own["word"])) << own["text"].get<std::string>();
  const Json built_in = refined(4, "ggx:alpha=0.2", 1);
  const std::string name = own["materials"][1];
  make({"render", own["word"], "--replace", name + "=ggx:alpha=0.2", "--width", "20", "--samples",
        std::to_string(built_in.value("samples", 0)), "-o", "b.png"});
  EXPECT_EQ(decoded(built_in["png"]), bytes_of(file("b.png")));

  const auto expect_refused = [](const ViewProcess::Answer& answer, const std::string& reason) {
    EXPECT_EQ(answer.status, kRefused) << answer.body.dump();
    EXPECT_THAT(answer.body.dump(), HasSubstr(reason));
  };
  Json thin{{"scene", 0}, {"replaced", 1}, {"material", "lambert"}, {"width", 1}, {"samples", 2}};
  EXPECT_EQ(view.ask("scene", thin).body["height"], 1);
  thin["samples"] = 2.5;
  expect_refused(view.ask("scene", thin), "'samples' in a question is not right; expected a whole number");
  expect_refused(scene(4, "lambert", 2), "'scene' in a question is not right; expected a number from 0 to 1");
  expect_refused(scene(4, "lambert", 0, 2), "'replaced' in a question is not right");
  expect_refused(scene(1, "lambert"), "'samples' in a question is not right");
  expect_refused(scene(4, "lambert:scale=1/0"), "2 channels without a colour");
  Json half{{"scene", 0.5}, {"replaced", 0}, {"material", "lambert"}, {"width", 20}, {"samples", 2}};
  expect_refused(view.ask("scene", half), "expected a whole number");
}

TEST_F(View, TellsHowFarAnAnswerIs) {
  const ViewProcess view({"lambert"}, here());
  const auto progress = [&](const std::string& slot) { return view.ask("progress", {{"of", slot}}); };
  EXPECT_EQ(progress("page fit").body, Json::object());
  // With five scales and parameters to find it takes seconds; nobody waits for its end.
  std::thread fit([&] {
    const auto answer =
        view.ask("fit", {{"material", "ggx:alpha=0.3+phong:n=40,scale=0.2+oren_nayar:sigma=0.4,scale=0.3"},
                         {"family", "ward+ward+lambert"},
                         {"theta_in", 60},
                         {"slot", "page fit"},
                         {"number", 1}});
    EXPECT_EQ(answer.status, kStale) << answer.body.dump();
  });
  std::vector<double> shares;
  std::vector<Json> best;
  for (int i = 0; i < 600 && (shares.size() < 2 || best.size() < 2); ++i) {
    const auto answer = progress("page fit");
    EXPECT_EQ(answer.status, 200) << i;
    if (answer.body.contains("best") && (best.empty() || best.back() != answer.body["best"]))
      best.push_back(answer.body["best"]);
    const double share = answer.body.value("share", -1.0);
    if (share >= 0 && (shares.empty() || share > shares.back())) shares.push_back(share);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  EXPECT_GE(shares.size(), 2U);
  for (const double share : shares) EXPECT_LE(share, 1);
  // The best members so far, with their values in the plane.
  ASSERT_EQ(best.size(), 2U);
  EXPECT_LT(best.back()["residual"].get<double>(), best.front()["residual"].get<double>());
  const std::string material = best.back()["material"];
  EXPECT_THAT(material, HasSubstr("ward:m="));
  // A newer question of the slot is told nothing of it.
  EXPECT_EQ(view.ask("progress", {{"of", "page fit"}, {"of_number", 2}}).body, Json::object());
  EXPECT_TRUE(view.ask("progress", {{"of", "page fit"}, {"of_number", 1}}).body.contains("share"));
  // It ends soon after it is known that nobody waits.
  EXPECT_EQ(view.ask("forget", {{"slot", "page fit"}, {"number", 2}}).status, 200);
  fit.join();
  EXPECT_EQ(progress("page fit").body, Json::object());
  const Json plane = view.ask("plane", {{"material", "ward:m=0.2"}, {"theta_in", 60}}).body;
  EXPECT_EQ(best.back()["plane"]["theta_out"], plane["theta_out"]);
  EXPECT_NE(best.back()["plane"]["values"], best.front()["plane"]["values"]);
}

TEST_F(View, TellsHowFarASearchForTheNearestIs) {
  const std::string slow = "ggx_anisotropic:alpha_x=0.1,alpha_y=0.0";
  const ViewProcess view({slow + "2", slow + "3", slow + "4", slow + "5", slow + "6"}, here());
  std::thread nearest([&] {
    const Json question{{"material", "ward:m=0.2"}, {"lighting", "point"}, {"slot", "page nearest"}, {"number", 1}};
    EXPECT_EQ(view.ask("nearest", question).status, 200);
  });
  std::vector<double> shares;
  bool has_ended = false;
  for (int i = 0; i < 6000 && !has_ended; ++i) {
    const auto told = view.ask("progress", {{"of", "page nearest"}}).body;
    has_ended = !shares.empty() && told.empty();
    if (told.contains("share")) shares.push_back(told["share"]);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  nearest.join();
  // Of the whole search, not of one distance after the other.
  EXPECT_GT(shares.size(), 2U);
  EXPECT_TRUE(std::ranges::is_sorted(shares)) << Json(shares).dump();
}

TEST_F(View, RefusesScenesThatAreNone) {
  std::ofstream(file("no.toml")) << "[camera]\n";
  expect_refusal({"view", "lambert", "--scene", "no.toml"}, cli::ExitCode::usage, "no.toml:1:1");
  expect_refusal({"view", "lambert", "--scene", "none.toml"}, cli::ExitCode::file, "none.toml");
}

TEST_F(View, GivesTablesOfWhatIsShown) {
  const ViewProcess view({"lambert"}, here());
  const auto answer = view.ask("table", material("oren_nayar:sigma=0.5"));
  ASSERT_EQ(answer.status, 200) << answer.body.dump();
  EXPECT_EQ(answer.body["grid"], "gauss:64x128");
  // The first bytes of HDF5's signature.
  EXPECT_THAT(answer.body["bytes"].get<std::string>(), ::testing::StartsWith("iUhERg0KGgo"));
  const auto refused = view.ask("table", material("phong:n=100000"));
  EXPECT_EQ(refused.status, kRefused);
  EXPECT_THAT(refused.body["error"].get<std::string>(), HasSubstr("does not resolve"));
}

TEST_F(View, PrintsAnAddressUnderWhichOnlyItsOwnPageIs) {
  const ViewProcess view({"lambert"}, here());
  ASSERT_THAT(view.address(), ::testing::MatchesRegex("http://127.0.0.1:[0-9]+/[0-9a-f]{32}/"));
  auto client = view.client();
  const auto page = client.Get("/" + view.token() + "/");
  ASSERT_TRUE(page);
  EXPECT_EQ(page->status, 200);
  EXPECT_THAT(page->body, HasSubstr("<title>lobe view</title>"));
  EXPECT_THAT(page->get_header_value("Content-Security-Policy"), HasSubstr("default-src 'none'"));
  EXPECT_EQ(page->get_header_value("Referrer-Policy"), "no-referrer");
}

TEST_F(View, LetsNobodyInWhoDoesNotKnowTheToken) {
  const ViewProcess view({"lambert"}, here());
  std::string other = view.token();
  other.back() = other.back() == '0' ? '1' : '0';
  auto client = view.client();
  for (const std::string& path :
       {std::string("/"), std::string("/favicon.ico"), "/" + other + "/", "/" + view.token().substr(1) + "/",
        "/" + view.token(), std::string("//"), "/" + other + "/view.js"}) {
    const auto response = client.Get(path);
    ASSERT_TRUE(response) << path;
    EXPECT_EQ(response->status, kForbidden) << path;
  }
  const auto asked = client.Post("/" + other + "/ask/catalogue", "{}", "application/json");
  ASSERT_TRUE(asked);
  EXPECT_EQ(asked->status, kForbidden);
}

TEST_F(View, RefusesOtherHostsAndOtherSites) {
  const ViewProcess view({"lambert"}, here());
  const std::string host = "127.0.0.1:" + std::to_string(view.port());
  const std::string path = "/" + view.token() + "/ask/catalogue";
  struct Case {
    const char* what;
    httplib::Headers headers;
    int status;
  };
  const std::vector<Case> cases{
      {"its own page", {{"Host", host}, {"Origin", "http://" + host}, {"Sec-Fetch-Site", "same-origin"}}, 200},
      {"a program without a browser", {{"Host", host}}, 200},
      {"by its other name", {{"Host", "localhost:" + std::to_string(view.port())}}, 200},
      {"a name made to mean this machine", {{"Host", "evil.example:" + std::to_string(view.port())}}, kForbidden},
      {"without the port", {{"Host", "127.0.0.1"}}, kForbidden},
      {"a form of another site", {{"Host", host}, {"Origin", "http://evil.example"}}, kForbidden},
      {"a script of another site", {{"Host", host}, {"Sec-Fetch-Site", "cross-site"}}, kForbidden},
      {"another port of this machine", {{"Host", host}, {"Sec-Fetch-Site", "same-site"}}, kForbidden},
  };
  for (const auto& [what, headers, status] : cases) {
    auto client = view.client();
    const auto response = client.Post(path, headers, "{}", "application/json");
    ASSERT_TRUE(response) << what;
    EXPECT_EQ(response->status, status) << what;
  }
  const std::string twice =
      "GET /" + view.token() + "/ HTTP/1.1\r\nHost: " + host + "\r\nHost: evil.example\r\nConnection: close\r\n\r\n";
  EXPECT_THAT(RawClient(view.port(), twice).status_line(), HasSubstr("403"));
}

TEST_F(View, ServesNoFileThatItWasNotGiven) {
  std::ofstream(file("secret.csv")) << "theta_in,theta_out,delta_phi,f\n0,0,0,1\n";
  const ViewProcess view({"lambert"}, here());
  const std::string host = "\r\nHost: 127.0.0.1:" + std::to_string(view.port()) + "\r\nConnection: close\r\n\r\n";
  for (const std::string path : {"../../../../etc/passwd", "%2e%2e/%2e%2e/etc/passwd", "..%2f..%2fetc/passwd",
                                 "secret.csv", "//etc/passwd", "view.js/../../secret.csv"}) {
    const RawClient client(view.port(), "GET /" + view.token() + "/" + path + " HTTP/1.1" + host);
    EXPECT_THAT(client.status_line(), ::testing::ContainsRegex(" (400|403|404) ")) << path;
  }
  for (const std::string text : {"/etc/passwd", "secret.csv", "./secret.csv", "file:2", "file:", "-",
                                 "secret.csv[srgb]", "custom:file=secret.csv"}) {
    const auto answer = view.ask("material", material(text));
    EXPECT_EQ(answer.status, kRefused) << text;
    EXPECT_THAT(answer.body.value("error", ""), Not(IsEmpty())) << text;
  }
}

TEST_F(View, AnswersBadQuestionsInOneLine) {
  const ViewProcess view({"lambert"}, here());
  struct Case {
    std::string kind;
    Json question;
    int status;
    std::string message;
  };
  const std::vector<Case> cases{
      {"nothing", Json::object(), 404, "there is no question 'nothing'"},
      {"material", Json::object(), kRefused, "'material' in a question is not right; expected a text"},
      {"material", material("phng:n=2"), kRefused, "unknown model 'phng'"},
      {"material", material("phong:n=-1"), kRefused, "n"},
      {"material", material(std::string(30'000, 'x')), kRefused, "at most 20000 letters"},
      {"plane", {{"material", "lambert"}, {"theta_in", 90}}, kRefused, "'theta_in'"},
      {"plane", {{"material", "lambert"}, {"theta_in", "wide"}}, kRefused, "'theta_in'"},
      {"sphere", material("lambert"), kRefused, "'lights'"},
      {"sphere", {{"material", "lambert"}, {"lights", {{"points", 3}}}}, kRefused, "'points'"},
      {"sphere",
       {{"material", "lambert"}, {"size", 1e6}, {"lights", {{"sky", {{"radiance", 1}, {"colour", {1, 1, 1}}}}}}},
       kRefused,
       "'size'"},
      {"distances", {{"materials", {"lambert"}}, {"lighting", "point"}}, kRefused, "two to six"},
      {"distances", {{"materials", {"lambert", "lambert"}}, {"lighting", "moon"}}, kRefused, "moon"},
      {"fit", {{"material", "lambert"}, {"family", "phong:n=1,scale=1"}}, kRefused, "leaves nothing to find"},
      {"material", Json::array(), 400, "no JSON that the page would send"},
      {"material", {{"material", "lambert"}, {"slot", 3}}, 400, "no JSON that the page would send"},
  };
  for (const auto& [kind, question, status, message] : cases) {
    const auto answer = view.ask(kind, question);
    EXPECT_EQ(answer.status, status) << kind << " " << question.dump().substr(0, 100);
    const auto said = answer.body.value("error", "");
    EXPECT_THAT(said, HasSubstr(message)) << kind;
    EXPECT_THAT(said, Not(HasSubstr("\n"))) << kind;
  }
  auto client = view.client();
  const auto broken = client.Post("/" + view.token() + "/ask/material", "{", "application/json");
  ASSERT_TRUE(broken);
  EXPECT_EQ(broken->status, 400);
  const auto form = client.Post("/" + view.token() + "/ask/material", "{}", "text/plain");
  ASSERT_TRUE(form);
  EXPECT_EQ(form->status, 400);
}

/// Lines of the answer to questions that are asked at once.
std::vector<Json> lines_of(const std::string& text) {
  std::vector<Json> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(Json::parse(line));
  return lines;
}

TEST_F(View, AnswersQuestionsThatAreAskedAtOnceALineEach) {
  const ViewProcess view({"lambert"}, here());
  auto client = view.client();
  const Json plane{{"material", "phong:n=5"}, {"theta_in", 30}};
  Json first = plane;
  first["kind"] = "plane";
  const Json questions{{"questions",
                        {{{"kind", "distances"}, {"materials", {"lambert", "phong:n=5"}}, {"lighting", "point"}},
                         first,
                         {{"kind", "material"}, {"material", "phong:m=5"}},
                         {{"kind", "plane"}, {"material", "lambert"}, {"theta_in", "much"}},
                         {{"kind", "forget"}, {"slot", "another"}, {"number", 1}},
                         {{"kind", "progress"}, {"of", "another"}, {"of_number", "many"}}}}};

  const auto response = client.Post("/" + view.token() + "/asks", questions.dump(), "application/json");

  ASSERT_TRUE(response);
  EXPECT_EQ(response->status, 200);
  EXPECT_TRUE(response->body.ends_with('\n'));
  std::map<int, Json> answers;
  for (const Json& line : lines_of(response->body)) answers[line.at("at").get<int>()] = line.at("answer");
  ASSERT_EQ(answers.size(), 6U);
  EXPECT_EQ(answers[1], view.ask("plane", plane).body);
  EXPECT_EQ(answers[0].at("pairs").size(), 1U);
  EXPECT_THAT(answers[2].at("error").get<std::string>(), HasSubstr("phong"));
  EXPECT_THAT(answers[3].at("error").get<std::string>(), HasSubstr("'theta_in' in a question is not right"));
  EXPECT_EQ(answers[4], Json::object());
  EXPECT_THAT(answers[5].at("error").get<std::string>(), HasSubstr("no JSON that the page would send"));
  // Quick ones before slow ones, whatever their order.
  EXPECT_EQ(lines_of(response->body).back().at("at"), 0);
}

TEST_F(View, AnswersTheOthersWhereOneOfThemIsStale) {
  const ViewProcess view({"lambert"}, here());
  (void)view.ask("plane", {{"material", "lambert"}, {"theta_in", 30}, {"slot", "page 1"}, {"number", 7}});
  auto client = view.client();
  const Json questions{
      {"questions",
       {{{"kind", "plane"}, {"material", "lambert"}, {"theta_in", 20}, {"slot", "page 1"}, {"number", 3}},
        {{"kind", "plane"}, {"material", "lambert"}, {"theta_in", 20}, {"slot", "page 2"}, {"number", 4}}}}};
  const auto response = client.Post("/" + view.token() + "/asks", questions.dump(), "application/json");
  ASSERT_TRUE(response);
  const auto lines = lines_of(response->body);
  ASSERT_EQ(lines.size(), 2U);
  for (const Json& line : lines) {
    EXPECT_EQ(line.at("answer").contains("stale"), line.at("at") == 0) << line;
  }
}

TEST_F(View, RefusesListsThatAreNoQuestions) {
  const ViewProcess view({"lambert"}, here());
  auto client = view.client();
  const auto status = [&](const std::string& body, const char* type = "application/json") {
    const auto response = client.Post("/" + view.token() + "/asks", body, type);
    EXPECT_TRUE(response) << body;
    EXPECT_TRUE(response && Json::parse(response->body).contains("error")) << body;
    return response ? response->status : 0;
  };
  EXPECT_EQ(status("{"), 400);
  EXPECT_EQ(status("{}"), 400);
  EXPECT_EQ(status(R"({"questions": 5})"), 400);
  EXPECT_EQ(status(R"({"questions": null})"), 400);
  EXPECT_EQ(status(R"({"questions": {"a": {"kind": "forget"}}})"), 400);
  EXPECT_EQ(status(R"({"questions": []})", "text/plain"), 400);
  Json many{{"questions", Json::array()}};
  for (int i = 0; i < 101; ++i) many["questions"].push_back({{"kind", "exposure"}});
  EXPECT_EQ(status(many.dump()), 400);
  // Half a million lists in each other.
  const std::string deep(500'000, '[');
  EXPECT_EQ(status(R"({"questions": )" + deep), 422);
  EXPECT_EQ(view.ask("material", material("lambert")).status, 200);
  const auto nested = client.Post("/" + view.token() + "/ask/plane", R"({"material": )" + deep, "application/json");
  ASSERT_TRUE(nested);
  EXPECT_EQ(nested->status, 422);

  // One that is none leaves the others.
  const std::string_view odd[] = {"5",
                                  R"({"material": "lambert"})",
                                  R"({"kind": 7})",
                                  R"({"kind": "plane", "slot": 3})",
                                  R"({"kind": "plane", "number": "x"})",
                                  R"({"kind": "secrets"})"};
  for (const std::string_view one : odd) {
    const std::string body =
        R"({"questions": [)" + std::string(one) + R"(, {"kind": "material", "material": "lambert"}]})";
    const auto response = client.Post("/" + view.token() + "/asks", body, "application/json");
    ASSERT_TRUE(response) << one;
    const auto lines = lines_of(response->body);
    ASSERT_EQ(lines.size(), 2U) << one;
    for (const Json& line : lines) EXPECT_EQ(line.at("answer").contains("error"), line.at("at") == 0) << line;
  }
}

TEST_F(View, TellsQuickAnswersWhileSlowOnesAreMade) {
  const ViewProcess view({"lambert"}, here());
  const Json questions{{"questions",
                        {{{"kind", "fit"}, {"material", "ggx:alpha=0.3"}, {"family", "ward+ward+phong+oren_nayar"}},
                         {{"kind", "material"}, {"material", "lambert"}}}}};
  const std::string body = questions.dump();
  const RawClient client(view.port(), "POST /" + view.token() + "/asks HTTP/1.1\r\nHost: 127.0.0.1:" +
                                          std::to_string(view.port()) + "\r\nContent-Type: application/json\r\n" +
                                          "Content-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body);
  ASSERT_TRUE(client.is_connected());
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_TRUE(client.reads(R"({"at":1,"answer":{"name":"lambert")"));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(2)) << "the fit alone takes longer";
}

TEST_F(View, RefusesAGigabyteAndLivesOn) {
  const ViewProcess view({"lambert"}, here());
  const std::string head = "POST /" + view.token() +
                           "/file?name=x.csv HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(view.port()) +
                           "\r\nContent-Type: application/octet-stream\r\n";
  const RawClient client(view.port(), head + "Content-Length: 1000000000\r\nConnection: close\r\n\r\n");
  EXPECT_THAT(client.status_line(), HasSubstr("413"));
  EXPECT_EQ(view.ask("material", material("lambert")).status, 200);
}

TEST_F(View, AnswersBesideFiftyClientsThatSayNothing) {
  const ViewProcess view({"lambert"}, here());
  std::vector<RawClient> slow;
  for (int i = 0; i < 50; ++i) slow.emplace_back(view.port(), "GET /" + view.token() + "/ HTTP/1.1\r\nHos");
  EXPECT_TRUE(std::ranges::all_of(slow, &RawClient::is_connected));
  EXPECT_EQ(view.ask("material", material("phong:n=20")).status, 200);
}

TEST_F(View, EndsByCtrlCWithinASecondAndFreesItsPort) {
  ViewProcess view({"lambert"}, here());
  const int port = view.port();
  auto client = view.client();
  client.set_keep_alive(true);  // as browsers do
  ASSERT_TRUE(client.Get("/" + view.token() + "/"));
  EXPECT_EQ(view.end(SIGINT), 0);
  EXPECT_LT(view.after_signal(), std::chrono::seconds(1));
  const ViewProcess next({"lambert", "--port", std::to_string(port)}, here());
  EXPECT_EQ(next.port(), port);
  EXPECT_NE(next.token(), view.token());
  const auto third = run({"view", "lambert", "--port", std::to_string(port)});
  EXPECT_EQ(third.status, static_cast<int>(cli::ExitCode::file));
  EXPECT_THAT(third.error, HasSubstr("port " + std::to_string(port) + " of 127.0.0.1 cannot be had"));
}

TEST_F(View, EndsWhileItComputes) {
  ViewProcess view({"lambert"}, here());
  std::thread question([&] {
    auto client = view.client();
    (void)client.Post("/" + view.token() + "/ask/fit",
                      Json{{"material", "ward:m=0.2"}, {"family", "lambert+cook_torrance+oren_nayar"}}.dump(),
                      "application/json");
  });
  std::this_thread::sleep_for(std::chrono::milliseconds(700));
  view.end(SIGINT);
  EXPECT_LT(view.after_signal(), std::chrono::milliseconds(1500));
  question.join();
}

/// For each thread of a process the processors that it may run on, as "0-3" or "2".
std::vector<std::string> processors_of_threads(pid_t process) {
  std::vector<std::string> list;
  for (const auto& task : std::filesystem::directory_iterator("/proc/" + std::to_string(process) + "/task")) {
    std::ifstream status(task.path() / "status");
    for (std::string line; std::getline(status, line);) {
      if (line.starts_with("Cpus_allowed_list:\t")) list.push_back(line.substr(line.find('\t') + 1));
    }
  }
  return list;
}

TEST_F(View, KeepsThreadsOfTheDeviceApartWhereItHasAllProcessors) {
  const ScopedVariable affinity("POCL_AFFINITY", std::nullopt);
  const ScopedVariable threads_3("POCL_MAX_PTHREAD_COUNT", std::nullopt);  // of PoCL 3
  const ScopedVariable threads_6("POCL_CPU_MAX_CU_COUNT", std::nullopt);   // of PoCL 6
  cpu_set_t all;
  CPU_ZERO(&all);
  ASSERT_EQ(::sched_getaffinity(0, sizeof all, &all), 0);
  const long processors = ::sysconf(_SC_NPROCESSORS_CONF);
  if (processors < 2 || CPU_COUNT(&all) != processors) GTEST_SKIP() << "this process may not use all processors";
  {
    const ViewProcess view({"ggx:alpha=0.5@pump"}, here());
    const auto threads = processors_of_threads(view.process());
    for (long cpu = 0; cpu < processors; ++cpu) EXPECT_THAT(threads, Contains(std::to_string(cpu)));
  }
  {
    const ScopedVariable chosen("POCL_AFFINITY", "0");
    const ViewProcess view({"lambert"}, here());
    EXPECT_THAT(processors_of_threads(view.process()), Not(Contains("0"))) << "the user chose";
  }
  // PoCL would end the process whose first thread may not run on processor 0.
  cpu_set_t last;
  CPU_ZERO(&last);
  CPU_SET(static_cast<std::size_t>(processors - 1), &last);
  ASSERT_EQ(::sched_setaffinity(0, sizeof last, &last), 0);
  ViewProcess view({"lambert"}, here());
  ASSERT_EQ(::sched_setaffinity(0, sizeof all, &all), 0);
  EXPECT_EQ(view.ask("check", material("lambert")).status, 200);
  EXPECT_EQ(view.end(), 0);
}

TEST_F(View, AnswersTheSameQuestionWithTheSame) {
  const ViewProcess view({"ggx:alpha=0.3", "ward:m=0.2", "lambert"}, here());
  Json question{{"materials", {"ggx:alpha=0.3", "ward:m=0.2"}}, {"lighting", "daylight"}};
  const Json two = view.ask("distances", question).body;
  question["materials"].push_back("lambert");
  const Json three = view.ask("distances", question).body;
  EXPECT_EQ(three.at("pairs").size(), 3U);
  EXPECT_EQ(three.at("pairs").at(0), two.at("pairs").at(0));
  question["theta_max"] = 60;
  EXPECT_NE(view.ask("distances", question).body.at("pairs").at(0).at("distance"),
            two.at("pairs").at(0).at("distance"));
  EXPECT_EQ(view.ask("check", material("lambert")).body, view.ask("check", material("lambert")).body);
  EXPECT_NE(view.ask("check", material("lambert")).body, view.ask("check", material("ward:m=0.2")).body);
}

TEST(KeptAnswers, AreMadeOnceAndForgottenWhereThereAreTooMany) {
  cli::KeptAnswers kept(100);
  int made = 0;
  const auto get = [&](const std::string& question) {
    return kept.get(question, [&]() -> Json { return question + " " + std::to_string(++made); });
  };
  EXPECT_EQ(get("a"), Json("a 1"));
  EXPECT_EQ(get("b"), Json("b 2"));
  EXPECT_EQ(get("a"), Json("a 1"));
  EXPECT_THROW((void)kept.get("c", []() -> Json { throw Cancelled("nobody waits"); }), Cancelled);
  EXPECT_EQ(get("c"), Json("c 3"));
  EXPECT_EQ(get("a"), Json("a 1"));
  (void)get(std::string(28, 'd'));  // 88 bytes, beside 7 of each other one
  EXPECT_EQ(get("a"), Json("a 1"));
  EXPECT_EQ(get("b"), Json("b 5"));
}

TEST_F(View, TellsWhatTheCommandTells) {
  const std::string a = "ggx:alpha=0.3";
  const std::string b = "lambert:scale=0.3+phong:n=20,scale=0.4";
  const ViewProcess view({a, b}, here());
  const auto checked = view.ask("check", material(b)).body;
  const auto expected = json({"check", b}).at("materials").at(0).at("channels").at(0);
  EXPECT_EQ(checked.at("channels").at(0).at("mean_albedo"), expected.at("mean_albedo")) << expected.dump(1);
  for (const std::string lighting : {"point", "daylight", "mean-albedo", "patch:0.5"}) {
    const auto distance = view.ask("distances", {{"materials", {a, b}}, {"lighting", lighting}}).body;
    const auto command =
        json({"distance", a, b, "--lighting", lighting, "--tolerance", lighting == "patch:0.5" ? "1e-3" : "1e-4"});
    EXPECT_EQ(distance.at("pairs").at(0).at("distance").at("value"), command.at("distance").at("value")) << lighting;
    EXPECT_EQ(distance.at("pairs").at(0).at("distance").at("error"), command.at("distance").at("error")) << lighting;
  }
  const auto value = view.ask("value", {{"material", a}, {"theta_in", 30}, {"theta_out", 40}, {"delta_phi", 180}}).body;
  const auto evaluated = json({"eval", a, "--theta-in", "30", "--theta-out", "40", "--delta-phi", "180"});
  EXPECT_THAT(evaluated.dump(), HasSubstr(value.at("channels").at(0).at("value").dump()));
}

TEST_F(View, ShowsLambertAsItIs) {
  const ViewProcess view({"lambert:scale=0.3"}, here());
  const auto plane = view.ask("plane", {{"material", "lambert:scale=0.3"}, {"theta_in", 50}}).body;
  ASSERT_GT(plane.at("values").size(), 180U);
  EXPECT_EQ(plane.at("values").size(), plane.at("theta_out").size());
  for (std::size_t i = 0; i < plane.at("values").size(); ++i) {
    EXPECT_NEAR(plane.at("values").at(i).get<double>(), 0.3 / std::numbers::pi, 1e-15) << i;
  }
  const auto albedos = view.ask("albedos", material("lambert:scale=0.3")).body;
  for (std::size_t i = 0; i < albedos.at("values").size(); ++i) {
    const auto error = albedos.at("errors").at(i).get<double>();
    EXPECT_NEAR(albedos.at("values").at(i).get<double>(), 0.3, error + 1e-15) << i;
  }
  // Colours of three channels: luminance by sRGB's weights.
  const auto coloured = view.ask("albedos", material("lambert:scale=1/0/0")).body;
  EXPECT_NEAR(coloured.at("values").at(0).get<double>(), 0.2126, 2e-4);
}

TEST_F(View, TellsTheWholeHemisphere) {
  const ViewProcess view({"lambert"}, here());
  const auto lobe = view.ask("lobe", {{"material", "phong:n=20"}, {"theta_in", 30}}).body;
  const std::size_t sectors = lobe.at("delta_phi").size();
  ASSERT_EQ(lobe.at("values").size(), lobe.at("theta_out").size() * sectors);
  for (std::size_t i = 0; i < lobe.at("theta_out").size(); ++i) {
    const double theta = lobe.at("theta_out").at(i).get<double>() * std::numbers::pi / 180;
    // On the mirror side R.V = cos(theta - 30 degrees).
    const double expected = 22 / (2 * std::numbers::pi) * std::pow(std::cos(theta - std::numbers::pi / 6), 20);
    EXPECT_NEAR(lobe.at("values").at(i * sectors + sectors / 2).get<double>(), expected, 1e-9) << i;
  }
}

TEST_F(View, SlicesByHalfVectorAndDifference) {
  const ViewProcess view({"lambert"}, here());
  const auto slice = view.ask("slice", material("phong:n=20")).body;
  const auto nodes = slice.at("nodes").get<std::size_t>();
  ASSERT_EQ(slice.at("values").size(), nodes * nodes);
  const auto value = [&](std::size_t row, std::size_t column) { return slice.at("values").at(row * nodes + column); };
  const double peak = 22 / (2 * std::numbers::pi);
  // theta_h = 0: V is the mirror direction of L, whatever theta_d.
  EXPECT_NEAR(value(0, 0).get<double>(), peak, 0.01);
  EXPECT_NEAR(value(nodes / 2, 0).get<double>(), peak, 0.01);
  // theta_d = 0: L and V are the half-vector, and R.V = cos(2 theta_h). Nodes begin at 0.7 degrees.
  const double column = std::floor(static_cast<double>(nodes) / 3);
  const double theta_h = std::pow((column + 0.5) / static_cast<double>(nodes), 2) * std::numbers::pi / 2;
  const double expected = peak * std::pow(std::cos(2 * theta_h), 20);
  EXPECT_NEAR(value(0, nodes / 3).get<double>(), expected, 0.02 * expected);
}

/// Luminance of one of an answer's pixels, 0 to 255.
double pixel(const Json& sphere, std::size_t x, std::size_t y, std::size_t channel) {
  const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const auto text = sphere.at("rgb").get<std::string>();
  const std::size_t byte = 3 * (y * sphere.at("size").get<std::size_t>() + x) + channel;
  std::size_t three = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto digit = letters.find(text.at(byte / 3 * 4 + i));
    three = three * 64 + (digit == std::string::npos ? 0 : digit);
  }
  return static_cast<double>(three >> (8 * (2 - byte % 3)) & 255);
}

TEST_F(View, SpheresTakeTheColourOfTheirLight) {
  const ViewProcess view({"lambert"}, here());
  const auto sphere = [&](const Json& lights) {
    const auto answer = view.ask("sphere", {{"material", "lambert:scale=0.5"}, {"size", 33}, {"lights", lights}});
    EXPECT_EQ(answer.status, 200) << answer.body.dump();
    return answer.body;
  };
  const auto sky = [](const Json& colour) { return Json{{"sky", {{"radiance", 1}, {"colour", colour}}}}; };
  const auto white = sphere(sky({1, 1, 1}));
  // A grey sphere of albedo 0.5 is shown at half of the display's range (3.6), which is 127.5 of 255.
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(pixel(white, 16, 16, c), 127.5, 1) << c;
  const auto red = sphere(sky({1, 0, 0}));
  EXPECT_NEAR(pixel(red, 16, 16, 0), 127.5, 1);
  EXPECT_EQ(pixel(red, 16, 16, 1), 0);
  // Two lights of different colours add up to what both are.
  Json both = sky({0, 0.5, 0});
  both["points"] = {{{"direction", {0, 0, 1}}, {"irradiance", 3.14159}, {"colour", {1, 0, 0}}}};
  const auto mixed = sphere(both);
  EXPECT_GT(pixel(mixed, 16, 16, 0), pixel(mixed, 16, 16, 1));
  EXPECT_GT(pixel(mixed, 16, 16, 1), 50);
  EXPECT_EQ(pixel(mixed, 16, 16, 2), 0);
}

TEST_F(View, ComposesInBothOrders) {
  const ViewProcess view({"lambert"}, here());
  const auto answer =
      view.ask("composition", {{"a", "lambert:scale=0.5"}, {"b", "lambert:scale=0.8"}, {"theta_in", 30}});
  ASSERT_EQ(answer.status, 200) << answer.body.dump();
  for (const std::string key : {"ab", "ba"}) {
    for (const auto& value : answer.body.at(key).at("values")) {
      EXPECT_NEAR(value.get<double>(), 0.4 / std::numbers::pi, 1e-6) << key;
    }
  }
  const auto mirrors = view.ask("composition", {{"a", "mirror"}, {"b", "mirror"}, {"theta_in", 30}});
  EXPECT_EQ(mirrors.status, 200) << mirrors.body.dump();
}

TEST_F(View, FindsTheNearestOfAStudyAndFits) {
  const ViewProcess view({std::string(LOBE_STUDIES_DIRECTORY) + "/classical-families.toml"}, here());
  const auto offers = view.ask("catalogue", Json::object()).body.at("offers");
  ASSERT_GT(offers.size(), 10U);
  const auto nearest = view.ask("nearest", {{"material", offers.at(5).at("text")}, {"lighting", "daylight"}}).body;
  EXPECT_EQ(nearest.at("nearest").at(0).at("name"), offers.at(5).at("name"));
  EXPECT_NEAR(nearest.at("nearest").at(0).at("distance").at("value").get<double>(), 0, 1e-9);
  EXPECT_EQ(nearest.at("compared").get<std::size_t>() + nearest.at("refused").get<std::size_t>(), offers.size());

  const auto fitted = view.ask("fit", {{"material", "phong:n=30,scale=0.6"}, {"family", "phong"}}).body;
  const auto found = view.ask("material", material(fitted.value("material", ""))).body.at("formula").at("terms").at(0);
  EXPECT_NEAR(found.at("parameters").at("n").get<double>(), 30, 1e-3);
  EXPECT_NEAR(found.at("weight").at(0).get<double>(), 0.6, 1e-5);
}

TEST_F(View, TakesDroppedFiles) {
  make({"export", "ggx:alpha=0.4", "--format", "csv", "-o", "ggx.csv"});
  std::ofstream(file("paint.toml")) << "model = \"phong\"\nn = 30\n";
  std::ofstream(file("study.toml")) << "[study]\nname = \"s\"\n[[measured]]\nfile = \"/etc/passwd\"\n";
  ViewProcess view({"lambert"}, here());
  auto client = view.client();
  const auto drop = [&](const std::string& name, const std::string& content) {
    const auto response = client.Post("/" + view.token() + "/file?name=" + name, content, "application/octet-stream");
    EXPECT_TRUE(response) << name;
    return std::pair(response->status, Json::parse(response->body));
  };
  const auto content = [&](const std::string& name) {
    std::ifstream from(file(name), std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(from), {});
  };
  const auto [status, csv] = drop("..%2F..%2Fggx.csv", content("ggx.csv"));
  ASSERT_EQ(status, 200) << csv.dump();
  EXPECT_EQ(csv.at("name"), "ggx.csv");
  const auto told = view.ask("material", material(csv.at("text"))).body;
  EXPECT_EQ(told.at("word"), "ggx.csv");
  EXPECT_FALSE(told.contains("formula"));
  EXPECT_EQ(view.ask("albedos", material(csv.at("text"))).status, 200);

  const auto paint = drop("paint.toml", content("paint.toml"));
  EXPECT_EQ(paint.first, 200) << paint.second.dump();
  EXPECT_EQ(paint.second.at("text"), "phong:n=30");

  const auto study = drop("study.toml", content("study.toml"));
  EXPECT_EQ(study.first, kRefused);
  EXPECT_THAT(study.second.value("error", ""), HasSubstr("'study.toml' is a study, which may name other files"));
  const auto noise = drop("noise.bsdf", std::string(5000, '\x01'));
  EXPECT_EQ(noise.first, kRefused);
  EXPECT_THAT(noise.second.value("error", ""), HasSubstr("cannot read noise.bsdf: it is of no known format"));
  EXPECT_THAT(noise.second.value("error", ""), Not(HasSubstr("\n")));
  EXPECT_EQ(view.ask("catalogue", Json::object()).body.at("offers").size(), 3U);
  EXPECT_EQ(view.end(), 0);
}

TEST_F(View, AnswersOnlyTheNewestOfASlot) {
  const ViewProcess view({"lambert"}, here());
  const auto ask = [&](int number) {
    return view.ask("material", {{"material", "lambert"}, {"slot", "a"}, {"number", number}}).status;
  };
  EXPECT_EQ(ask(2), 200);
  EXPECT_EQ(ask(1), 409);
  EXPECT_EQ(ask(2), 200);
  EXPECT_EQ(view.ask("material", {{"material", "lambert"}, {"slot", "b"}, {"number", 1}}).status, 200);
  // A slow answer ends when a newer question of its slot comes.
  int slow = 0;
  std::thread waiting([&] {
    slow = view.ask("fit", {{"material", "ward:m=0.2"},
                            {"family", "lambert+cook_torrance+oren_nayar"},
                            {"slot", "fit"},
                            {"number", 1}})
               .status;
  });
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  const auto quick = view.ask("fit", {{"material", "lambert"}, {"family", "lambert"}, {"slot", "fit"}, {"number", 2}});
  waiting.join();
  EXPECT_EQ(slow, 409);
  EXPECT_EQ(quick.status, 200) << quick.body.dump();
}

}  // namespace
}  // namespace lobe::test
