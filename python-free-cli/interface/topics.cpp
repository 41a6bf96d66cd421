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
       {paragraph(
           "A MATERIAL is a model with values for its parameters, a sum of such models, or a file. Quote it for the "
           "shell if it contains '*'.")}},
      {"Ways to write one",
       {entry("MODEL:KEY=X,KEY=X", "a model; parameters with defaults may be left out"),
        entry("MODEL:...,scale=X", "the model times a number"),
        entry("KEY=R/G/B", "one value per channel, for parameters and for scale"), entry("TERM+TERM", "a sum"),
        entry("TERM*FACTOR:KEY=X", "a model times a factor, see below"),
        entry("MATERIAL@ADJUSTMENT", "a change to the whole sum, or to a material file, see below"),
        entry("FILE.toml", "a material file, as 'lobe fit -o' and 'lobe approximate -o' write it"),
        entry("FILE.h5", "a table written by lobe ('lobe tabulate', 'lobe compose', ...)"),
        entry("FILE", "another program's file, see 'lobe help files'"),
        entry("FILE[KEY=VALUE,...]", "a file read with options, see 'lobe help files'")}},
      {"Models",
       {paragraph(fmt::format("{}.", fmt::join(models, ", "))),
        paragraph("'lobe models' lists them with their sources, 'lobe models NAME' explains one: formula, parameters, "
                  "units, ranges.")}},
      {"Factors", std::move(factor_entries)},
      {"Adjustments", entries_of(adjustment_forms(), "@")},
      {"Examples",
       {example("how far varnished wood is from bare wood",
                "lobe distance lambert:scale=0.3+ward:m=0.1,scale=0.5 lambert:scale=0.3"),
        example("a cosine lobe made a metal", "lobe albedo 'phong:n=40*cos_max*fresnel:ior=0.2,k=3.9' --theta 0,60"),
        example("three channels", "lobe mean-albedo ward:m=0.1/0.12/0.2,scale=0.9/0.6/0.3")}}};
}

std::vector<Section> grids() {
  return {
      {"",
       {paragraph("A GRID divides the hemisphere into the directions of a table. Commands that make or compare tables "
                  "take one "
                  "by --grid. The default is the grid of the first table among the operands; else the coarsest that "
                  "resolves all of them, from gauss:64x128 (gauss:24x48 for anisotropic files) up to gauss:512x1024 "
                  "(gauss:256x512 with files; gauss:64x128 for anisotropic materials).")}},
      {"Grids", entries_of(grid_forms())},
      {"Which one to take",
       {paragraph("Gauss grids compose and integrate smooth reflectances to many digits. A grid whose rings lie too "
                  "far apart for a narrow lobe makes a table with a large error; a warning names a grid that suffices. "
                  "With --strict such a grid is refused, with --allow-unresolved there is no warning. Cells hold "
                  "averages, as measured data often do, and conserve the light that they "
                  "average. Averages "
                  "are refined where they need it; --cell-points sets how finely they begin.")}},
      {"Examples",
       {example("a table on a small grid", "lobe tabulate phong:n=20 --grid gauss:32x64 -o phong.h5"),
        example("a table on the patches of window simulations",
                "lobe tabulate phong:n=5 --grid klems:145 -o phong-klems.h5")}}};
}

std::vector<Section> lightings() {
  return {
      {"",
       {paragraph("A LIGHTING W is the weight that directions of light and view have when reflectances are compared: "
                  "f.g = integral of C(L,V) W(L,V), C the composition of f and g (Neumann 2001, eq. 5.23). "
                  "Norms, distances and angles follow from f.g as usual: |f| = sqrt(f.f), d(f,g) = |f-g|.")}},
      {"Lightings", entries_of(lighting_forms())},
      {"Which one to take",
       {paragraph(
           "Take point to tell reflectances apart. Take daylight if only brightness under a uniform sky matters; "
           "different "
           "materials can then have distance 0. Patch lights lie between the two, with 0 < R <= 2. A material as light "
           "is "
           "a lamp with the pattern of its reflection: material:phong:n=20 shines from about each direction in turn as "
           "that lobe does, and a file is a measured pattern. Distances are pure numbers under point, patch lights and "
           "materials; their unit is sr^1/2 under daylight and sr under mean-albedo.")}},
      {"Examples",
       {example("alike in brightness, but not in gloss", "lobe distance lambert phong:n=20 --lighting daylight"),
        example("under a light with half the radius of the base plane",
                "lobe distance lambert phong:n=20 --lighting patch:0.5"),
        example("under a lamp as wide as a lobe", "lobe distance lambert phong:n=20 --lighting material:phong:n=5"),
        example("under several lightings at once",
                "lobe gram lambert phong:n=20 --lighting point --lighting mean-albedo")}}};
}

std::vector<Section> studies() {
  constexpr std::string_view kStudy =
      "[study]\n"
      "name = \"gloss\"                       # output files are gloss.*\n"
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
      "[[material]]                         # a single one, with two terms\n"
      "name = \"varnished wood\"\n"
      "terms = [{model = \"lambert\", scale = 0.4}, {model = \"ward\", m = 0.1, scale = 0.1}]";
  return {
      {"",
       {paragraph(
            "A STUDY is a TOML file that lists materials and says what to compute for them. 'lobe run' computes Gram "
            "matrices, distances, maps, trees and neighbours under each lighting, with errors, and writes them as "
            "HDF5, CSV and pictures."),
        paragraph("A complete study:"),
        {.kind = Block::Kind::verbatim, .text = std::string(kStudy)}}},
      {"More",
       {paragraph(
            "A study may also compare materials with measured files ([[measured]]), use metrics from the literature "
            "(comparison_metrics), recompute printed figures ([[published]]) and draw curves ([[chart]]). "
            "docs/study-files.md lists every key; a misspelt key is refused, with its line."),
        paragraph("'include = [\"FILE.toml\"]' at the top includes another file. --set KEY=VALUE changes a value for "
                  "one run, such "
                  "as study.tolerance=1e-3 or family.Ward.m=[0.1,0.2]. 'lobe info NAME.h5' tells which line of which "
                  "file each "
                  "result comes from; with --study it prints the study itself."),
        paragraph("'lobe gram' and 'lobe distance-matrix' also take studies: STUDY, or STUDY --family NAME.")}},
      {"Examples",
       {example("a study that comes with lobe, at a coarse tolerance",
                "lobe run studies/classical-families.toml -o out --tolerance 1e-3"),
        example("the distances within one of its families",
                "lobe distance-matrix studies/classical-families.toml --family Ward"),
        example(
            "the same with other values",
            "lobe distance-matrix studies/classical-families.toml --family Ward --set 'family.Ward.m=[0.1, 0.2]'")}}};
}

std::vector<Section> exit_codes() {
  std::vector<Block> entries;
  for (const auto& [code, meaning] : kExitMeanings) {
    entries.push_back(entry(std::to_string(static_cast<int>(code)), meaning));
  }
  return {
      {"",
       {paragraph(
           "Results go to standard output, everything else to standard error. A command that fails prints one line, "
           "'lobe: error: WHAT; WHAT TO DO', and no results. Files appear complete or not at all.")}},
      {"Exit status", std::move(entries)},
      {"Examples",
       {example("in a script", "lobe distance ward:m=0.2 ward:m=0.201 --fail-above 0.1 && echo alike"),
        example("the status itself", "lobe check lambert; echo $?")}}};
}

std::vector<Section> files() {
  std::vector<Block> choices;
  for (const auto& form : file_choices()) choices.push_back(entry(form.written, form.meaning));
  std::vector<Block> formats;
  for (const auto& format : measured_formats()) {
    formats.push_back(
        entry(format.name, fmt::format("{}; {}", format.title, format.is_written ? "read and written" : "read")));
  }
  return {
      {"",
       {paragraph("lobe reads tables, studies and the files of other programs. It recognises a file by its content; "
                  "only .toml and "
                  ".h5 are told by their names. docs/file-formats.md describes all formats.")}},
      {"Files of lobe",
       {entry("FILE.h5",
              "a table or the results of a study, in HDF5 for h5py, xarray and ncdump, with errors, formulas and "
              "provenance"),
        entry("FILE.toml", "a study, or a material"),
        entry("FILE.csv", "matrices, curves and samples, each value with its error"),
        entry("FILE.png, .svg", "pictures, with the gnuplot scripts that drew them")}},
      {"Files of other programs", std::move(formats)},
      {"Options in brackets behind a file's name", std::move(choices)},
      {"Using them",
       {paragraph("A file can be used wherever a material can. 'lobe info' describes it, 'lobe import' turns it into a "
                  "table, "
                  "'lobe export' writes one. Existing files are replaced only with --force."),
        paragraph("Options select what is read from a file. A command's options apply to all of its files, options in "
                  "brackets to "
                  "one: \"paint.bsdf[theta_max=80,channels=red,blue]\", quoted for the shell. If a file has this whole "
                  "text as "
                  "its name, that file is read.")}},
      {"Examples",
       {example("a reflectance for a program that reads MERL files, and back",
                "lobe export lambert:scale=0.3 --format merl -o grey.binary && lobe info grey.binary"),
        example("describe a table", "lobe tabulate phong:n=5 --grid gauss:16x32 -o phong.h5 && lobe info phong.h5")}}};
}

std::vector<Section> errors() {
  return {
      {"",
       {paragraph(
           "Every computed number comes with an estimated bound on its error, and with as many digits as that error "
           "leaves meaningful: 0.7047142 ± 7.5e-07. The bound covers what the computation adds - quadrature, rounding, "
           "grids, interpolation - but not how wrong a model or a measurement is.")}},
      {"Where they come from",
       {entry("formulas",
              "integrals are refined until their estimated relative error is below --tolerance (1e-6; patch lights "
              "1e-5)"),
        entry("tables",
              "interpolation and sums over the grid are compared with coarser ones; errors of the table's own values "
              "are propagated"),
        entry("files", "measured files state no errors; rounding in the format and interpolation are counted")}},
      {"What to watch for",
       {paragraph(
           "A warning names results that missed the tolerance; they are printed with the errors that they have. 'error "
           "unknown' means that there was nothing to estimate it from. With --precision single errors are at least "
           "8e-6. JSON holds {\"value\", \"error\"} at full precision, CSV a column of errors. "
           "docs/error-estimates.md explains how errors are estimated and tested.")}},
      {"Examples",
       {example("at a coarse tolerance", "lobe distance phong:n=20 ward:m=0.2 --tolerance 1e-3"),
        example("with many digits", "lobe distance phong:n=20 ward:m=0.2 --tolerance 1e-9 --json")}}};
}

std::vector<Section> environment() {
  return {
      {"", {paragraph("Environment variables that lobe reads. Options take precedence.")}},
      {"Variables",
       {entry(
            "LOBE_DEVICE",
            "the OpenCL device to use without --device, as PLATFORM[:DEVICE]: numbers or parts of names; several with "
            "commas between them for 'lobe run'"),
        entry("NO_COLOR", "if set and not empty, turns colours off (unless --color always)"),
        entry("TERM", "dumb turns colours and the progress line off"),
        entry("POCL_CACHE_DIR", "where PoCL, the OpenCL runtime for CPUs, keeps compiled kernels; must be writable"),
        entry("POCL_AFFINITY",
              "1 keeps each thread of PoCL on a core of its own; 'lobe view' sets it where it may use all cores, and 0 "
              "keeps it from doing so"),
        entry("OCL_ICD_VENDORS", "where the OpenCL loader looks for drivers"),
        entry("SOURCE_DATE_EPOCH",
              "the time that result files state, in seconds since 1970, so that reruns are identical to the byte"),
        entry("TMPDIR", "where the log of a failed kernel compilation is written"),
        entry("LOBE_PACK", "1 or 8: how many values kernels compute at once (default: 8 on CPUs, 1 elsewhere)"),
        entry("$NAME/... in studies", "paths of measured files may begin with any variable")}},
      {"Examples",
       {example("use the first device of a platform", "LOBE_DEVICE=portable:0 lobe norm lambert"),
        example("list the devices", "lobe devices")}}};
}

}  // namespace

std::span<const Topic> topics() {
  static constexpr std::array kTopics{Topic{"materials", "how materials are written", materials},
                                      Topic{"grids", "how tables divide the hemisphere", grids},
                                      Topic{"lightings", "the weights of scalar products and distances", lightings},
                                      Topic{"studies", "files that describe computations", studies},
                                      Topic{"files", "the files that lobe reads and writes", files},
                                      Topic{"errors", "what the number after ± means", errors},
                                      Topic{"exit-codes", "what the exit status means", exit_codes},
                                      Topic{"environment", "environment variables", environment}};
  return kTopics;
}

Page topic_page(const Topic& topic) {
  return {.name = std::string(topic.name), .summary = std::string(topic.summary), .sections = topic.sections()};
}

}  // namespace lobe::cli
