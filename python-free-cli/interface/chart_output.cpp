#include "interface/chart_output.hpp"

#include "interface/options.hpp"
#include "lobe/core/error.hpp"

namespace lobe::cli {

namespace fs = std::filesystem;

Option plot_option(std::string_view help) {
  return {.handle = option::plot, .value = "FILE", .help = help};
}

std::optional<fs::path> picture_stem(const Arguments& arguments) {
  if (!arguments.has(option::plot)) return {};
  fs::path path = arguments.text(option::plot);
  if (path.extension() != ".png") {
    throw ArgumentError("--plot " + arguments.text(option::plot) +
                        " is no name of a picture; expected one that ends in .png");
  }
  path.replace_extension();
  return path;
}

void draw_chart(Session& session, const Chart& chart, const ChartValues& values, const fs::path& stem) {
  const fs::path directory = stem.has_parent_path() ? stem.parent_path() : fs::path(".");
  const auto files =
      write_chart_picture(chart, values, directory, stem.filename().string(), session.arguments().has(option::force));
  if (!files.note.empty()) session.warn(files.note);
}

}  // namespace lobe::cli
