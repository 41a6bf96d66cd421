#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "core/text.hpp"
#include "interface/command.hpp"
#include "interface/operand_list.hpp"
#include "interface/options.hpp"
#include "interface/placed_value.hpp"
#include "interface/session.hpp"
#include "interface/table_making.hpp"
#include "interface/table_report.hpp"
#include "interface/terminal.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"
#include "lobe/energy/plausibility.hpp"
#include "lobe/plot/plausibility_page.hpp"

namespace lobe::cli {
namespace {

/// A material or table and what was found of it.
struct Checked {
  Operand operand;
  Plausibility found;
};

std::string direction_text(const Direction& at) {
  const std::string azimuth = degree_text(at.phi);
  return fmt::format("theta_in {:.8g}°{}", to_degrees(at.theta), azimuth == "0.0°" ? "" : ", phi_in " + azimuth);
}

Json pair_json(const Directions& at) {
  return {{"theta_in_deg", to_degrees(at.theta_in)},
          {"theta_out_deg", to_degrees(at.theta_out)},
          {"delta_phi_deg", to_degrees(at.delta_phi)},
          {"phi_in_deg", to_degrees(at.phi_in)}};
}

/// An error that is not known is not told.
std::string estimate_text(const Estimate& estimate) {
  return std::isnan(estimate.error) ? fmt::format("{:.6g}", estimate.value) : format_estimate(estimate);
}

/// "0.35 below 1", "0.4 above 1".
std::string margin_text(const Estimate& albedo) {
  if (albedo.value < 0) return "negative like all of them";
  const double margin = 1 - albedo.value;
  if (std::abs(margin) <= albedo.error) return "1 within the error";
  return fmt::format("{:.2g} {} 1", std::abs(margin), margin > 0 ? "below" : "above");
}

std::string albedo_text(const AlbedoBound& bound) {
  if (bound.growth) {
    return fmt::format("without bound: it grows as (N.L)^-p towards grazing incidence, p = {}",
                       format_estimate(*bound.growth));
  }
  return fmt::format("{} at {}, {}", estimate_text(bound.largest), direction_text(bound.at),
                     margin_text(bound.largest));
}

std::string reciprocity_text(const ReciprocityDefect& defect, bool is_table) {
  if (defect.absolute == 0) return "none";
  return fmt::format("{:.2g} sr^-1 at {}; relative {:.2g}{}", defect.absolute, pair_text(defect.absolute_at),
                     defect.relative, is_table ? " (rms)" : "");
}

std::string breaks_text(const std::vector<SmoothnessBreak>& breaks) {
  if (breaks.empty()) return "none that its models tell of";
  std::vector<std::string> texts;
  for (const auto& edge : breaks) {
    const double jump = std::ranges::max(edge.jump);
    texts.push_back(fmt::format("{} at {:.6g} from the {} direction in the base plane{}",
                                jump > 0 ? fmt::format("a jump of {:.3g} sr^-1", jump) : "a kink", edge.radius,
                                edge.is_about_retro ? "retro" : "mirror",
                                edge.is_anisotropic ? ", across the lobe" : ""));
  }
  return fmt::format("{}", fmt::join(texts, "; "));
}

/// "plausible", or what is wrong with it.
std::string verdict_text(const Plausibility& found) {
  std::vector<std::string_view> faults;
  const auto add = [&](bool ChannelPlausibility::*is_right, std::string_view fault) {
    if (!std::ranges::all_of(found.channels, is_right)) faults.push_back(fault);
  };
  add(&ChannelPlausibility::is_non_negative, "negative values");
  add(&ChannelPlausibility::is_reciprocal, "not reciprocal");
  add(&ChannelPlausibility::conserves_energy, "more light than it gets");
  return faults.empty() ? "plausible" : fmt::format("implausible: {}", fmt::join(faults, ", "));
}

std::string page_text(const Checked& checked, bool color) {
  const Plausibility& found = checked.found;
  const bool is_table = found.grid.has_value();
  const auto labels = channel_labels(std::span(&checked.operand, 1));
  std::vector<Field> fields;
  for (std::size_t c = 0; c < found.channels.size(); ++c) {
    const ChannelPlausibility& channel = found.channels[c];
    const std::string suffix = labels.size() == 1 ? "" : ", " + labels[c];
    const auto add = [&](std::string_view name, std::string text) {
      fields.push_back({fmt::format("  {}{}", name, suffix), std::move(text)});
    };
    if (found.pairs > 0) {
      add("smallest value", text_of(channel.least));
      add("reciprocity defect", reciprocity_text(channel.reciprocity, is_table));
    }
    add("largest albedo", albedo_text(channel.albedo));
    if (channel.mean_albedo) add("mean albedo", estimate_text(*channel.mean_albedo));
  }
  if (!is_table && found.pairs > 0) fields.push_back({"  edges", breaks_text(found.breaks)});
  std::string text =
      fmt::format("{}: {}\n", bold(checked.operand.label(), color), verdict_text(found)) + fields_text(fields);
  if (is_table) {
    if (found.least_elevation == 0) return text;
    return text + fmt::format("  looked at the values on {}; at {} directions of incidence, up to {:.8g}°\n",
                              found.grid->name(), found.incident, 90 - to_degrees(found.least_elevation));
  }
  if (found.pairs == 0) return text + "  a delta part alone: no values to look at\n";
  text += fmt::format(
      "  looked at {} pairs of directions, then around the worst; at {} directions of incidence, up to "
      "{:.8g}°\n",
      found.pairs, found.incident, 90 - to_degrees(found.least_elevation));
  if (found.unresolved > 0) {
    text += fmt::format("  {} albedos did not reach the tolerance: their errors are larger\n", found.unresolved);
  }
  return text;
}

Json channel_json(const ChannelPlausibility& channel) {
  Json json{{"smallest_value", json_of(channel.least)}};
  json["reciprocity"] = {{"absolute", channel.reciprocity.absolute},
                         {"absolute_at", pair_json(channel.reciprocity.absolute_at)},
                         {"relative", channel.reciprocity.relative},
                         {"relative_at", pair_json(channel.reciprocity.relative_at)}};
  json["largest_albedo"] = to_json(channel.albedo.largest);
  json["largest_albedo_at"] = {{"theta_in_deg", to_degrees(channel.albedo.at.theta)},
                               {"phi_in_deg", to_degrees(channel.albedo.at.phi)}};
  json["margin"] = to_json(Estimate{1 - channel.albedo.largest.value, channel.albedo.largest.error});
  if (channel.albedo.growth) json["growth_exponent"] = to_json(*channel.albedo.growth);
  if (channel.mean_albedo) json["mean_albedo"] = to_json(*channel.mean_albedo);
  json["is_non_negative"] = channel.is_non_negative;
  json["is_reciprocal"] = channel.is_reciprocal;
  json["conserves_energy"] = channel.conserves_energy;
  return json;
}

Json checked_json(const Checked& checked) {
  Json json{{"name", checked.operand.label()}, {"is_plausible", checked.found.is_plausible()}};
  json["channels"] = Json::array();
  for (const auto& channel : checked.found.channels) json["channels"].push_back(channel_json(channel));
  json["edges"] = Json::array();
  for (const auto& edge : checked.found.breaks) {
    json["edges"].push_back({{"about", edge.is_about_retro ? "retro" : "mirror"},
                             {"radius", edge.radius},
                             {"jump", edge.jump},
                             {"anisotropic", edge.is_anisotropic}});
  }
  json["pairs"] = checked.found.pairs;
  json["incident"] = checked.found.incident;
  json["unresolved"] = checked.found.unresolved;
  json["least_elevation_deg"] = to_degrees(checked.found.least_elevation);
  return json;
}

/// The page on the whole catalogue, for docs/plausibility.md.
ExitCode print_plausibility(Session& session) {
  if (session.arguments().has(argument::materials))
    throw ArgumentError("--catalogue checks all models; give no materials");
  if (session.wants_json()) throw ArgumentError("--catalogue is a page of text; leave out --json");
  const auto device = session.choose_device();
  const auto models = check_catalogue(device, {}, session.progress());
  if (InterruptWatch::interrupted()) throw Cancelled("interrupted");
  session.end_progress();
  session.print(plausibility_page(models));
  bool agree = true;
  for (const auto& model : models) {
    if (agrees_with_traits(model)) continue;
    agree = false;
    session.warn(fmt::format("the traits of '{}' are not what was found", model.model));
  }
  return agree ? ExitCode::success : ExitCode::negative;
}

ExitCode execute_check(Session& session) {
  const auto& arguments = session.arguments();
  if (arguments.has(option::catalogue)) return print_plausibility(session);
  if (!arguments.has(argument::materials))
    throw ArgumentError("nothing to check; give materials or tables, or --catalogue");
  const PlausibilityOptions options{.tolerance = session.tolerance(PlausibilityOptions{}.tolerance),
                                    .precision = session.precision()};
  const auto list = read_operands(session, arguments.texts(argument::materials), {});
  std::vector<Checked> all;
  for (const auto& operand : list.operands) {
    all.push_back({operand, check_plausibility(session.device(), session.reflectance(operand), options)});
  }
  for (const auto& one : all) {
    if (one.found.unresolved == 0) continue;
    session.warn_of_miss(fmt::format("{} albedos of '{}' miss the tolerance {}; errors are stated as they are",
                                     one.found.unresolved, one.operand.label(), shortest(options.tolerance)));
  }

  if (session.wants_json()) {
    Json answer = json_answer("check");
    answer["units"] = {{"brdf", "sr^-1"}, {"angles", "deg"}, {"albedo", "1"}, {"radius", "1"}, {"jump", "sr^-1"}};
    answer["tolerance"] = options.tolerance;
    answer["materials"] = Json::array();
    for (const auto& one : all) answer["materials"].push_back(checked_json(one));
    session.print_json(answer);
  } else {
    for (const auto& one : all) session.print(page_text(one, session.colors_output()));
  }
  const bool is_plausible = std::ranges::all_of(all, [](const Checked& one) { return one.found.is_plausible(); });
  return is_plausible ? ExitCode::success : ExitCode::negative;
}

}  // namespace

Command check_command() {
  return {
      .name = "check",
      .group = "Materials",
      .summary = "check energy balance, reciprocity and sign",
      .description =
          "Checks whether each material or table has negative values, whether it is reciprocal, f(L, V) = f(V, L), and "
          "whether it reflects more light than it receives. Prints the worst values found and their places, the mean "
          "albedo (what a white furnace shows), and the edges that its models declare. The exit status is 1 if one is "
          "implausible.\n"
          "For materials, values and albedos are searched at directions that crowd around the mirror and retro "
          "directions and towards grazing ones, then around the worst: a violation that is reported exists, but one "
          "narrower than the search may be missed. An albedo that grows without bound towards grazing incidence is "
          "reported by its exponent. Tables are checked at their own directions, within their errors; unknown errors "
          "count as zero. The values of files are examined on a grid. Their albedos are integrated and searched like "
          "those of materials, up to 89.99°, with what the file means there.\n"
          "A file may be a shader: a function float or vec3 NAME(vec3 L, vec3 V) of GLSL, of unit vectors with z along "
          "the normal, in sr^-1 without the cosine.",
      .positionals = {{.handle = argument::materials,
                       .help = "materials, tables, or study files for all their materials",
                       .required = false,
                       .is_material = true,
                       .is_repeated = true}},
      .options = {{.handle = option::catalogue,
                   .help = "check all models over the ranges of their parameters instead, and print the page "
                           "docs/plausibility.md; the exit status is 1 if a trait is declared wrongly"},
                  tolerance_option("largest relative error of albedos (default 1e-5)"),
                  strict_option(),
                  set_option(),
                  json_option()},
      .examples = {{"an albedo that tends to 1 at grazing incidence (that of ward:m=0.1 grows without bound)",
                    "lobe check cook_torrance:m=0.1"},
                   {"a mixture that absorbs some light, as JSON",
                    "lobe check lambert:scale=0.4+ward_metal:m=0.1,scale=0.5 --json"}},
      .execute = execute_check};
}

}  // namespace lobe::cli
