#include "study/run/study_identity.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cstdint>
#include <fstream>
#include <system_error>

#include "core/build_identity.hpp"
#include "core/checksum.hpp"
#include "core/text.hpp"
#include "lobe/core/error.hpp"
#include "lobe/core/version.hpp"
#include "study/run/study_channels.hpp"

namespace lobe {
namespace {

namespace fs = std::filesystem;

std::string text_of(const ReadOptions& options) {
  std::string text =
      fmt::format("{} {} {} {} {} {}", fmt::join(options.channels, ","), fmt::join(options.wavelengths, ","),
                  options.luminance, options.theta_max, options.component, options.decode_srgb);
  if (!options.entry.empty()) text += " " + options.entry;
  for (const auto& [name, values] : options.uniforms) text += fmt::format(" {}={}", name, fmt::join(values, "/"));
  return text;
}

/// Tolerances and such.
std::string text_of_settings(const Study& study) {
  std::string text =
      fmt::format("{} {} {} {} {} {} {} {} {}\n", shortest(study.tolerance), shortest(study.patch_tolerance),
                  shortest(study.function_tolerance), shortest(study.comparison_tolerance),
                  shortest(study.domain_theta_max), static_cast<int>(study.precision),
                  study.grid ? study.grid->name() : "", study.allow_unresolved, study.configuration);
  for (const double weight : study.channel_weights) text += shortest(weight) + "\n";
  return text;
}

std::string text_digest(std::string_view text) {
  Checksum sum;
  sum.add(text);
  return fmt::format("{:016x}", sum.value());
}

/// Number of the bytes of a file, and their checksum.
std::string content_digest(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  Checksum sum;
  std::uint64_t size = 0;
  std::array<char, 1 << 16> part{};
  while (file.read(part.data(), part.size()) || file.gcount() > 0) {
    const auto count = static_cast<std::size_t>(file.gcount());
    sum.add({part.data(), count});
    size += count;
  }
  if (!file.eof()) throw IoError("cannot read " + path.string(), {.fault = Fault::missing_file, .path = path.string()});
  return fmt::format("{} {:016x}", size, sum.value());
}

std::string text_of(const MaterialFile& file) {
  return fmt::format("{} {} {}", file.name, content_digest(file.path), text_of(file.options));
}

std::string text_of(const std::optional<double>& number) {
  return number ? shortest(*number) : "";
}

std::string text_of(const PublishedFigure& figure) {
  std::string text =
      fmt::format("{}\n{}\n{} {} {} {} {}\n{}\n{}\n", figure.table, figure.label, to_string(figure.quantity),
                  shortest(figure.offset), text_of(figure.tolerance), figure.printed, figure.corrected,
                  to_json(figure.material), figure.unit ? to_json(*figure.unit) : "");
  for (const auto& at : figure.at) {
    text += fmt::format("{} {} {} {}\n", shortest(at.theta_in), shortest(at.theta_out), shortest(at.delta_phi),
                        shortest(at.phi_in));
  }
  for (const double coefficient : figure.coefficients) text += shortest(coefficient) + "\n";
  return text;
}

std::string text_of(const Chart& chart) {
  std::string text = fmt::format("{}\n{} {} {}\n", chart.name, to_string(chart.quantity), text_of(chart.tolerance),
                                 chart.unit ? to_json(*chart.unit) : "");
  for (const double x : chart.x) text += shortest(x) + "\n";
  for (const auto& curve : chart.curves) {
    text += fmt::format("{}\n{}\n", curve.label, shortest(curve.theta_in));
    for (const auto& material : curve.materials) text += to_json(material) + "\n";
  }
  return text;
}

/// Everything in a study that its results depend on, and what of it they repeat.
std::string plan_text(const Study& study) {
  std::string text = study.name + "\n" + text_of_settings(study);
  for (const auto& file : study.texts) text += fmt::format("{}\n{}\n", file.name, file.text);
  text += fmt::format("{}\n{}\n{}\n", study.title, study.comment, fmt::join(study.references, "\n"));
  text += fmt::format("{}\n{}\n", fmt::join(study.overrides, "\n"), fmt::join(study.channels, "\n"));
  for (std::size_t i = 0; i < study.materials.size(); ++i) {
    const StudyMaterial& material = study.materials[i];
    text += material.name() + "\n" + material.family() + "\n";
    if (const MaterialFile* file = material.file()) text += text_of(*file);
    if (const Material* formula = material.formula()) text += to_json(*formula);
    text += "\n";
  }
  for (const auto& lighting : study.lightings) text += lighting.name() + "\n";
  for (const auto& file : study.lighting_files) text += text_of(file) + "\n";
  for (const auto comparison : study.comparison_metrics) text += fmt::format("{}\n", to_string(comparison));
  for (const auto fit : study.approximations) text += fmt::format("{}\n", to_string(fit));
  for (const auto& figure : study.published) text += text_of(figure);
  for (const auto& chart : study.charts) text += text_of(chart);
  return text;
}

}  // namespace

std::string checkpoint_identity(const Study& study, const Device& device) {
  const DeviceInfo info = device.info();
  std::string text = fmt::format("{} {} {}\n{} {} {} {}\n", version(), commit(), build_identity(), info.selector,
                                 info.platform_version, info.name, info.driver);
  text += text_of_settings(study);
  for (std::size_t i = 0; i < study.materials.size(); ++i) {
    const StudyMaterial& material = study.materials[i];
    if (const Material* formula = material.formula()) text += to_json(*formula);
    if (const MaterialFile* file = material.file()) {
      std::error_code code;
      const auto time = fs::last_write_time(file->path, code).time_since_epoch().count();
      text += fmt::format("{} {} {} {}", file->path.string(), fs::file_size(file->path, code), time,
                          text_of(file->options));
    }
    text += "\n";
  }
  return text;
}

std::string part_digest(const PublishedFigure& figure) {
  return text_digest(text_of(figure));
}

std::string part_digest(const Chart& chart) {
  return text_digest(text_of(chart));
}

PlanIdentity plan_identity(const Study& study, const Device& device) {
  const DeviceInfo info = device.info();
  return {.version = fmt::format("{} ({})", version(), commit()),
          .build = build_identity(),
          .device = fmt::format("{}, {}, driver {}", info.name, info.platform_version, info.driver),
          .plan = text_digest(plan_text(with_channels(study)))};
}

}  // namespace lobe
