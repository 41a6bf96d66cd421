#include "interface/reading.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "interface/operand.hpp"
#include "interface/options.hpp"
#include "lobe/core/error.hpp"
#include "lobe/formats/chosen_file.hpp"

namespace lobe::cli {

std::vector<Option> reading_options() {
  return {
      {.handle = option::channels,
       .value = "LIST",
       .help = "channels to read, by name or by number from 1 on: red,blue"},
      {.handle = option::wavelengths, .value = "LIST", .help = "wavelengths to read from spectra, in nm: 450,532,633"},
      {.handle = option::luminance,
       .value = "WEIGHTS",
       .help = "read one channel, the luminance: rec709 for red, green and blue, photopic for spectra"},
      {.handle = option::theta_max,
       .value = "DEGREES",
       .help = "largest angle from the normal to read; beyond it, values stay as they are there (default 90)"},
      {.handle = option::component,
       .value = "NAME",
       .help = "which of several reflectances in a file to read: 'reflection front' or 'reflection back'; of light by "
               "polarizations (bird) 's', 'p' or 'u'"},
      {.handle = option::srgb, .help = "decode values that are sRGB-encoded (UTIA)"},
      {.handle = option::entry,
       .value = "NAME",
       .help = "which function of a shader to read (default: the last one of two directions)"},
      {.handle = option::uniform, .value = "NAME=VALUE", .help = "value of a uniform of a shader, A/B/C for a vector"}};
}

ReadOptions read_options(const Arguments& arguments) {
  ReadOptions options;
  if (arguments.has(option::channels)) options.channels = arguments.words(option::channels);
  if (arguments.has(option::wavelengths)) options.wavelengths = arguments.numbers(option::wavelengths);
  if (arguments.has(option::luminance)) options.luminance = arguments.text(option::luminance);
  if (arguments.has(option::theta_max)) options.theta_max = theta_max_of(arguments.number(option::theta_max));
  if (arguments.has(option::component)) options.component = arguments.text(option::component);
  options.decode_srgb = arguments.has(option::srgb);
  if (arguments.has(option::entry)) options.entry = arguments.text(option::entry);
  for (const auto& text : arguments.texts(option::uniform)) options.uniforms.push_back(parse_uniform(text));
  return options;
}

void require_file(const Command& command, const Arguments& arguments) {
  const bool takes_materials = std::ranges::any_of(command.positionals, &Positional::is_material);
  if (!takes_materials || !has_choices(read_options(arguments))) return;
  std::vector<Handle> materials;
  for (const auto& positional : command.positionals) materials.push_back(positional.handle);
  for (const auto& option : command.options) {
    if (option.value == "MATERIAL") materials.push_back(option.handle);
  }
  const auto has_file = [&](const Handle& handle) { return std::ranges::any_of(arguments.all(handle), names_file); };
  if (std::ranges::any_of(materials, has_file)) return;
  for (const auto& option : reading_options()) {
    if (!arguments.has(option.handle)) continue;
    throw ArgumentError(option.handle.dashed() + " is an option of files, and none is given; leave it out");
  }
}

std::vector<Field> function_fields(const BrdfFunction& function) {
  std::vector<Field> fields{{"format", function.format},
                            {"conventions", function.conventions},
                            {"channels", fmt::format("{}", fmt::join(function.channels, ", "))}};
  for (const auto& remark : function.remarks) fields.push_back({"remark", remark});
  return fields;
}

Json function_json(const BrdfFunction& function) {
  Json json{{"name", function.name},
            {"format", function.format},
            {"conventions", function.conventions},
            {"channel_names", function.channels},
            {"is_isotropic", function.is_isotropic},
            {"remarks", function.remarks}};
  if (!function.wavelengths.empty()) json["wavelengths_nm"] = function.wavelengths;
  return json;
}

std::string format_list(bool only_written) {
  std::vector<std::string> titles;
  for (const MeasuredFormat& format : measured_formats()) {
    if (only_written && !format.is_written) continue;
    titles.push_back(only_written ? fmt::format("{} ({})", format.name, format.title) : std::string(format.title));
  }
  return fmt::format("{}", fmt::join(titles, "; "));
}

}  // namespace lobe::cli
