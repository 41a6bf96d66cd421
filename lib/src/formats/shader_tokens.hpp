#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formats/file_bytes.hpp"

namespace lobe {

/// Where something stands in a text. Both count from 1; columns count characters.
struct ShaderPlace {
  std::uint32_t line = 1;
  std::uint32_t column = 1;
};

/// Refuses a shader at a place.
/// \throws IoError "cannot read FILE: line <line>, column <column>: <complaint>"
[[noreturn]] void refuse_shader(const FileBytes& file, const ShaderPlace& at, const std::string& complaint);

/// A token of the shading language.
struct ShaderToken {
  enum class Kind { name, real, integer, natural, sign, end };

  Kind kind = Kind::end;
  std::string_view text = {};  ///< in the file
  double number = 0;           ///< of numbers
  ShaderPlace at = {};         ///< what a macro stands for has the place of its use

  [[nodiscard]] bool is(std::string_view word) const { return kind != Kind::end && text == word; }
};

/// The tokens of a text, without comments and directives, and with macros replaced. The number of tokens is bounded,
/// whatever macros make of each other.
class ShaderTokens {
 public:
  /// \param file which must outlive this and its tokens
  explicit ShaderTokens(const FileBytes& file);

  /// The next token; at the end of the text one of kind `end`.
  /// \throws IoError that names the place
  [[nodiscard]] ShaderToken next();

 private:
  struct Macro {
    bool has_parameters = false;
    std::vector<std::string_view> parameters = {};
    std::vector<ShaderToken> body = {};
  };
  /// What a macro stands for, while it is read.
  struct Replacement {
    std::string_view macro;
    std::vector<ShaderToken> tokens;
    std::size_t at = 0;
  };

  [[noreturn]] void refuse(const ShaderPlace& at, const std::string& complaint) const;
  [[nodiscard]] ShaderPlace place() const { return {line_, column_}; }
  [[nodiscard]] char peek(std::size_t ahead = 0) const;
  void step();
  /// Steps over blanks and comments, to the end of the line at most if asked to.
  void skip_blanks(bool within_line);
  [[nodiscard]] bool is_end_of_line() const;

  /// A token of the text, with macros as they stand.
  [[nodiscard]] ShaderToken read_token();
  [[nodiscard]] ShaderToken read_number();
  /// The next token of a macro that is being read, or of the text.
  [[nodiscard]] ShaderToken raw();
  [[nodiscard]] ShaderToken expanded(std::size_t depth);
  [[nodiscard]] bool is_active(std::string_view macro) const;
  void replace(const ShaderToken& use, const Macro& macro, std::size_t depth);

  void read_directive();
  void read_definition();
  void read_condition(std::string_view directive, const ShaderPlace& at);
  [[nodiscard]] bool condition_holds(const ShaderPlace& at);
  /// Steps over lines that do not count, to the directive behind which lines do.
  void skip_group(const ShaderPlace& opened, bool may_have_else);
  [[nodiscard]] std::string_view read_word();
  void require_end_of_directive(std::string_view directive);

  const FileBytes& file_;
  std::string_view text_;
  std::size_t at_ = 0;
  std::uint32_t line_ = 1;
  std::uint32_t column_ = 1;
  bool starts_line_ = true;
  bool in_directive_ = false;
  std::size_t replaced_ = 0;  // tokens, by macros
  std::vector<ShaderPlace> open_groups_;
  std::map<std::string_view, Macro> macros_;
  std::vector<Replacement> replacements_;
};

/// As did_you_mean(), without a list that is long.
[[nodiscard]] std::string suggestion(std::string_view word, std::span<const std::string_view> names);

/// A token for messages.
[[nodiscard]] std::string shown(const ShaderToken& token);

}  // namespace lobe
