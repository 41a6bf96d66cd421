#include "render/shader_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "core/text.hpp"
#include "lobe/core/error.hpp"
#include "render/glsl_words.hpp"

namespace lobe {

bool begins_word(char letter) {
  return std::isalpha(static_cast<unsigned char>(letter)) != 0 || letter == '_';
}
bool continues_word(char letter) {
  return begins_word(letter) || std::isdigit(static_cast<unsigned char>(letter)) != 0;
}

std::string_view word_at(std::string_view text, std::size_t at) {
  const std::string_view rest = text.substr(at);
  const auto* const end = std::ranges::find_if_not(rest, continues_word);
  return rest.substr(0, static_cast<std::size_t>(end - rest.begin()));
}

void require_function_name(const std::string& name) {
  const bool is_name = !name.empty() && begins_word(name.front()) && std::ranges::all_of(name, continues_word);
  if (is_name && !is_glsl_word(name)) return;
  throw ArgumentError("'" + excerpt(name) + "' is no name of a function in GLSL; expected a letter, then letters, " +
                      "digits and single '_', and no word of GLSL itself");
}

void require_free_name(const std::string& name, std::string_view text) {
  for (std::size_t i = 0; name.starts_with(kShaderPrefix) && i < text.size();) {
    const std::string_view word = begins_word(text[i]) ? word_at(text, i) : text.substr(i, 1);
    if (word == name) {
      throw ArgumentError("'" + name + "' is a name that the text itself uses; expected another, such as lobe_brdf");
    }
    i += word.size();
  }
}

Eigen::MatrixXd shader_colours(const std::string& name, std::size_t channels, const ShaderOptions& options) {
  const auto columns = static_cast<Eigen::Index>(channels);
  if (options.weights.size() == 0) {
    if (channels == 3) return Eigen::MatrixXd::Identity(3, 3);
    if (channels == 1) return Eigen::MatrixXd::Ones(3, 1);
    throw ArgumentError(fmt::format("'{}' has {} channels; expected one, three, or colours for them", name, channels));
  }
  const bool has_rows = options.weights.rows() == 1 || options.weights.rows() == 3;
  if (!has_rows || options.weights.cols() != columns) {
    throw ArgumentError(fmt::format("colours have {} rows for {} channels; expected 1 or 3 rows for {}",
                                    options.weights.rows(), options.weights.cols(), channels));
  }
  return options.weights.rows() == 3 ? options.weights : options.weights.replicate(3, 1);
}

}  // namespace lobe
