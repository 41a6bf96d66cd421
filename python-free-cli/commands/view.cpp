#include <fcntl.h>
#include <fmt/core.h>
#include <sched.h>
#include <spawn.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "interface/command.hpp"
#include "interface/operand_list.hpp"
#include "interface/options.hpp"
#include "interface/report.hpp"
#include "interface/session.hpp"
#include "interface/terminal.hpp"
#include "lobe/core/error.hpp"
#include "view/scenes.hpp"
#include "view/server.hpp"
#include "view/shown.hpp"

namespace lobe::cli {
namespace {

constexpr Count kPort{"port"};
constexpr Flag kOpen{"open"};
constexpr Texts kViewScene{"scene"};

constexpr unsigned kLastPort = 65535;
/// Materials that the page begins with; the others of a study are offered.
constexpr std::size_t kFirstShown = 2;
constexpr std::size_t kMostFirstShown = 6;

/// PoCL wakes its threads for every kernel, often two of them on one core, which makes short answers slower. Each gets
/// a core of its own, before PoCL starts, unless the process has only some of the cores or the user chose.
void keep_device_threads_apart() {
  for (const char* chosen : {"POCL_AFFINITY", "POCL_MAX_PTHREAD_COUNT", "POCL_CPU_MAX_CU_COUNT"}) {
    if (std::getenv(chosen) != nullptr) return;
  }
  // PoCL ends the process where its thread i may not run on processor i.
  cpu_set_t own;
  CPU_ZERO(&own);
  if (::sched_getaffinity(0, sizeof own, &own) != 0) return;
  const long processors = ::sysconf(_SC_NPROCESSORS_CONF);
  for (long cpu = 0; cpu < processors; ++cpu) {
    if (cpu >= CPU_SETSIZE || !CPU_ISSET(static_cast<std::size_t>(cpu), &own)) return;
  }
  ::setenv("POCL_AFFINITY", "1", 0);
}

/// Starts the user's browser.
/// \return whether there is one
bool open_browser(const std::string& address) {
  std::string program = "xdg-open";
  std::string place = address;
  const std::array<char*, 3> words{program.data(), place.data(), nullptr};
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    ::posix_spawn_file_actions_addopen(&actions, stream, "/dev/null", O_RDWR, 0);
  }
  pid_t process = 0;
  const int failure = ::posix_spawnp(&process, words.front(), &actions, nullptr, words.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  return failure == 0;
}

bool has_study(const std::vector<std::string>& texts) {
  return std::ranges::any_of(texts,
                             [](const std::string& text) { return names_study(text.substr(0, text.find('#'))); });
}

ExitCode execute_view(Session& session) {
  keep_device_threads_apart();  // before an adjustment of a material starts the device
  const auto& arguments = session.arguments();
  const int port = arguments.has(kPort) ? static_cast<int>(arguments.count(kPort, kLastPort)) : 0;
  const auto given = arguments.texts(argument::materials);
  std::vector<std::string> texts(given.begin(), given.end());
  if (texts.empty()) texts = {"lambert:scale=0.5", "ggx:alpha=0.3"};
  auto list = read_operands(session, texts, {});
  const std::size_t most = has_study(texts) ? kFirstShown : kMostFirstShown;
  const std::size_t first_shown = std::min(most, list.operands.size());
  ShownMaterials shown(std::move(list.operands));
  ShownScenes scenes(arguments.texts(kViewScene));
  ViewServer server(session.choose_device(), shown, scenes, first_shown, port);

  if (session.wants_json()) {
    Json answer = json_answer("view");
    answer["address"] = server.address();
    write_output(json_text(answer));
  } else {
    write_output(server.address() + "\n");
  }
  session.state("open this address in a browser of this machine; Ctrl-C ends it");
  if (arguments.has(kOpen) && !open_browser(server.address())) {
    session.warn("no browser could be started, as there is no xdg-open; open the address yourself");
  }
  server.serve(InterruptWatch::interrupted);
  return ExitCode::success;
}

}  // namespace

Command view_command() {
  return {
      .name = "view",
      .group = "Materials",
      .summary = "edit and compare materials in a browser",
      .description =
          "Serves a page on 127.0.0.1 and prints its address, which holds a secret and works for browsers of this "
          "machine only. The page shows up to six materials: spheres under lights that can be moved and coloured, "
          "beside a grey sphere of albedo 0.5 (Neumann 2001, 3.6); values in the plane of incidence; albedos; the "
          "verdict of 'lobe check'; distances and angles under four lightings; both compositions; the nearest of all "
          "materials given; the best fit of one's model to another; and the chosen material in a scene, drawn by path "
          "tracing. Every number is computed here, in double precision, with its error. Parameters have sliders, and "
          "what is shown can be copied as commands, as a material file and as a link. Files that lobe reads may be "
          "dropped on the page.\n"
          "Without materials the page begins with two. Nothing is written; Ctrl-C ends the command.",
      .positionals = {{.handle = argument::materials,
                       .help = "the materials, tables and files to show; of a study file the page shows the first two "
                               "and offers all",
                       .required = false,
                       .is_material = true,
                       .is_repeated = true}},
      .options = {{.handle = kOpen, .help = "open the page in the user's browser"},
                  {.handle = kViewScene,
                   .value = "FILE",
                   .help = "a scene file as 'lobe render' draws it, to show the chosen material in; may be repeated"},
                  {.handle = kPort, .value = "N", .help = "port of 127.0.0.1 (default: one that is free)"},
                  set_option(),
                  json_option()},
      .examples = {{"two models beside each other", "lobe view ggx:alpha=0.2 ward:m=0.2"},
                   {"the materials of a study, of which the page finds the nearest",
                    "lobe view studies/classical-families.toml --open"},
                   {"a metal in a scene of jars", "lobe view ggx:alpha=0.1 --scene examples/scenes/jars.toml"}},
      .execute = execute_view};
}

}  // namespace lobe::cli
