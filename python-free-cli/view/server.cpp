#include "view/server.hpp"

#include <fmt/core.h>
#include <httplib.h>
#include <sys/random.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "interface/failure.hpp"
#include "lobe/core/error.hpp"
#include "view/answers.hpp"
#include "view/progress_board.hpp"
#include "view/turns.hpp"
#include "view_files.hpp"

namespace lobe::cli {
namespace {

constexpr const char* kHost = "127.0.0.1";
constexpr std::size_t kLargestFile = std::size_t{256} << 20;
constexpr std::size_t kLargestQuestion = std::size_t{1} << 20;
constexpr std::size_t kMostQuestions = 100;  // of a page at once; it sends more in parts
/// Clients that are served at once. One that sends nothing holds its place for kPatienceSeconds.
constexpr std::size_t kClients = 64;
constexpr time_t kPatienceSeconds = 3;

enum Status { kWrong = 400, kForbidden = 403, kUnknown = 404, kStale = 409, kRefused = 422, kBroken = 500 };

/// 128 random bits, in hexadecimal.
std::string random_token() {
  std::array<unsigned char, 16> bytes{};
  if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) {
    throw IoError("the system gives no random numbers, by which the page is kept from others");
  }
  std::string text;
  for (const unsigned char byte : bytes) text += fmt::format("{:02x}", byte);
  return text;
}

/// Compares in a time that tells nothing of where they differ.
bool are_equal(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  int differences = 0;
  for (std::size_t i = 0; i < a.size(); ++i) differences |= a[i] ^ b[i];
  return differences == 0;
}

struct PageFile {
  std::string_view name;
  const char* type;
  std::string_view content;
};

const std::array<PageFile, 12>& page_files() {
  static const std::array<PageFile, 12> kFiles{{
      {"", "text/html; charset=utf-8", view_files::view_html},
      {"view.css", "text/css; charset=utf-8", view_files::view_css},
      {"numbers.js", "text/javascript; charset=utf-8", view_files::numbers_js},
      {"ask.js", "text/javascript; charset=utf-8", view_files::ask_js},
      {"state.js", "text/javascript; charset=utf-8", view_files::state_js},
      {"editor.js", "text/javascript; charset=utf-8", view_files::editor_js},
      {"charts.js", "text/javascript; charset=utf-8", view_files::charts_js},
      {"gpu.js", "text/javascript; charset=utf-8", view_files::gpu_js},
      {"spheres.js", "text/javascript; charset=utf-8", view_files::spheres_js},
      {"scene.js", "text/javascript; charset=utf-8", view_files::scene_js},
      {"lobe.js", "text/javascript; charset=utf-8", view_files::lobe_js},
      {"view.js", "text/javascript; charset=utf-8", view_files::view_js},
  }};
  return kFiles;
}

/// \return null where there is none of that name
const QuestionKind* kind_named(std::string_view name) {
  const auto kinds = question_kinds();
  const auto found = std::ranges::find(kinds, name, &QuestionKind::name);
  return found == kinds.end() ? nullptr : &*found;
}

bool is_about_others(std::string_view name) {
  return name == "progress" || name == "forget";
}

Json no_question(const std::string& name) {
  return {{"error", "there is no question '" + name + "'"}};
}

/// \throws Json::exception, ArgumentError for what is nested so deep that who copies or prints it would run out of stack
Json parse_question(const std::string& body) {
  constexpr int kDeepest = 16;
  return Json::parse(body, [](int depth, Json::parse_event_t /*event*/, Json& /*parsed*/) {
    if (depth > kDeepest) throw ArgumentError("a question is nested too deep; expected what the page would send");
    return true;
  });
}

void say(httplib::Response& response, int status, const Json& json) {
  response.status = status;
  response.set_content(json.dump(-1, ' ', false, Json::error_handler_t::replace), "application/json");
}

}  // namespace

struct ViewServer::Content {
  const Device& device;
  ShownMaterials& shown;
  ShownScenes& scenes;
  std::size_t first_shown;
  std::string token = random_token();
  int port = 0;
  Turns turns = {};
  ProgressBoard progress = {};
  KeptAnswers kept = KeptAnswers();
  std::atomic<bool> is_ended = false;
  httplib::Server server = {};
  std::thread thread = {};

  Content(const Device& used, ShownMaterials& materials, ShownScenes& shown_scenes, std::size_t first)
      : device(used), shown(materials), scenes(shown_scenes), first_shown(first) {}

  void set_up();
  [[nodiscard]] bool is_admitted(const httplib::Request& request) const;
  [[nodiscard]] static bool is_question(const httplib::Request& request, httplib::Response& response);
  [[nodiscard]] std::optional<Json> answer_at_once(std::string_view name, const Json& asked);
  [[nodiscard]] Turns::Asked in_turn(const QuestionKind& kind, const Json& asked);
  void answer(const httplib::Request& request, httplib::Response& response);
  void answer_all(const httplib::Request& request, httplib::Response& response);
  [[nodiscard]] bool write_answers(const Json& asked, httplib::DataSink& sink);
  void take_file(const httplib::Request& request, httplib::Response& response);
  [[nodiscard]] std::pair<int, Json> refusal(const std::exception_ptr& failure) const;
  void respond(httplib::Response& response, const std::function<Json()>& make) const;
};

/// Only who knows the token, under the name that the server has: a page of another site whose name is made to mean this
/// machine sends that name.
bool ViewServer::Content::is_admitted(const httplib::Request& request) const {
  const std::string_view path = request.path;
  const std::size_t end = path.find('/', 1);
  if (end == std::string_view::npos || !are_equal(path.substr(1, end - 1), token)) return false;
  const std::string host = request.get_header_value("Host");
  if (request.get_header_value_count("Host") != 1) return false;
  if (host != fmt::format("{}:{}", kHost, port) && host != fmt::format("localhost:{}", port)) return false;
  if (request.method == "GET") return true;
  const std::string site = request.get_header_value("Sec-Fetch-Site");
  const std::string origin = request.get_header_value("Origin");
  return (site.empty() || site == "same-origin") && (origin.empty() || origin == "http://" + host);
}

/// Why there is no answer, as an answer and its status.
std::pair<int, Json> ViewServer::Content::refusal(const std::exception_ptr& failure) const {
  const auto line = [&] { return shown.without_folder(describe_current_exception(nullptr).line); };
  try {
    std::rethrow_exception(failure);
  } catch (const Cancelled&) {
    return {kStale, {{"stale", true}}};
  } catch (const DeviceError&) {
    return {kBroken, {{"error", line()}}};
  } catch (const Error&) {
    return {kRefused, {{"error", line()}}};
  } catch (const Json::exception&) {
    return {kWrong, {{"error", "the question is no JSON that the page would send"}}};
  } catch (...) {
    return {kBroken, {{"error", line()}}};
  }
}

void ViewServer::Content::respond(httplib::Response& response, const std::function<Json()>& make) const {
  try {
    say(response, 200, make());
  } catch (...) {
    const auto [status, json] = refusal(std::current_exception());
    say(response, status, json);
  }
}

/// \return whether it is one; else the response says so
bool ViewServer::Content::is_question(const httplib::Request& request, httplib::Response& response) {
  if (request.body.size() <= kLargestQuestion && request.get_header_value("Content-Type") == "application/json") {
    return true;
  }
  say(response, kWrong, {{"error", "a question is JSON of at most 1 MiB"}});
  return false;
}

/// What is about other questions waits for nobody's turn.
std::optional<Json> ViewServer::Content::answer_at_once(std::string_view name, const Json& asked) {
  if (name == "progress") {
    return progress.of(asked.value("of", std::string()), asked.value("of_number", std::uint64_t{0}));
  }
  if (name == "forget") {
    turns.forget({asked.value("slot", ""), asked.value("number", std::uint64_t{0})});
    return Json::object();
  }
  return std::nullopt;
}

/// A question with all that answers it in its turn.
/// \param asked lives until it is answered
Turns::Asked ViewServer::Content::in_turn(const QuestionKind& kind, const Json& asked) {
  Turns::Question question{asked.value("slot", ""), asked.value("number", std::uint64_t{0}), kind.patience};
  return {question, [this, &kind, &asked, question](const std::function<bool()>& is_wanted) {
            const ProgressBoard::Place place(progress, question.slot, question.number);
            const auto tell = [&](std::string_view stage, double share) {
              place.tell(stage, share);
              return is_wanted();
            };
            const auto tell_best = [&](Json best) { place.tell_best(std::move(best)); };
            Workshop workshop{device, shown, scenes, kept, first_shown, tell, tell_best};
            return cli::answer(workshop, kind, asked);
          }};
}

void ViewServer::Content::answer(const httplib::Request& request, httplib::Response& response) {
  const std::string name = request.matches[1];
  const QuestionKind* const kind = kind_named(name);
  if (kind == nullptr && !is_about_others(name)) return say(response, kUnknown, no_question(name));
  if (!is_question(request, response)) return;
  respond(response, [&] {
    const Json asked = parse_question(request.body);
    if (const auto answered = answer_at_once(name, asked)) return *answered;
    return turns.answer(in_turn(*kind, asked));
  });
}

/// Answers questions that a page asks at once, {"questions": [{"kind", ...}]}: a line {"at", "answer"} for each as soon
/// as it is known. Browsers ask a server no more than six things at a time otherwise.
void ViewServer::Content::answer_all(const httplib::Request& request, httplib::Response& response) {
  if (!is_question(request, response)) return;
  const auto asked = std::make_shared<Json>();
  try {
    Json list = parse_question(request.body);
    *asked = std::move(list.at("questions"));
  } catch (...) {
    const auto [status, json] = refusal(std::current_exception());
    return say(response, status, json);
  }
  if (!asked->is_array() || asked->size() > kMostQuestions) {
    return say(response, kWrong,
               {{"error", fmt::format("'questions' is no list that the page would send; expected one of at most {}",
                                      kMostQuestions)}});
  }
  response.set_chunked_content_provider("application/x-ndjson", [this, asked](std::size_t, httplib::DataSink& sink) {
    // Nobody catches what leaves this.
    try {
      return write_answers(*asked, sink);
    } catch (...) {
      return false;
    }
  });
}

/// \return whether the client has heard all of them
bool ViewServer::Content::write_answers(const Json& asked, httplib::DataSink& sink) {
  const auto say_line = [&](std::size_t at, const Json& answer) {
    const Json line{{"at", at}, {"answer", answer}};
    const std::string text = line.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
    return sink.write(text.data(), text.size());
  };
  std::vector<Turns::Asked> all;
  std::vector<std::size_t> places;
  for (std::size_t at = 0; at < asked.size(); ++at) {
    Json answered;
    try {
      const std::string name = asked.at(at).at("kind");
      const QuestionKind* const kind = kind_named(name);
      if (kind != nullptr) {
        all.push_back(in_turn(*kind, asked.at(at)));
        places.push_back(at);
        continue;
      }
      const auto others = answer_at_once(name, asked.at(at));
      answered = others ? *others : no_question(name);
    } catch (...) {
      answered = refusal(std::current_exception()).second;
    }
    if (!say_line(at, answered)) return false;
  }
  bool is_heard = true;
  turns.answer_all(all, [&](std::size_t which, const Json& answer, const std::exception_ptr& failure) {
    is_heard = say_line(places[which], failure ? refusal(failure).second : answer);
    return is_heard;
  });
  if (is_heard) sink.done();
  return is_heard;
}

void ViewServer::Content::take_file(const httplib::Request& request, httplib::Response& response) {
  if (request.get_header_value("Content-Type") != "application/octet-stream") {
    return say(response, kWrong, {{"error", "a file is sent as it is, application/octet-stream"}});
  }
  respond(response, [&] {
    return turns.answer({{}, [&](const std::function<bool()>&) {
                           return offer_json(shown.drop(request.get_param_value("name"), request.body));
                         }});
  });
}

void ViewServer::Content::set_up() {
  server.new_task_queue = [] { return new httplib::ThreadPool(kClients); };  // NOLINT(cppcoreguidelines-owning-memory)
  // The library would share the port with whoever asks for it.
  server.set_socket_options([](int socket) {
    const int yes = 1;
    ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  });
  server.set_tcp_nodelay(true);
  server.set_payload_max_length(kLargestFile);
  server.set_read_timeout(kPatienceSeconds);
  server.set_write_timeout(kPatienceSeconds);
  server.set_keep_alive_timeout(kPatienceSeconds);
  server.set_keep_alive_max_count(1000);
  server.set_default_headers(
      {{"Content-Security-Policy",
        "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; img-src 'self' data: blob:; "
        "base-uri 'none'; form-action 'none'; frame-ancestors 'none'"},
       {"X-Content-Type-Options", "nosniff"},
       {"Referrer-Policy", "no-referrer"},
       {"Cache-Control", "no-store"},
       {"Cross-Origin-Resource-Policy", "same-origin"}});
  server.set_pre_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
    if (is_admitted(request)) return httplib::Server::HandlerResponse::Unhandled;
    say(response, kForbidden, {{"error", "this is not the address that 'lobe view' printed"}});
    return httplib::Server::HandlerResponse::Handled;
  });
  for (const PageFile& file : page_files()) {
    server.Get("/[0-9a-f]+/" + std::string(file.name), [&file](const httplib::Request&, httplib::Response& response) {
      response.set_content(file.content.data(), file.content.size(), file.type);
    });
  }
  server.Post("/[0-9a-f]+/ask/([a-z]+)", [this](const auto& request, auto& response) { answer(request, response); });
  server.Post("/[0-9a-f]+/asks", [this](const auto& request, auto& response) { answer_all(request, response); });
  server.Post("/[0-9a-f]+/file", [this](const auto& request, auto& response) { take_file(request, response); });
}

ViewServer::ViewServer(const Device& device, ShownMaterials& shown, ShownScenes& scenes, std::size_t first_shown,
                       int port)
    : content_(std::make_unique<Content>(device, shown, scenes, first_shown)) {
  content_->set_up();
  httplib::Server& server = content_->server;
  content_->port = port == 0 ? server.bind_to_any_port(kHost) : server.bind_to_port(kHost, port) ? port : -1;
  if (content_->port < 0) {
    throw IoError(port == 0 ? std::string("no port of 127.0.0.1 can be had")
                            : fmt::format("port {} of 127.0.0.1 cannot be had; expected one that is free", port));
  }
}

std::string ViewServer::address() const {
  return fmt::format("http://{}:{}/{}/", kHost, content_->port, content_->token);
}

void ViewServer::serve(const std::function<bool()>& is_over) {
  using namespace std::chrono_literals;
  content_->thread = std::thread([content = content_.get()] {
    content->server.listen_after_bind();
    content->is_ended = true;
  });
  // Whoever computes may be asked for long; this looks while nobody else can.
  std::thread watch([content = content_.get(), &is_over] {
    while (!is_over() && !content->is_ended) std::this_thread::sleep_for(20ms);
    content->turns.stop();
  });
  while (!is_over() && !content_->is_ended) content_->turns.work(20ms);
  watch.join();
  content_->server.stop();
  // Connections that browsers keep open end when they time out; nobody waits for that.
  for (int i = 0; i < 10 && !content_->is_ended; ++i) std::this_thread::sleep_for(20ms);
}

ViewServer::~ViewServer() {
  if (!content_ || !content_->thread.joinable()) return;
  if (content_->is_ended) {
    content_->thread.join();
    return;
  }
  content_->thread.detach();
  static Content* kept = nullptr;  // what those connections still use, until the process ends
  kept = content_.release();
  (void)kept;
}

}  // namespace lobe::cli
