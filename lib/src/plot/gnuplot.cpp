#include "plot/gnuplot.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <fstream>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "core/files.hpp"
#include "core/text.hpp"
#include "lobe/core/error.hpp"

namespace lobe::gnuplot {
namespace {

// Okabe and Ito 2008, without the yellow, which is too pale on white; a brown and a grey added.
constexpr std::array<std::string_view, 9> kColours = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00",
                                                      "#56b4e9", "#000000", "#8c510a", "#8a8a8a"};
// Circle, square, triangles, diamond, pentagon, filled; then open ones. Not a divisor of the colours' number, so that
// pairs repeat late.
constexpr std::array<int, 10> kPoints = {7, 5, 9, 13, 11, 15, 6, 4, 8, 12};

class SpawnActions {
 public:
  SpawnActions() { posix_spawn_file_actions_init(&actions_); }
  ~SpawnActions() { posix_spawn_file_actions_destroy(&actions_); }
  SpawnActions(const SpawnActions&) = delete;
  SpawnActions& operator=(const SpawnActions&) = delete;
  posix_spawn_file_actions_t* get() { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_{};
};

/// Both ends of a pipe; the writing end must be closed before one reads to the end.
struct Pipe {
  std::array<int, 2> ends{-1, -1};
  Pipe() {
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw std::system_error(errno, std::generic_category(), "pipe");
  }
  ~Pipe() {
    for (const int end : ends) {
      if (end >= 0) ::close(end);
    }
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  std::string drain() {
    ::close(std::exchange(ends[1], -1));
    std::string text;
    std::array<char, 4096> buffer{};
    for (;;) {
      const ssize_t count = ::read(ends[0], buffer.data(), buffer.size());
      if (count > 0) {
        text.append(buffer.data(), static_cast<std::size_t>(count));
      } else if (count == 0 || errno != EINTR) {
        return text;
      }
    }
  }
};

/// Runs gnuplot in a directory and returns what it complained of, in one line; empty on success.
std::string run(const std::filesystem::path& directory, std::vector<std::string> arguments) {
  Pipe pipe;
  SpawnActions actions;
  posix_spawn_file_actions_addchdir_np(actions.get(), directory.c_str());
  posix_spawn_file_actions_addopen(actions.get(), STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(actions.get(), STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(actions.get(), pipe.ends[1], STDERR_FILENO);
  std::vector<char*> argv;
  argv.reserve(arguments.size() + 1);
  for (auto& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  pid_t child = 0;
  const int code = ::posix_spawnp(&child, argv.front(), actions.get(), nullptr, argv.data(), environ);
  if (code == ENOENT) return "gnuplot is not installed or not in PATH";
  if (code != 0) return "gnuplot does not start: " + std::generic_category().message(code);
  const std::string complaint = pipe.drain();
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return {};
  // The last line that says something: gnuplot shows the offending line and a caret first.
  std::string_view reason;
  for (const auto line : split(complaint, '\n')) {
    if (!trim(line).empty()) reason = trim(line);
  }
  return "gnuplot failed" + (reason.empty() ? "" : ": " + std::string(reason));
}

bool is_complete(const std::filesystem::path& path, PictureFormat format) {
  constexpr std::streamoff kEnd = 16;
  std::ifstream file(path, std::ios::binary);
  std::array<char, kEnd> end{};
  if (!file.seekg(-kEnd, std::ios::end) || !file.read(end.data(), end.size())) return false;
  const std::string_view mark = format == PictureFormat::png ? "IEND" : "</svg>";
  return std::string_view(end.data(), end.size()).find(mark) != std::string_view::npos;
}

}  // namespace

std::string string_literal(std::string_view text) {
  constexpr std::string_view kPlain = " .,:()+-_/*=#";
  std::string literal = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const bool is_letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    if (is_letter || byte >= 0x80U || kPlain.find(c) != std::string_view::npos) {
      literal += c;
    } else {
      literal += fmt::format("\\{:03o}", byte);
    }
  }
  return literal + '"';
}

std::string comment(std::string_view text) {
  constexpr std::string_view kPlain = " .,:()+-_/*=<>|'";
  std::string line = "# ";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const bool is_letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    line += is_letter || byte >= 0x80U || kPlain.find(c) != std::string_view::npos ? c : ' ';
  }
  return line + '\n';
}

std::string data_comment(std::string_view text) {
  std::string line = "# " + std::string(text);
  for (char& c : line) {
    if (static_cast<unsigned char>(c) < 0x20U) c = ' ';
  }
  return line + '\n';
}

std::string file_literal(std::string_view name) {
  return string_literal("./" + std::string(name));
}

std::size_t character_count(std::string_view text) {
  std::size_t count = 0;
  for (const char c : text) count += (static_cast<unsigned char>(c) & 0xc0U) != 0x80U ? 1U : 0U;
  return count;
}

std::string family_colour(std::size_t family) {
  return std::string(kColours[family % kColours.size()]);
}

int family_point(std::size_t family) {
  return kPoints[family % kPoints.size()];
}

std::string viridis() {
  // van der Walt and Smith 2015, evenly spaced.
  return "set palette defined (0 '#440154', 1 '#482475', 2 '#414487', 3 '#355f8d', 4 '#2a788e', 5 '#21918c', \\\n"
         "  6 '#22a884', 7 '#44bf70', 8 '#7ad151', 9 '#bddf26', 10 '#fde725')\n";
}

std::string extension(PictureFormat format) {
  return format == PictureFormat::png ? ".png" : ".svg";
}

std::string preamble(std::string_view stem, std::string_view what, int width, int height, PictureFormat format) {
  return comment(what) + "# Made by lobe for gnuplot 5; edit it and run it again in this directory.\n" +
         fmt::format(
             "if (!exists('output_file')) output_file = {}\n"
             "data_file = {}\n"
             "set encoding utf8\n"
             "set terminal {} size {},{} noenhanced font 'DejaVu Sans,10' background '#ffffff'\n"
             "set output output_file\n",
             file_literal(std::string(stem) + extension(format)), file_literal(std::string(stem) + ".dat"),
             format == PictureFormat::png ? "pngcairo" : "svg fontscale 1.333", width, height);
}

std::string render(const std::filesystem::path& directory, const std::string& stem, PictureFormat format,
                   const std::filesystem::path& target) {
  const std::filesystem::path where = directory.empty() ? "." : directory;
  try {
    write_atomically(target / (stem + extension(format)), true, [&](const std::filesystem::path& temporary) {
      // gnuplot runs where its script is.
      const std::string name = std::filesystem::absolute(temporary).string();
      const std::string complaint =
          run(where, {"gnuplot", "-d", "-e", "output_file = " + string_literal(name), "./" + stem + ".gp"});
      if (!complaint.empty()) throw IoError(complaint);
      if (!is_complete(temporary, format)) throw IoError("gnuplot left an incomplete picture");
    });
  } catch (const std::exception& failure) {
    return failure.what();
  }
  return {};
}

}  // namespace lobe::gnuplot
