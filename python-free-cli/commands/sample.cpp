#include <fmt/format.h>

#include <charconv>
#include <filesystem>
#include <iterator>

#include "core/text.hpp"
#include "interface/command.hpp"
#include "interface/operand_json.hpp"
#include "interface/options.hpp"
#include "interface/output_file.hpp"
#include "interface/session.hpp"
#include "interface/table_making.hpp"
#include "interface/table_report.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"
#include "lobe/plot/sampling_page.hpp"
#include "lobe/sampling/sampling.hpp"

namespace lobe::cli {
namespace {

constexpr Count kCount{"count"};
constexpr Text kPatches{"patches"};
constexpr Number kPhi{"phi"};
constexpr Text kProposal{"proposal"};
constexpr Text kSeed{"seed"};
constexpr Flag kSummary{"summary"};
constexpr Number kSampleTheta{"theta"};

constexpr unsigned kMostSamples = 1'000'000'000;
constexpr unsigned kMostDirections = 10'000'000;  // they are held in memory

struct SampleRequest {
  Direction degrees;
  unsigned count = 0;
  SamplingOptions options;

  [[nodiscard]] Direction radians() const { return {degrees.theta * kDegree, degrees.phi * kDegree}; }
};

std::uint64_t seed_of(const Arguments& arguments) {
  const std::string& text = arguments.text(kSeed);
  std::uint64_t seed = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), seed);
  if (code != std::errc() || end != text.data() + text.size()) {
    throw ArgumentError("--seed " + text + " is no seed; expected a whole number from 0 on, below 2^64");
  }
  return seed;
}

SampleRequest sample_request(const Session& session) {
  const auto& arguments = session.arguments();
  if (!arguments.has(kSampleTheta)) throw ArgumentError("no angle of incidence; give one by --theta");
  SampleRequest request;
  request.degrees = {arguments.number(kSampleTheta), arguments.has(kPhi) ? arguments.number(kPhi) : 0};
  request.count = arguments.has(kCount) ? arguments.count(kCount, kMostSamples) : 1000;
  if (!arguments.has(kSummary) && request.count > kMostDirections) {
    throw ArgumentError(fmt::format("--count {} is too much to list; expected at most {}, of --summary 1e9",
                                    request.count, kMostDirections));
  }
  auto& options = request.options;
  if (arguments.has(kSeed)) options.seed = seed_of(arguments);
  if (arguments.text(kProposal) == "cosine") options.proposal = SamplingStrategy::cosine;
  if (arguments.text(kPatches) == "rejection") options.patches = PatchDraw::rejection;
  if (arguments.text(kPatches) == "roulette") options.patches = PatchDraw::roulette;
  options.precision = session.precision();
  return request;
}

std::string_view kind_text(SampleKind kind) {
  switch (kind) {
    case SampleKind::smooth:
      return "smooth";
    case SampleKind::mirror:
      return "mirror";
    case SampleKind::retro:
      return "retro";
    case SampleKind::lost:
      return "lost";
  }
  return {};
}

std::vector<std::string> heading(std::size_t channels) {
  std::vector<std::string> names{"x", "y", "z", "density"};
  for (std::size_t c = 0; c < channels; ++c) {
    names.push_back(channels == 1 ? "weight" : fmt::format("weight_{}", c + 1));
  }
  names.emplace_back("kind");
  return names;
}

/// A line for each sample, the first one with the names of the columns.
std::string samples_text(const DirectionSamples& samples, std::string_view separator) {
  const auto channels = static_cast<std::size_t>(samples.weights.cols());
  std::string text = fmt::format("{}\n", fmt::join(heading(channels), separator));
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    for (Eigen::Index k = 0; k < 3; ++k) text += shortest(samples.directions(row, k)) + std::string(separator);
    text += shortest(samples.density(row)) + std::string(separator);
    for (Eigen::Index c = 0; c < samples.weights.cols(); ++c) {
      text += shortest(samples.weights(row, c)) + std::string(separator);
    }
    text += kind_text(samples.kinds[i]);
    text += '\n';
  }
  return text;
}

Json samples_json(const DirectionSamples& samples) {
  Json entries = Json::array();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    Json entry{{"direction", Json::array()}, {"density", to_json(samples.density(row))}, {"weight", Json::array()}};
    for (const double x : samples.directions.row(row)) entry["direction"].push_back(to_json(x));
    for (const double weight : samples.weights.row(row)) entry["weight"].push_back(to_json(weight));
    entry["kind"] = kind_text(samples.kinds[i]);
    entries.push_back(std::move(entry));
  }
  return entries;
}

Json answer_to(const Operand& operand, const SampleRequest& request) {
  Json answer = json_answer("sample");
  add_operand(answer, operand);
  answer["units"] = {{"angles", "deg"}, {"density", "sr^-1"}, {"weight", "1"}, {"albedo", "1"}};
  answer["theta_deg"] = request.degrees.theta;
  answer["phi_deg"] = request.degrees.phi;
  answer["count"] = request.count;
  answer["seed"] = request.options.seed;
  answer["precision"] = to_string(request.options.precision);
  return answer;
}

ExitCode list_directions(Session& session, SampleRequest request) {
  const OutputFile output(session);
  // Pipes and devices may have any name.
  std::error_code ignored;
  const bool is_file =
      output.is_wanted() && !takes_standard_output(session.arguments()) &&
      (!std::filesystem::exists(output.path(), ignored) || std::filesystem::is_regular_file(output.path(), ignored));
  if (is_file && output.path().extension() != ".csv") {
    throw ArgumentError("'" + output.path().string() + "' names no format of samples; expected an ending .csv");
  }
  const auto operand = session.operand(argument::material);
  const auto device = session.choose_device();
  request.options.progress = session.progress();
  const DirectionSamples samples =
      sample(device, session.reflectance(operand), request.radians(), request.count, request.options);
  session.end_progress();
  output.write(samples_text(samples, ","));
  if (session.wants_json()) {
    Json answer = answer_to(operand, request);
    answer["device"] = to_json(device.info());
    answer["samples"] = samples_json(samples);
    session.print_json(answer);
  } else if (!output.is_wanted()) {
    session.print(samples_text(samples, " "));
  }
  return ExitCode::success;
}

Json summary_json(const SampledAlbedo& found) {
  Json json{{"albedo", Json::array()}, {"relative_variance", Json::array()}, {"lost", found.lost}};
  for (std::size_t c = 0; c < found.albedo.size(); ++c) {
    json["albedo"].push_back(to_json(found.albedo[c]));
    json["relative_variance"].push_back(to_json(found.relative_variance(c)));
  }
  return json;
}

/// The albedo by both ways of drawing.
ExitCode summarise(Session& session, SampleRequest request) {
  if (request.count < 2) throw ArgumentError("--summary takes the error of a mean; expected a --count of at least 2");
  const auto operand = session.operand(argument::material);
  const auto device = session.choose_device();
  request.options.progress = session.progress();
  SamplingOptions by_cosine = request.options;
  by_cosine.proposal = SamplingStrategy::cosine;
  const Reflectance reflectance = session.reflectance(operand);
  const std::array both{sampled_albedo(device, reflectance, request.radians(), request.count, request.options),
                        sampled_albedo(device, reflectance, request.radians(), request.count, by_cosine)};
  session.end_progress();
  constexpr std::array kNames{"importance", "cosine"};
  if (session.wants_json()) {
    Json answer = answer_to(operand, request);
    answer["device"] = to_json(device.info());
    for (std::size_t k = 0; k < both.size(); ++k) answer[kNames[k]] = summary_json(both[k]);
    session.print_json(answer);
    return ExitCode::success;
  }
  std::vector<std::vector<std::string>> rows{
      {"sampling", "channel", "albedo (± standard error)", "relative variance", "lost"}};
  for (std::size_t k = 0; k < both.size(); ++k) {
    for (std::size_t c = 0; c < both[k].albedo.size(); ++c) {
      rows.push_back({kNames[k], std::to_string(c + 1), format_estimate(both[k].albedo[c]),
                      fmt::format("{:.3g}", both[k].relative_variance(c)), fmt::format("{:.3g}", both[k].lost)});
    }
  }
  session.print(format_table(rows, 1, session.colors_output()));
  return ExitCode::success;
}

/// The page on the whole catalogue, docs/sampling.md.
ExitCode print_sampling(Session& session) {
  if (session.arguments().has(argument::material))
    throw ArgumentError("--catalogue samples all models; give no material");
  if (session.wants_json()) throw ArgumentError("--catalogue is a page of text; leave out --json");
  const auto device = session.choose_device();
  const auto models = sample_catalogue(device, {}, session.progress());
  session.end_progress();
  session.print(sampling_page(models));
  return ExitCode::success;
}

ExitCode execute_sample(Session& session) {
  const auto& arguments = session.arguments();
  if (arguments.has(option::catalogue)) return print_sampling(session);
  if (!arguments.has(argument::material))
    throw ArgumentError("nothing to sample; give a material or a table, or --catalogue");
  const SampleRequest request = sample_request(session);
  if (!arguments.has(kSummary)) return list_directions(session, request);
  if (arguments.has(option::output)) throw ArgumentError("--summary prints no directions; leave out --output");
  return summarise(session, request);
}

}  // namespace

Command sample_command() {
  return {
      .name = "sample",
      .group = "Materials",
      .summary = "draw directions of reflected light, by importance",
      .description =
          "Draws directions in which a material or a table reflects light from a given direction, by importance. "
          "Prints each with its probability density (sr^-1) and its weight per channel, f(L, V) cos / density; the "
          "mean of the weights is the directional albedo. Directions are unit vectors, z along the normal. 'lost' "
          "samples lie below the horizon and have weight 0; for mirrors the density is a probability. The same seed "
          "gives the same directions.\n"
          "With --summary, prints the albedo instead, its standard error, the variance of a weight over the squared "
          "albedo, and the same for directions drawn by their cosine alone.",
      .positionals = {{.handle = argument::material,
                       .help = "the material or table to sample",
                       .required = false,
                       .is_material = true}},
      .options =
          {{.handle = kSampleTheta, .value = "A", .help = "angle of incidence, at least 0 and below 90 degrees"},
           {.handle = kPhi, .value = "A", .help = "the light's azimuth (default 0)"},
           {.handle = kCount, .letter = 'n', .value = "N", .help = "number of samples (default 1000)"},
           {.handle = kSeed, .value = "S", .help = "seed of the random numbers (default 1)"},
           {.handle = kProposal,
            .value = "P",
            .help = "'cosine' draws by the cosine of the angle from the normal alone (default tailored)",
            .choices = {"tailored", "cosine"}},
           {.handle = kPatches,
            .value = "W",
            .help = "how to draw directions within patches (default exact)",
            .choices = {"exact", "rejection", "roulette"}},
           {.handle = kSummary, .help = "print the albedo and the variance of weights instead of directions"},
           {.handle = option::catalogue, .help = "print the page docs/sampling.md about all models instead"},
           {.handle = option::output, .letter = 'o', .value = "FILE", .help = "write the samples to a file, as CSV"},
           {.handle = option::force, .letter = 'f', .help = "replace an existing file"},
           json_option()},
      .examples = {{"a thousand directions of a metal", "lobe sample ggx:alpha=0.2 --theta 45 -o directions.csv"},
                   {"what importance sampling is worth",
                    "lobe sample lambert:scale=0.3+ward:m=0.1,scale=0.5 --theta 60 --count 100000 --summary"}},
      .execute = execute_sample};
}

}  // namespace lobe::cli
