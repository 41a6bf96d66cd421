#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "interface/command.hpp"
#include "interface/options.hpp"
#include "interface/output_file.hpp"
#include "interface/session.hpp"
#include "lobe/core/error.hpp"
#include "lobe/study/report_page.hpp"
#include "lobe/study/study_results.hpp"

namespace lobe::cli {
namespace {

constexpr Text kFile{"FILE.h5"};
constexpr Flag kNoSpheres{"no-spheres"};

namespace fs = std::filesystem;

/// Spheres are a supplement: a page without them is still the study's.
ReportSpheres spheres_of(Session& session, const StudyResult& result) {
  if (session.arguments().has(kNoSpheres)) return {};
  try {
    const ReportSpheres spheres = report_spheres(session.device(), result, session.progress());
    session.end_progress();
    return spheres;
  } catch (const DeviceError& error) {
    session.warn(fmt::format("the page has no spheres: {}", error.what()));
    return {};
  }
}

ExitCode execute_report(Session& session) {
  const fs::path study = session.arguments().text(kFile);
  if (study.extension() == ".toml") {
    throw ArgumentError(study.string() + " is no result; compute it first, 'lobe run' leaves NAME.h5");
  }
  const OutputFile file(session, fs::path(study).replace_extension(".html"));
  if (const auto ending = file.path().extension(); ending != ".html" && ending != ".htm") {
    throw ArgumentError("'" + file.path().string() + "' is no name of a page; expected one that ends in .html");
  }
  const StudyResult result = load_study_results(study);
  const ReportSpheres spheres = spheres_of(session, result);
  file.write(report_page(result, spheres));
  if (session.wants_json()) {
    Json answer = json_answer("report");
    answer["study"] = result.study.name;
    answer["materials"] = result.study.materials.size();
    answer["spheres"] = std::ranges::count_if(spheres, [](const auto& sphere) { return sphere.has_value(); });
    answer["distances"] = result.metrics.size() + result.comparisons.size();
    answer["file"] = file.path().string();
    session.print_json(answer);
  } else {
    session.print(file.path().string() + "\n");
  }
  return ExitCode::success;
}

}  // namespace

Command report_command() {
  static_assert(kMostReportSpheres == 100, "the description says how many");
  return {
      .name = "report",
      .group = "Studies",
      .summary = "turn a computed study into a page for a browser",
      .description =
          "Writes one HTML file and prints its name. The page shows the distances of a study in colours, its tree "
          "and map, the nearest materials, albedos, slices and lit spheres of any two materials side by side, "
          "approximations, provenance, and the commands that recompute the numbers. It loads nothing from anywhere. "
          "Spheres are drawn in studies of up to 100 materials, of those that are given by formulas.",
      .positionals = {{.handle = kFile, .help = "a result of 'lobe run' (NAME.h5)"}},
      .options = {{.handle = option::output,
                   .letter = 'o',
                   .value = "FILE.html",
                   .help = "the page (default: beside the study, ending in .html)"},
                  {.handle = kNoSpheres, .help = "leave out the spheres; the page then needs no OpenCL device"},
                  {.handle = option::force, .letter = 'f', .help = "replace an existing file"},
                  json_option()},
      .examples = {{"a study", "lobe run studies/metals.toml -o out --tolerance 1e-3"},
                   {"its page", "lobe report out/metals.h5 -o metals.html"},
                   {"the study behind it, and where its results come from", "lobe info out/metals.h5"}},
      .execute = execute_report};
}

}  // namespace lobe::cli
