#include "lobe/formats/measured.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/files.hpp"
#include "core/text.hpp"
#include "formats/channel_choice.hpp"
#include "formats/format.hpp"
#include "formats/text_end.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"
#include "lobe/reflectance/as_function.hpp"
#include "lobe/reflectance/tabulate.hpp"

namespace lobe {
namespace {

constexpr std::size_t kHead = std::size_t{1} << 16;  // bytes that a format is recognised by

/// Limits a reflectance to angles up to a largest one.
BrdfFunction limited(BrdfFunction brdf, double theta_max) {
  require_no_delta(brdf, "expected no largest angle");
  brdf.conventions +=
      fmt::format("; beyond {} degrees the values there", shortest(std::round(to_degrees(theta_max) * 1e6) / 1e6));
  brdf.at = [at = std::move(brdf.at), theta_max](std::span<const Directions> pairs) {
    std::vector<Directions> within(pairs.begin(), pairs.end());
    for (Directions& pair : within) {
      pair.theta_in = std::min(pair.theta_in, theta_max);
      pair.theta_out = std::min(pair.theta_out, theta_max);
    }
    return at(within);
  };
  brdf.cells = nullptr;
  brdf.ring_cells = nullptr;
  return brdf;
}

/// Names and wavelengths for the channels of the replicates, too.
BrdfFunction with_replicate_names(BrdfFunction brdf) {
  const auto names = brdf.channels;
  const auto wavelengths = brdf.wavelengths;
  for (std::size_t k = 1; k <= brdf.replicates; ++k) {
    for (const auto& name : names) brdf.channels.push_back(fmt::format("{}, replicate {}", name, k));
    brdf.wavelengths.insert(brdf.wavelengths.end(), wavelengths.begin(), wavelengths.end());
  }
  return brdf;
}

/// Names come into pictures, tables and onto terminals.
void require_plain_names(const BrdfFunction& brdf, const FileBytes& file) {
  const auto require = [&](std::string_view what, std::string_view text) {
    if (!has_control_characters(text)) return;
    file.refuse(fmt::format("{} '{}' has control characters; expected a text in one line", what, excerpt(text)));
  };
  require("its name", brdf.name);
  for (const auto& channel : brdf.channels) require("the channel", channel);
  require("its description", brdf.conventions);
  for (const auto& remark : brdf.remarks) require("what is said of it,", remark);
}

/// Formulas and tables by averages over patches; functions as they are: their writer averages them.
BrdfFunction with_cells(const Device& device, const Reflectance& reflectance, const WriteOptions& options) {
  if (reflectance.function() != nullptr) return *reflectance.function();
  const HemisphereGrid own = natural_grid(reflectance);
  return as_function(
      device, tabulate(device, reflectance, own.kind() == GridKind::klems ? own : HemisphereGrid::klems(145),
                       {.allow_unresolved = true, .cell_points = options.cell_points, .progress = options.progress}));
}

}  // namespace

BrdfFunction read_measured(const Format& format, const FileBytes& file, const ReadOptions& options) {
  if (!(options.theta_max > 0 && options.theta_max <= std::numbers::pi / 2)) {
    throw ArgumentError("the largest angle of a measurement is out of range; expected a value in (0, 90] degrees");
  }
  if (!format.takes_functions && (!options.entry.empty() || !options.uniforms.empty())) {
    throw ArgumentError("'" + file.stem() + "' is no shader; expected no function and no uniforms of one");
  }
  BrdfFunction brdf = format.read(file, options);
  if (std::string remark = remark_on_end(file); !remark.empty()) brdf.remarks.push_back(std::move(remark));
  require_plain_names(brdf, file);
  ReadOptions choice = options;
  if (format.makes_wavelengths) choice.wavelengths.clear();
  brdf = with_replicate_names(with_channels(std::move(brdf), choose_channels(brdf, choice)));
  return options.theta_max == std::numbers::pi / 2 ? brdf : limited(std::move(brdf), options.theta_max);
}

UniformValue parse_uniform(std::string_view text) {
  const std::size_t equals = text.find('=');
  UniformValue uniform{std::string(trim(text.substr(0, equals))), {}};
  bool is_right = equals != std::string_view::npos && !uniform.name.empty();
  if (is_right) {
    for (const std::string_view part : split(text.substr(equals + 1), '/')) {
      uniform.values.push_back(0);
      is_right = is_right && parse_number(trim(part), uniform.values.back());
    }
  }
  if (is_right) return uniform;
  throw ArgumentError(
      fmt::format("'{}' sets no uniform; expected NAME=VALUE, or NAME=A/B/C for a vector", excerpt(text)));
}

bool has_choices(const ReadOptions& options) {
  return !options.channels.empty() || !options.wavelengths.empty() || !options.luminance.empty() ||
         options.theta_max != ReadOptions{}.theta_max || !options.component.empty() || options.decode_srgb ||
         !options.entry.empty() || !options.uniforms.empty();
}

BrdfFunction load_measured(const std::filesystem::path& path, const ReadOptions& options) {
  const FileBytes head = FileBytes::read_head(path, kHead);
  const Format* format = format_of(head);
  if (format == nullptr) head.refuse("it is of no known format", Fault::unknown_format);
  return read_measured(*format, head.size() == head.file_size() ? head : FileBytes::read(path), options);
}

bool is_measured_file(const std::filesystem::path& path) {
  try {
    return format_of(FileBytes::read_head(path, kHead)) != nullptr;
  } catch (const IoError&) {
    return false;
  }
}

void save_measured(const Device& device, const Reflectance& reflectance, std::string_view format,
                   const std::filesystem::path& path, const WriteOptions& options) {
  std::vector<std::string_view> written;
  for (const Format* known : formats()) {
    if (known->write == nullptr) continue;
    if (known->name == format) {
      const BrdfFunction brdf =
          known->holds_cells ? with_cells(device, reflectance, options) : as_function(device, reflectance);
      if (!known->holds_cells) require_no_delta(brdf, "expected a format of patches (klems), or values alone");
      return write_text(path, options.overwrite, known->write(brdf, options));
    }
    written.push_back(known->name);
  }
  throw ArgumentError(fmt::format("no format '{}' is written{}", format, did_you_mean(format, written)));
}

std::vector<MeasuredFormat> measured_formats() {
  std::vector<MeasuredFormat> list;
  for (const Format* format : formats()) list.push_back({format->name, format->title, format->write != nullptr});
  std::ranges::sort(list, {}, &MeasuredFormat::title);
  return list;
}

}  // namespace lobe
