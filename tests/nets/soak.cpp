// Random studies, each computed on the device, once more with a hundredth of the tolerance or twice the grid, and, of
// models that the independent reference has, by that. Numbers that differ by more than both state are disagreements:
// each is written as a study file that shows it. usage: lobe_soak [--seed N] [--studies N] [--seconds N] [--output
// DIRECTORY]
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/text.hpp"
#include "lobe/core/error.hpp"
#include "lobe/model/model.hpp"
#include "lobe/study/material_file.hpp"
#include "lobe/study/study.hpp"
#include "reference/models.hpp"
#include "reference/quadrature.hpp"
#include "support/random_specifications.hpp"

namespace {

using namespace lobe;
using test::Dice;
namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr double kLongest = 20;  // seconds for one computation; what takes longer says nothing about errors
constexpr double kFinerTolerance = 0.01;

/// A lobe of the reference, as it and as the catalogue write it.
struct Known {
  std::string specification;
  reference::Lobe lobe;
};

/// Lobes that are wide enough for the reference's rules.
Known known_lobe(Dice& dice) {
  const double width = dice.spread(0.2, 0.6);
  const double n = 1 / (2 * width * width);
  const auto make = [&](std::string text, auto f) { return Known{std::move(text), {f, width}}; };
  using reference::Real;
  using reference::Vector;
  switch (dice.below(7)) {
    case 0:
      return {"lambert", {[](const Vector& l, const Vector& v) { return reference::lambert(l, v); }, 1}};
    case 1:
      return make("phong:n=" + shortest(n),
                  [n](const Vector& l, const Vector& v) { return reference::phong(l, v, n); });
    case 2:
      return make("metal_phong:n=" + shortest(n),
                  [n](const Vector& l, const Vector& v) { return reference::metal_phong(l, v, n); });
    case 3:
      return make("blinn:n=" + shortest(4 * n),
                  [n](const Vector& l, const Vector& v) { return reference::blinn(l, v, 4 * n); });
    case 4: {
      const double k = dice.uniform(0, 2);
      return make("minnaert:k=" + shortest(k),
                  [k](const Vector& l, const Vector& v) { return reference::minnaert(l, v, k); });
    }
    case 5:
      return make("exponential_patch:s=" + shortest(1 / (2 * width)), [width](const Vector& l, const Vector& v) {
        return reference::exponential_patch(l, v, 1 / (2 * Real(width)));
      });
    default: {
      const double f0 = dice.uniform(0, 1);
      return make("ggx:alpha=" + shortest(width) + ",f0=" + shortest(f0),
                  [width, f0](const Vector& l, const Vector& v) { return reference::ggx(l, v, width, f0); });
    }
  }
}

/// A study as text, and what the reference knows of its materials.
struct Drawn {
  std::string text, finer;  ///< the same but for tolerance or grid
  std::vector<std::optional<reference::Lobe>> known;
};

/// As [[material]] of a study.
std::string material_table(Material material, const std::string& name) {
  material.name = name;
  std::string text = "[[material]]\n" + material_toml(material) + "\n";
  for (std::size_t at = 0; (at = text.find("[[terms]]", at)) != text.npos;) text.replace(at, 9, "[[material.terms]]");
  return text;
}

std::string random_formula(Dice& dice, std::size_t number) {
  const std::vector<std::string> formulas{"a / pi",
                                          "a * pow(fmax(cos_h, 0.01), 4 * b) / pi",
                                          "a * exp(-b * tan2_h) / pi",
                                          "a * (1 + b * cos_i * cos_o) / pi",
                                          "where(cos_d > 0.5, a, a * 0.8) / (pi + b)",
                                          "a * sqrt(cos_i * cos_o) / (cos_i + cos_o + b)"};
  return "[[material]]\nname = \"m" + std::to_string(number) + "\"\nmodel = \"custom\"\nformula = \"" +
         formulas[dice.below(formulas.size())] + "\"\na = " + shortest(dice.uniform(0.05, 0.9)) +
         "\nb = " + shortest(dice.uniform(0.1, 5)) + "\n";
}

/// Files that are read in a moment.
const std::vector<fs::path>& measured_files() {
  static const std::vector<fs::path> kFiles = [] {
    std::vector<fs::path> files;
    const char* directory = std::getenv("LOBE_DATA_DIR");
    std::error_code code;
    if (directory == nullptr || !fs::is_directory(directory, code)) return files;
    for (const char* folder : {"nbrdf/merl", "klems_derived", "nist_ptfe"}) {
      for (fs::recursive_directory_iterator at(fs::path(directory) / folder, code), end; !code && at != end; ++at) {
        const std::string extension = at->path().extension().string();
        const bool is_data = extension == ".h5" || extension == ".xml" || extension == ".csv";
        if (is_data && at->is_regular_file() && at->file_size() < 400'000) files.push_back(at->path());
      }
    }
    std::ranges::sort(files);
    return files;
  }();
  return kFiles;
}

std::string random_text(Dice& dice, std::span<const Model* const> models) {
  const auto model = [&] { return test::random_specification(dice, *models[dice.below(models.size())]); };
  std::string text = model();
  switch (dice.below(5)) {
    case 0:
      return text + "*" + test::random_specification(dice, factors()[dice.below(factors().size())]);
    case 1:
      return text + (text.find(':') == text.npos ? ":" : ",") + "scale=" + shortest(dice.uniform(0.1, 1));
    case 2:
      return text + "+lambert:scale=" + shortest(dice.uniform(0.1, 1));
    case 3: {
      constexpr std::array kAdjustments{"@normalise", "@pump:correction=g1", "@pump:correction=g2",
                                        "@pump:correction=controlled,times=2"};
      return dice.below(2) == 0 ? text + kAdjustments[dice.below(kAdjustments.size())] : text + "+" + model();
    }
    default:
      return text;
  }
}

Drawn draw_study(Dice& dice, const std::string& name) {
  static const std::vector<const Model*> kIsotropic = [] {
    std::vector<const Model*> models;
    for (const Model& model : catalogue()) {
      if (!model.traits.has_delta && model.traits.reciprocal && model.traits.isotropic) models.push_back(&model);
    }
    return models;
  }();
  static const std::vector<const Model*> kAnisotropic = [] {
    std::vector<const Model*> models;
    for (const Model& model : catalogue()) {
      if (!model.traits.has_delta && !model.traits.isotropic) models.push_back(&model);
    }
    return models;
  }();
  Drawn drawn;
  const bool is_anisotropic = dice.below(12) == 0;
  const bool is_on_grid = !is_anisotropic && dice.below(6) == 0;
  std::string materials;
  const std::size_t count = 2 + dice.below(3);
  for (std::size_t k = 0; k < count; ++k) {
    const std::string called = "m" + std::to_string(k);
    drawn.known.emplace_back();
    const std::size_t kind = dice.below(10);
    if (is_anisotropic && k == 0) {
      materials += material_table(
          parse_material(test::random_specification(dice, *kAnisotropic[dice.below(kAnisotropic.size())])), called);
    } else if (kind < 5 || is_on_grid) {
      Known known = known_lobe(dice);
      materials += material_table(parse_material(known.specification), called);
      drawn.known.back() = std::move(known.lobe);
    } else if (kind == 5) {
      materials += random_formula(dice, k);
    } else if (kind == 6 && !is_anisotropic && dice.below(3) == 0 && !measured_files().empty()) {
      materials += "[[measured]]\nname = \"" + called + "\"\nfile = \"" +
                   measured_files()[dice.below(measured_files().size())].string() + "\"\nluminance = \"rec709\"\n\n";
    } else {
      materials += material_table(parse_material(random_text(dice, kIsotropic)), called);
    }
  }
  std::vector<std::string> lightings;
  for (const char* lighting : {"point", "daylight", "mean-albedo"}) {
    if (dice.below(2) == 0) lightings.emplace_back(lighting);
  }
  if (lightings.empty() || (!is_anisotropic && dice.below(4) == 0)) {
    lightings.push_back(is_anisotropic ? "point" : "patch:" + shortest(dice.uniform(0.15, 1.5)));
  }
  std::string list;
  for (const auto& lighting : lightings) list += (list.empty() ? "\"" : ", \"") + lighting + "\"";
  const double tolerance = dice.spread(1e-6, 1e-2);
  const double patch_tolerance = dice.spread(1e-4, 1e-2);
  const std::size_t rings = 8 + 4 * dice.below(3);
  const auto text = [&](double share, std::size_t times) {
    std::string head = "[study]\nname = \"" + name + "\"\nlightings = [" + list +
                       "]\ntolerance = " + shortest(tolerance * share) +
                       "\npatch_tolerance = " + shortest(patch_tolerance * share) +
                       "\nfunction_tolerance = " + shortest(5e-3 * share) + "\n";
    if (is_on_grid) {
      head += "grid = \"gauss:" + std::to_string(rings * times) + "x" + std::to_string(2 * rings * times) + "\"\n";
    }
    return head + "\n" + materials;
  };
  drawn.text = text(1, 1);
  drawn.finer = is_on_grid ? text(1, 2) : text(kFinerTolerance, 1);
  return drawn;
}

/// What became of it all.
struct Tally {
  std::size_t studies = 0;
  std::size_t refused = 0;  ///< by the library, in one line
  std::size_t too_long = 0;
  std::size_t numbers = 0;     ///< compared with finer ones
  std::size_t referenced = 0;  ///< compared with the reference
  std::size_t unknown = 0;     ///< of which the error is not known
  std::size_t disagreements = 0;
  double largest = 0;  ///< difference over what is stated
};

class Comparison {
 public:
  Comparison(Tally& tally, const Drawn& drawn, fs::path file) : tally_(tally), drawn_(drawn), file_(std::move(file)) {}

  void hold(const std::string& what, double value, double error, double other, double other_error, bool is_reference) {
    if (!std::isfinite(error) || !std::isfinite(other_error)) {
      ++tally_.unknown;
      return;
    }
    ++(is_reference ? tally_.referenced : tally_.numbers);
    const double stated = error + other_error + 4 * std::numeric_limits<double>::epsilon() * std::abs(value);
    const double ratio = std::isfinite(value) && std::isfinite(other)
                             ? std::abs(value - other) / std::max(stated, 1e-300)
                             : std::numeric_limits<double>::infinity();
    tally_.largest = std::max(tally_.largest, ratio);
    if (ratio <= 1) return;
    ++tally_.disagreements;
    note(what + " is " + shortest(value) + " ± " + shortest(error) + ", " +
         (is_reference ? "by the reference " : "finer ") + shortest(other) + " ± " + shortest(other_error) +
         ": off by " + shortest(ratio) + " of that");
  }
  void note(const std::string& what) {
    if (notes_.empty()) std::cout << "disagreement: " << file_.string() << "\n";
    std::cout << "  " << what << "\n";
    notes_ += "# " + what + "\n";
  }
  /// Leaves the study where there is something to see.
  void write() const {
    if (notes_.empty()) return;
    fs::create_directories(file_.parent_path());
    fs::path finer = file_;
    finer.replace_extension(".finer.toml");
    std::ofstream(file_) << "#     lobe gram " << file_.filename().string() << "\n#     lobe gram "
                         << finer.filename().string() << "\n"
                         << notes_ << "\n"
                         << drawn_.text;
    std::ofstream(finer) << drawn_.finer;
  }

 private:
  Tally& tally_;
  const Drawn& drawn_;
  fs::path file_;
  std::string notes_;
};

StudyResult computed(const Device& device, const std::string& text, const fs::path& directory) {
  const fs::path file = directory / "soak.toml";
  std::ofstream(file) << text;
  const Study study = load_study(file);
  const auto end = Clock::now() + std::chrono::duration<double>(kLongest);
  return run_study(device, study, [&](std::string_view, double) { return Clock::now() < end; });
}

void compare(const Metric& found, const Metric& finer, const Study& study, const std::string& where,
             Comparison& comparison) {
  const auto name_at = [&](Eigen::Index i) { return study.materials[static_cast<std::size_t>(i)].name(); };
  for (Eigen::Index i = 0; i < found.norm.size(); ++i) {
    const std::string name = name_at(i);
    comparison.hold("norm of " + name + where, found.norm(i), found.norm_error(i), finer.norm(i), finer.norm_error(i),
                    false);
    for (Eigen::Index j = 0; j <= i; ++j) {
      const std::string pair = name + ", " + name_at(j) + where;
      comparison.hold("product of " + pair, found.gram(i, j), found.gram_error(i, j), finer.gram(i, j),
                      finer.gram_error(i, j), false);
      if (j < i) {
        comparison.hold("distance of " + pair, found.distance(i, j), found.distance_error(i, j), finer.distance(i, j),
                        finer.distance_error(i, j), false);
      }
    }
  }
}

std::string name_of(std::size_t material) {
  return "m" + std::to_string(material);
}

/// Materials of a family stand together in results.
Eigen::Index place_of(const Study& study, const std::string& name) {
  return std::ranges::find(study.materials, name, &StudyMaterial::name) - study.materials.begin();
}

/// The product by the reference, and how well that is known.
std::optional<std::pair<double, double>> reference_product(const Lighting& lighting, const reference::Lobe& f,
                                                           const reference::Lobe& g) {
  // Of its rules, for lobes as wide as these: the mean albedo of metal_phong with n = 2.02 is off by 7e-7.
  constexpr double kQuadrature = 5e-6;
  if (lighting == Lighting::mean_albedo()) {
    const double value = std::numbers::pi * std::numbers::pi * reference::mean_albedo(f) * reference::mean_albedo(g);
    return std::pair(value, kQuadrature * value);
  }
  if (lighting == Lighting::daylight()) {
    const double value = reference::daylight_product(f, g);
    return std::pair(value, kQuadrature * value);
  }
  if (lighting == Lighting::point()) {
    const double value = reference::point_product(f, g, 7);
    const double rougher = reference::point_product(f, g, 5);
    return std::pair(value, std::abs(value - rougher) + kQuadrature * value);
  }
  return std::nullopt;
}

void compare_with_reference(const StudyResult& result, const Drawn& drawn, Dice& dice, Comparison& comparison) {
  std::vector<std::size_t> known;
  for (std::size_t k = 0; k < drawn.known.size(); ++k) {
    if (drawn.known[k]) known.push_back(k);
  }
  if (known.empty()) return;
  // One product of one lighting: the reference takes its time.
  const MetricResult& metric = result.metrics[dice.below(result.metrics.size())];
  const std::size_t first = known[dice.below(known.size())];
  const std::size_t second = known[dice.below(known.size())];
  const auto product = reference_product(metric.lighting, *drawn.known[first], *drawn.known[second]);
  if (!product) return;
  const auto i = place_of(result.study, name_of(first));
  const auto j = place_of(result.study, name_of(second));
  comparison.hold("product of " + name_of(first) + ", " + name_of(second) + " under " + metric.lighting.name(),
                  metric.combined.gram(i, j), metric.combined.gram_error(i, j), product->first, product->second, true);
}

void soak_one(const Device& device, std::uint64_t seed, std::size_t number, const fs::path& output,
              const fs::path& scratch, Tally& tally) {
  const auto start = Clock::now();
  Dice dice(seed * 1'000'003 + number);
  const std::string name = "soak-" + std::to_string(seed) + "-" + std::to_string(number);
  const Drawn drawn = draw_study(dice, name);
  Comparison comparison(tally, drawn, output / (name + ".toml"));
  ++tally.studies;
  try {
    const StudyResult found = computed(device, drawn.text, scratch);
    compare_with_reference(found, drawn, dice, comparison);
    const StudyResult finer = computed(device, drawn.finer, scratch);
    for (std::size_t m = 0; m < found.metrics.size(); ++m) {
      compare(found.metrics[m].combined, finer.metrics[m].combined, found.study,
              " under " + found.metrics[m].lighting.name(), comparison);
    }
  } catch (const Cancelled&) {
    ++tally.too_long;
  } catch (const DeviceError& error) {
    ++tally.disagreements;
    comparison.note(std::string("the device fails: ") + error.what());
  } catch (const Error& error) {
    ++tally.refused;
    if (std::getenv("LOBE_SOAK_VERBOSE") != nullptr) std::cout << name << ": " << error.what() << "\n";
  } catch (const std::exception& error) {
    ++tally.disagreements;
    comparison.note(std::string("an internal error: ") + error.what());
  }
  comparison.write();
  if (std::getenv("LOBE_SOAK_VERBOSE") != nullptr) {
    std::cout << name << ": " << std::chrono::duration<double>(Clock::now() - start).count() << " s" << std::endl;
  }
}

double number_of(const std::map<std::string, std::string>& options, const std::string& name, double otherwise) {
  const auto found = options.find(name);
  return found == options.end() ? otherwise : std::strtod(found->second.c_str(), nullptr);
}

}  // namespace

int main(int count, char** words) {
  std::map<std::string, std::string> options;
  for (int k = 1; k + 1 < count; k += 2) options[words[k]] = words[k + 1];
  const auto seed = static_cast<std::uint64_t>(number_of(options, "--seed", 1));
  const double studies = number_of(options, "--studies", 1e9);
  const double seconds = number_of(options, "--seconds", studies < 1e9 ? 1e9 : 60);
  const fs::path output = options.contains("--output") ? options["--output"] : "soak";
  const fs::path scratch = fs::temp_directory_path() / ("lobe-soak-" + std::to_string(::getpid()));
  fs::create_directories(scratch);
  const Device device = Device::choose();
  Tally tally;
  const auto end = Clock::now() + std::chrono::duration<double>(seconds);
  for (std::size_t k = 0; static_cast<double>(k) < studies && Clock::now() < end; ++k) {
    soak_one(device, seed, k, output, scratch, tally);
  }
  fs::remove_all(scratch);
  std::cout << "seed " << seed << ": " << tally.studies << " studies, " << tally.refused << " of them refused, "
            << tally.too_long << " stopped after " << kLongest << " s; " << tally.numbers
            << " numbers compared with finer ones, " << tally.referenced << " with the reference, " << tally.unknown
            << " without known error; " << tally.disagreements << " disagreements; largest difference " << tally.largest
            << " of what both state\n";
  if (tally.numbers == 0) {
    std::cout << "nothing was compared\n";
    return 1;
  }
  return tally.disagreements == 0 ? 0 : 1;
}
