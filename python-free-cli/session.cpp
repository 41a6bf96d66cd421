#include "session.hpp"

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "lobe/error.hpp"
#include "lobe/model.hpp"
#include "lobe/study.hpp"
#include "terminal.hpp"

namespace lobe::cli {
namespace {

bool is_model(std::string_view text) {
  return std::ranges::find(catalogue(), text, &Model::name) != catalogue().end();
}

bool is_path(const std::string& text) {
  if (text.find('/') != std::string::npos || text.ends_with(".toml")) return true;
  std::error_code ignored;
  return std::filesystem::is_regular_file(text, ignored) && !is_model(text);
}

}  // namespace

std::string_view to_string(Precision precision) {
  return precision == Precision::single_precision ? "single" : "double";
}

Session::Session(const Arguments& arguments, std::string command_line)
    : arguments_(arguments),
      command_line_(std::move(command_line)),
      progress_(is_terminal(Stream::error) && !arguments.has("quiet") && !arguments.has("json")) {}

bool Session::colors_output() const {
  return uses_color(Stream::output, arguments_.text("color"));
}

Device Session::choose_device() const {
  return Device::choose(arguments_.text("device"));
}

Precision Session::precision(Precision otherwise) const {
  if (!arguments_.has("precision")) return otherwise;
  return arguments_.text("precision") == "single" ? Precision::single_precision : Precision::double_precision;
}

double Session::tolerance(double otherwise) const {
  if (!arguments_.has("tolerance")) return otherwise;
  const double value = arguments_.number("tolerance");
  if (!(value > 0 && value < 1)) {
    throw ArgumentError("--tolerance " + arguments_.text("tolerance") +
                        " is out of range; expected a relative error above 0 and below 1, such as 1e-6");
  }
  return value;
}

Material Session::material(std::string_view positional) const {
  const std::string& text = arguments_.text(positional);
  return is_path(text) ? load_material(text) : parse_material(text);
}

void Session::warn(std::string_view text) {
  if (arguments_.has("quiet")) return;
  progress_.erase();
  const bool color = uses_color(Stream::error, arguments_.text("color"));
  write_error("lobe: " + bold("warning:", color) + " " + std::string(text) + "\n");
}

void Session::remark(std::string_view text) {
  if (!is_verbose() || arguments_.has("quiet")) return;
  progress_.erase();
  write_error(text);
}

ProgressCallback Session::progress() {
  return [this](std::string_view stage, double fraction) {
    progress_.show(stage, fraction);
    return !InterruptWatch::interrupted();
  };
}

}  // namespace lobe::cli
