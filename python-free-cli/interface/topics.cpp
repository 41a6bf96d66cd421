#include "interface/topics.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <string>

#include "interface/exit_code.hpp"
#include "lobe/core/written_form.hpp"
#include "lobe/formats/chosen_file.hpp"
#include "lobe/formats/measured.hpp"
#include "lobe/model/model.hpp"

namespace lobe::cli {
namespace {

Block example(std::string_view purpose, std::string_view line) {
  return {.kind = Block::Kind::example, .text = std::string(purpose), .item = std::string(line)};
}

std::vector<Block> entries_of(std::span<const WrittenForm> forms, std::string_view mark = "") {
  std::vector<Block> blocks;
  for (const auto& form : forms) blocks.push_back(entry(fmt::format("{}{}", mark, form.written), form.meaning));
  return blocks;
}

std::string specification(const FactorModel& factor) {
  std::string text = fmt::format("*{}", factor.name);
  char separator = ':';
  for (const auto& parameter : factor.parameters) {
    text += fmt::format("{}{}=X", separator, parameter.name);
    separator = ',';
  }
  return text;
}

std::vector<Section> materials() {
  std::vector<std::string_view> models;
  for (const auto& model : catalogue()) models.push_back(model.name);
  std::vector<Block> factor_entries;
  for (const auto& factor : factors()) factor_entries.push_back(entry(specification(factor), factor.formula));
  return {
      {"",
       {paragraph("A MATERIAL is a model with values for its parameters, or several of these in a sum, or the path of "
                  "a file. Quote it for the shell where it contains '*'.")}},
      {"Ways to write one",
       {entry("MODEL:KEY=X,KEY=X", "a model; parameters with a default may be left out"),
        entry("MODEL:...,scale=X", "the model times a factor"),
        entry("KEY=R/G/B", "values by channel, of parameters and of scale"), entry("TERM+TERM", "the sum of several"),
        entry("TERM*FACTOR:KEY=X", "a model times a function, see below"),
        entry("MATERIAL@ADJUSTMENT", "done to the whole sum, see below"),
        entry("FILE.toml", "a material file, such as 'lobe fit -o' and 'lobe approximate -o' write"),
        entry("FILE.h5", "a table that lobe has written ('lobe tabulate', 'lobe compose', ...)"),
        entry("FILE", "a file of another program, see 'lobe help files'"),
        entry("FILE[KEY=VALUE,...]", "what is read of a file, see 'lobe help files'")}},
      {"Models",
       {paragraph(fmt::format("{}.", fmt::join(models, ", "))),
        paragraph("'lobe models' lists them with their sources, 'lobe models NAME' explains one: formula, parameters, "
                  "units, ranges.")}},
      {"Factors", std::move(factor_entries)},
      {"Adjustments", entries_of(adjustment_forms(), "@")},
      {"Examples",
       {example("a varnished wood against its ground",
                "lobe distance lambert:scale=0.3+ward:m=0.1,scale=0.5 lambert:scale=0.3"),
        example("a metal of a cosine lobe", "lobe albedo 'phong:n=40*cos_max*fresnel:ior=0.2,k=3.9' --theta 0,60"),
        example("three channels", "lobe mean-albedo ward:m=0.1/0.12/0.2,scale=0.9/0.6/0.3")}}};
}

std::vector<Section> grids() {
  return {
      {"",
       {paragraph("A GRID divides the hemisphere of directions for tables: --grid of the commands that make or "
                  "compare tables. The default is gauss:64x128, beside tables that of the first one.")}},
      {"Grids", entries_of(grid_forms())},
      {"Which one",
       {paragraph(
           "Gauss grids compose and integrate smooth reflectances to many digits. A grid whose rings lie too "
           "far apart for a narrow lobe is refused, with the one that would do; --allow-unresolved keeps it. "
           "Cells hold averages, as measured data often do, with the light of what is averaged; they are refined "
           "where that matters, and --samples says where that begins.")}},
      {"Examples",
       {example("a table on a small grid, and what it is", "lobe tabulate phong:n=20 --grid gauss:32x64 -o phong.h5"),
        example("the same, on the patches of window simulations",
                "lobe tabulate phong:n=5 --grid klems:145 -o phong-klems.h5")}}};
}

std::vector<Section> lightings() {
  return {
      {"",
       {paragraph("A LIGHTING W says which directions of light and view count how much when reflectances are "
                  "compared: f.g = integral of C(L,V) W(L,V), C the composition of f and g (Neumann 2001, eq. 5.23). "
                  "Norms, distances and angles follow from f.g as usual: |f| = sqrt(f.f), d(f,g) = |f-g|.")}},
      {"Lightings", entries_of(lighting_forms())},
      {"Which one",
       {paragraph("Take point to tell reflectances apart, daylight where only the brightness under a uniform sky "
                  "matters (different materials can then be at distance 0), patch lights for what lies between. "
                  "0 < R <= 2. Distances have the unit 1 under point and patches, sr^1/2 under daylight, sr under "
                  "mean-albedo.")}},
      {"Examples",
       {example("alike in brightness, not in gloss", "lobe distance lambert phong:n=20 --lighting daylight"),
        example("the same by a light of half the base plane's radius",
                "lobe distance lambert phong:n=20 --lighting patch:0.5"),
        example("several at once", "lobe gram lambert phong:n=20 --lighting point --lighting mean-albedo")}}};
}

std::vector<Section> studies() {
  constexpr std::string_view kStudy =
      "[study]\n"
      "name = \"gloss\"                       # the files are called gloss.*\n"
      "lightings = [\"point\", \"daylight\"]    # 'lobe help lightings'\n"
      "tolerance = 1e-4                     # largest relative error of a product\n"
      "\n"
      "[[family]]                           # one material per value\n"
      "name = \"Ward\"\n"
      "model = \"ward\"                       # 'lobe models ward'\n"
      "m = {logspace = [0.05, 0.5], count = 4}\n"
      "\n"
      "[[family]]\n"
      "name = \"Phong\"\n"
      "model = \"phong\"\n"
      "n = [1, 10, 100]\n"
      "\n"
      "[[material]]                         # a single one, of two layers\n"
      "name = \"varnished wood\"\n"
      "terms = [{model = \"lambert\", scale = 0.4}, {model = \"ward\", m = 0.1, scale = 0.1}]";
  return {
      {"",
       {paragraph("A STUDY is a file in TOML that names materials and what to compute of them. 'lobe run' computes "
                  "it: Gram matrices, distances, maps, trees and neighbours under each lighting, with errors, as "
                  "HDF5, CSV and pictures."),
        paragraph("A whole one:"),
        {.kind = Block::Kind::verbatim, .text = std::string(kStudy)}}},
      {"More",
       {paragraph("Studies may also hold materials against measured files ([[measured]]), against the metrics of the "
                  "literature (comparison_metrics), compute printed figures again ([[published]]) and draw curves "
                  "([[chart]]). docs/study-files.md has every key; a misspelt one is refused with its line."),
        paragraph(
            "'include = [\"FILE.toml\"]' at the top takes in what another file has. --set KEY=VALUE changes a value "
            "for one run, such as study.tolerance=1e-3 or family.Ward.m=[0.1,0.2]. 'lobe info NAME.h5' says which "
            "line of which file every result comes from, and with --study prints the study that it is of."),
        paragraph("'lobe gram' and 'lobe distance-matrix' take studies, too: STUDY, or STUDY --family NAME.")}},
      {"Examples",
       {example("a study that comes with lobe, quickly and roughly",
                "lobe run studies/classical-families.toml -o out --tolerance 1e-3"),
        example("the distances within one of its families",
                "lobe distance-matrix studies/classical-families.toml --family Ward"),
        example(
            "those of other values",
            "lobe distance-matrix studies/classical-families.toml --family Ward --set 'family.Ward.m=[0.1, 0.2]'")}}};
}

std::vector<Section> exit_codes() {
  std::vector<Block> entries;
  for (const auto& [code, meaning] : kExitMeanings) {
    entries.push_back(entry(std::to_string(static_cast<int>(code)), meaning));
  }
  return {
      {"",
       {paragraph("Results go to standard output and all else to standard error. Where a command fails, it prints "
                  "one line 'lobe: error: WHAT; WHAT TO DO' and no results. Files appear complete or not at all.")}},
      {"Exit status", std::move(entries)},
      {"Examples",
       {example("in a script", "lobe distance ward:m=0.2 ward:m=0.201 --fail-above 0.1 && echo alike"),
        example("the number itself", "lobe check lambert; echo $?")}}};
}

std::vector<Section> files() {
  std::vector<Block> choices;
  for (const auto& form : file_choices()) choices.push_back(entry(form.written, form.meaning));
  std::vector<Block> formats;
  for (const auto& format : foreign_formats()) {
    formats.push_back(
        entry(format.name, fmt::format("{}; {}", format.title, format.is_written ? "read and written" : "read")));
  }
  return {
      {"",
       {paragraph("Tables, studies and files of other programs. What a file is shows in its content; the end of its "
                  "name matters for .toml and .h5 alone. docs/file-formats.md describes them all.")}},
      {"Files of lobe",
       {entry("FILE.h5",
              "a table of a reflectance, or NAME.h5 the results of a study: HDF5, for h5py, xarray and "
              "ncdump; with errors, formulas and where it comes from"),
        entry("FILE.toml", "a study, or a material"),
        entry("FILE.csv", "matrices, curves and samples, each value with its error"),
        entry("FILE.png, .svg", "pictures, beside the gnuplot scripts that made them")}},
      {"Files of other programs", std::move(formats)},
      {"Options in brackets behind a file's name", std::move(choices)},
      {"Using them",
       {paragraph("They stand wherever a material does. 'lobe info' says what they are, 'lobe import' makes tables of "
                  "them, 'lobe export' writes them. Files that exist are replaced with --force only."),
        paragraph("Options say what is read of a file: those of the command hold for all its files, those in brackets "
                  "for one, as in \"paint.bsdf[theta_max=80,channels=red,blue]\", quoted for the shell. A file whose "
                  "name is the whole text is that file.")}},
      {"Examples",
       {example("a reflectance for a program that reads MERL files, and back",
                "lobe export lambert:scale=0.3 --format merl -o grey.binary && lobe info grey.binary"),
        example("what a table holds",
                "lobe tabulate phong:n=5 --grid gauss:16x32 -o phong.h5 && lobe info phong.h5")}}};
}

std::vector<Section> errors() {
  return {
      {"",
       {paragraph("Every computed number has an estimate of its error: 0.7047142 ± 7.5e-07 is a value with as many "
                  "digits as its error leaves meaningful. It counts what the computation adds - quadrature, rounding, "
                  "grids, interpolation - and not what a model or a measurement is wrong by.")}},
      {"Where they come from",
       {entry("formulas",
              "integrals are refined until products change by less than --tolerance of themselves (1e-6, "
              "patch lights 1e-5); the last change is the estimate"),
        entry("tables",
              "what interpolation and sums over the grid change against half the resolution, and what the "
              "table's own errors come to"),
        entry("files", "measured files state none; rounding of the format and interpolation count")}},
      {"What to watch for",
       {paragraph("A warning names products that did not reach the tolerance; their errors are stated all the same. "
                  "'error unknown' stands where there is nothing to compare with. With --precision single errors are "
                  "at least 8e-6. JSON holds {\"value\", \"error\"} at full precision; CSV a column of errors. "
                  "docs/error-estimates.md says how the estimates are made and tested.")}},
      {"Examples",
       {example("roughly, and with more digits", "lobe distance phong:n=20 ward:m=0.2 --tolerance 1e-3"),
        example("full precision", "lobe distance phong:n=20 ward:m=0.2 --tolerance 1e-9 --json")}}};
}

std::vector<Section> environment() {
  return {
      {"", {paragraph("Variables of the environment that lobe heeds. Options go before them.")}},
      {"Variables",
       {entry("LOBE_DEVICE",
              "OpenCL device where --device is not given, as PLATFORM[:DEVICE]: numbers or pieces of "
              "names"),
        entry("NO_COLOR", "where set and not empty, nothing is coloured (unless --color always)"),
        entry("TERM", "dumb: no colours and no progress line"),
        entry("POCL_CACHE_DIR", "where PoCL, the OpenCL runtime for CPUs, keeps compiled kernels; has to be writable"),
        entry("OCL_ICD_VENDORS", "where the OpenCL loader looks for drivers"),
        entry("SOURCE_DATE_EPOCH",
              "the time that result files state, in seconds since 1970, for files that are the "
              "same to the byte"),
        entry("TMPDIR", "where the log of a failed kernel compilation is left"),
        entry("LOBE_PACK", "1 or 8: how many values kernels compute at once (default: 8 on CPUs, 1 elsewhere)"),
        entry("$NAME/... in studies", "paths of measured files may begin with any variable")}},
      {"Examples",
       {example("on the first device of a platform", "LOBE_DEVICE=portable:0 lobe norm lambert"),
        example("which devices there are", "lobe devices")}}};
}

}  // namespace

std::span<const Topic> topics() {
  static constexpr std::array kTopics{
      Topic{"materials", "how materials are written", materials},
      Topic{"grids", "how directions are divided for tables", grids},
      Topic{"lightings", "what distances and scalar products are taken under", lightings},
      Topic{"studies", "files that say what to compute", studies},
      Topic{"files", "what is read and written", files},
      Topic{"errors", "what stands behind the sign ±", errors},
      Topic{"exit-codes", "what the exit status says", exit_codes},
      Topic{"environment", "variables that matter", environment}};
  return kTopics;
}

Page topic_page(const Topic& topic) {
  return {.name = std::string(topic.name), .summary = std::string(topic.summary), .sections = topic.sections()};
}

}  // namespace lobe::cli
