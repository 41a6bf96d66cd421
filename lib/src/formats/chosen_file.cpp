#include "lobe/formats/chosen_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <set>
#include <system_error>
#include <vector>

#include "core/text.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"

namespace lobe {
namespace {

constexpr std::array kChoices{
    WrittenForm{"channels", "channels=NAME,...", "channels by name, or by number from 1 on"},
    WrittenForm{"wavelengths", "wavelengths=NM,...", "wavelengths of spectra, nm, which become the channels"},
    WrittenForm{"luminance", "luminance=WEIGHTS", "one channel: rec709 of red, green and blue, photopic of spectra"},
    WrittenForm{"theta_max", "theta_max=DEGREES",
                "angle from the normal up to which the file counts; beyond, values are those "
                "there"},
    WrittenForm{"component", "component=NAME", "of files with several: reflection front or reflection back"},
    WrittenForm{"srgb", "srgb", "values are sRGB-encoded (UTIA): decode them"},
    WrittenForm{"entry", "entry=NAME", "function of a shader (default: the last one of two directions)"},
    WrittenForm{"uniform", "uniform=NAME=VALUE",
                "value of a uniform of a shader, A/B/C for a vector; may be repeated"}};

constexpr std::array<std::string_view, 2> kWeights{"rec709", "photopic"};

/// Reads what stands between the brackets at the end of a text.
class Brackets {
 public:
  Brackets(const std::string& text, std::size_t open, const ReadOptions& options)
      : text_(text), open_(open), options_(options) {}

  ReadOptions read() {
    const std::string_view inside = std::string_view(text_).substr(open_ + 1, text_.size() - open_ - 2);
    if (trim(inside).empty()) fail(open_ + 1, fmt::format("nothing stands in the brackets; expected {}", expected()));
    for (const std::string_view part : split(inside, ',')) {
      at_ = static_cast<std::size_t>(part.data() - text_.data());
      at_ += std::min(part.find_first_not_of(" \t"), part.size());
      read_part(part);
    }
    return std::move(options_);
  }

 private:
  [[noreturn]] void fail(std::size_t at, const std::string& complaint) const {
    throw ArgumentError(fmt::format("'{}', character {}: {}", text_, at + 1, complaint));
  }

  static std::string expected() { return "KEY=VALUE,..., as in [theta_max=80,luminance=rec709]"; }

  void read_part(std::string_view part) {
    const std::size_t equals = part.find('=');
    std::string key(trim(part.substr(0, equals)));
    std::ranges::replace(key, '-', '_');
    if (equals != std::string_view::npos) {
      begin(key);
      at_ = static_cast<std::size_t>(part.data() - text_.data()) + equals + 1;
      take(trim(part.substr(equals + 1)));
    } else if (key == "srgb") {
      begin(key);
      options_.decode_srgb = true;
    } else if (key_ == "channels" || key_ == "wavelengths") {
      take(trim(part));
    } else {
      fail(at_, fmt::format("'{}' is no KEY=VALUE; expected {}", trim(part), expected()));
    }
  }

  void begin(const std::string& key) {
    std::vector<std::string_view> known;
    for (const WrittenForm& form : kChoices) known.push_back(form.word);
    if (std::ranges::find(known, key) == known.end()) {
      fail(at_, fmt::format("unknown option '{}' of a file{}", key, did_you_mean(key, known)));
    }
    if (!given_.insert(key).second && key != "uniform")
      fail(at_, fmt::format("'{}' is given twice; expected it once", key));
    key_ = key;
    if (key != "channels" && key != "wavelengths" && key != "luminance") return;
    if (!chosen_.empty()) {
      fail(at_,
           fmt::format("'{}' stands beside '{}'; expected one of channels, wavelengths and luminance", key, chosen_));
    }
    chosen_ = key;
    options_.channels.clear();
    options_.wavelengths.clear();
    options_.luminance.clear();
  }

  void take(std::string_view value) {
    if (value.empty()) fail(at_, fmt::format("'{}' has no value; expected {}", key_, written(key_)));
    if (key_ == "channels") {
      options_.channels.emplace_back(value);
    } else if (key_ == "wavelengths") {
      options_.wavelengths.push_back(number(value, "a wavelength in nm"));
    } else if (key_ == "luminance") {
      if (std::ranges::find(kWeights, value) == kWeights.end()) {
        fail(at_, fmt::format("unknown weights of luminance '{}'{}", value, did_you_mean(value, kWeights)));
      }
      options_.luminance = value;
    } else if (key_ == "component") {
      options_.component = value;
    } else if (key_ == "entry") {
      options_.entry = value;
    } else if (key_ == "uniform") {
      set_uniform(value);
    } else if (key_ == "theta_max") {
      const double degrees = number(value, "degrees above 0, at most 90");
      try {
        options_.theta_max = theta_max_of(degrees);
      } catch (const ArgumentError& error) {
        fail(at_, error.what());
      }
    } else {
      read_truth(value);
    }
  }

  /// Replaces a value that holds for all files.
  void set_uniform(std::string_view value) {
    try {
      UniformValue uniform = parse_uniform(value);
      std::erase_if(options_.uniforms, [&](const UniformValue& other) { return other.name == uniform.name; });
      options_.uniforms.push_back(std::move(uniform));
    } catch (const ArgumentError& error) {
      fail(at_, error.what());
    }
  }

  void read_truth(std::string_view value) {
    if (value != "true" && value != "false") {
      fail(at_, fmt::format("srgb is '{}'; expected true or false", value));
    }
    options_.decode_srgb = value == "true";
  }

  static std::string_view written(std::string_view key) {
    return std::ranges::find(kChoices, key, &WrittenForm::word)->written;
  }

  [[nodiscard]] double number(std::string_view value, std::string_view expectation) const {
    double number = 0;
    if (!parse_number(value, number) || !(number > 0)) {
      fail(at_, fmt::format("{} has '{}'; expected {}", key_, value, expectation));
    }
    return number;
  }

  const std::string& text_;
  std::size_t open_;
  ReadOptions options_;
  std::size_t at_ = 0;           // of what is being read
  std::string key_ = {};         // that values belong to
  std::string chosen_ = {};      // what chooses the channels
  std::set<std::string> given_;  // keys
};

bool is_file(const std::string& text) {
  std::error_code ignored;
  return std::filesystem::exists(text, ignored);
}

bool is_adjustment(std::string_view text) {
  const std::string_view word = trim(text.substr(0, text.find(':')));
  return std::ranges::find(adjustment_forms(), word, &WrittenForm::word) != adjustment_forms().end();
}

/// Where the '@' of adjustments of a file stands. A path may have one of its own, and a specification has it behind
/// something that looks like no path: it has neither slash nor point before the values of its models.
std::optional<std::size_t> place_of_adjustments(const std::string& text) {
  for (std::size_t at = text.find('@'); at != std::string::npos; at = text.find('@', at + 1)) {
    const std::string name = text.substr(0, at);
    const std::size_t mark = name.find_first_of("/.");
    if (mark == std::string::npos || name.find_first_of(":=") < mark) continue;
    const std::string path = name.ends_with(']') ? name.substr(0, name.rfind('[')) : name;
    std::error_code ignored;
    if (path.ends_with(".toml") || std::filesystem::is_regular_file(path, ignored)) return at;
    const std::string_view behind = std::string_view(text).substr(at + 1);
    if (is_adjustment(behind.substr(0, behind.find('@')))) return at;
  }
  return {};
}

/// \throws ArgumentError where a file is a term of a sum, or has a factor
void refuse_operators(const std::string& text) {
  if (text.ends_with(']') && is_file(text.substr(0, text.rfind('[')))) return;
  for (std::size_t at = text.find_first_of("+*"); at != std::string::npos; at = text.find_first_of("+*", at + 1)) {
    for (const std::string& part : {text.substr(0, at), text.substr(at + 1)}) {
      const std::string path(trim(part.substr(0, part.find('['))));
      std::error_code ignored;
      if (!std::filesystem::is_regular_file(path, ignored)) continue;
      throw ArgumentError(
          fmt::format("'{}', character {}: sums and factors are those of formulas, and {} is a file; 'lobe mix' adds "
                      "files, tables and materials",
                      text, at + 1, path));
    }
  }
}

}  // namespace

ChosenFile parse_file(const std::string& text, const ReadOptions& options) {
  if (is_file(text)) return {text, options};
  refuse_operators(text);
  if (const auto at = place_of_adjustments(text)) {
    ChosenFile file = parse_file(text.substr(0, *at), options);
    for (const std::string_view part : split(std::string_view(text).substr(*at + 1), '@')) {
      file.adjustments.push_back(parse_adjustment(trim(part)));
    }
    return file;
  }
  const std::size_t open = text.rfind('[');
  if (open == std::string::npos) return {text, options};
  const std::string path = text.substr(0, open);
  if (!text.ends_with(']')) {
    if (!is_file(path)) return {text, options};
    throw ArgumentError(fmt::format("'{}', character {}: no ']' closes this bracket; expected {}[KEY=VALUE,...]", text,
                                    open + 1, path));
  }
  if (path.empty()) {
    throw ArgumentError(
        fmt::format("'{}', character 1: no file stands before the bracket; expected FILE[KEY=VALUE,...]", text));
  }
  return {path, Brackets(text, open, options).read(), true};
}

void refuse_adjustments(const ChosenFile& file) {
  if (file.adjustments.empty()) return;
  throw ArgumentError(
      fmt::format("'@{}' behind {} adjusts a formula; expected a specification or a material file "
                  "in front of it",
                  to_string(file.adjustments.front()), file.path.string()));
}

std::span<const WrittenForm> file_choices() {
  return kChoices;
}

double theta_max_of(double degrees) {
  if (degrees > 0 && degrees <= 90) return degrees * kDegree;
  throw ArgumentError(fmt::format("theta_max is {}; expected degrees above 0, at most 90", shortest(degrees)));
}

}  // namespace lobe
