#pragma once

#include <map>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "interface/exit_code.hpp"
#include "interface/handle.hpp"

namespace lobe::cli {

class Session;

/// An option of a command. The parser and the help text are made from these tables and from nothing else.
struct Option {
  Handle handle;
  char letter = '\0';                          ///< short form, if any
  std::string_view value = {};                 ///< its value, as the help text names it; empty: a switch
  std::string_view help = {};                  ///< one or two phrases
  std::vector<std::string_view> choices = {};  ///< the only values allowed; empty: any
  bool required = false;

  [[nodiscard]] std::string_view name() const { return handle.name(); }
};

/// An argument given by its place.
struct Positional {
  Handle handle;
  std::string_view help;
  bool required = true;
  bool is_material = false;  ///< a material or a table; the help text then says how to write one
  bool is_repeated = false;  ///< takes all arguments that are left, at least one

  [[nodiscard]] std::string_view name() const { return handle.name(); }
};

/// An example of the help text: what to type, below a line that says what it does.
struct Example {
  std::string_view purpose;
  std::string_view line;
};

/// A subcommand.
struct Command {
  std::string_view name;
  std::string_view group;        ///< heading it is listed under
  std::string_view summary;      ///< one line, for the list of commands
  std::string_view description;  ///< first paragraphs of its help text
  std::vector<Positional> positionals;
  std::vector<Option> options;
  std::vector<Example> examples;
  ExitCode (*execute)(Session& session) = nullptr;
};

/// The commands in the order in which `lobe --help` lists them.
[[nodiscard]] std::span<const Command> commands();

// One per file of the same name.
[[nodiscard]] Command run_command();
[[nodiscard]] Command merge_command();
[[nodiscard]] Command new_study_command();
[[nodiscard]] Command report_command();
[[nodiscard]] Command product_command();
[[nodiscard]] Command norm_command();
[[nodiscard]] Command distance_command();
[[nodiscard]] Command angle_command();
[[nodiscard]] Command gram_command();
[[nodiscard]] Command distance_matrix_command();
[[nodiscard]] Command agreement_command();
[[nodiscard]] Command approximate_command();
[[nodiscard]] Command fit_command();
[[nodiscard]] Command eval_command();
[[nodiscard]] Command albedo_command();
[[nodiscard]] Command mean_albedo_command();
[[nodiscard]] Command lut_command();
[[nodiscard]] Command modes_command();
[[nodiscard]] Command sample_command();
[[nodiscard]] Command preview_command();
[[nodiscard]] Command render_command();
[[nodiscard]] Command view_command();
[[nodiscard]] Command shader_command();
[[nodiscard]] Command check_command();
[[nodiscard]] Command import_command();
[[nodiscard]] Command export_command();
[[nodiscard]] Command tabulate_command();
[[nodiscard]] Command compose_command();
[[nodiscard]] Command self_compose_command();
[[nodiscard]] Command mix_command();
[[nodiscard]] Command scale_command();
[[nodiscard]] Command transpose_command();
[[nodiscard]] Command verify_command();
[[nodiscard]] Command resample_command();
[[nodiscard]] Command spectrum_command();
[[nodiscard]] Command square_root_command();
[[nodiscard]] Command solve_command();
[[nodiscard]] Command info_command();
[[nodiscard]] Command plot_command();
[[nodiscard]] Command pump_command();
[[nodiscard]] Command balance_command();
[[nodiscard]] Command normalise_command();
[[nodiscard]] Command symmetrise_command();
[[nodiscard]] Command models_command();
[[nodiscard]] Command devices_command();
[[nodiscard]] Command help_command();

/// Options that every command and `lobe` itself take.
[[nodiscard]] std::span<const Option> common_options();

/// Options that several commands take.
[[nodiscard]] Option json_option();
/// Options of commands that take a study file; load_study() takes what is given.
[[nodiscard]] Option set_option();
[[nodiscard]] Option tolerance_option(std::string_view what);
/// Options of commands that print values whose errors stay above the tolerance, with a warning; Session::note_missed()
/// takes it.
[[nodiscard]] Option strict_option();

/// The numbers of a list "0,15,30" given for an option. \throws ArgumentError when a part is no finite number.
[[nodiscard]] std::vector<double> numbers_in(const Handle& option, std::string_view list);

/// What a user gave: texts by handle; none for switches. A handle that the command has not declared is a mistake of the
/// program: all but takes() and is_given() throw std::logic_error for it.
class Arguments {
 public:
  /// Declares the options that every command takes.
  Arguments();
  void declare(const Handle& handle) { declared_.emplace(handle.name()); }
  void set(std::string_view name, std::vector<std::string> texts) { values_[std::string(name)] = std::move(texts); }

  /// Whether the command has such an argument, for what several commands share.
  [[nodiscard]] bool takes(const Handle& handle) const { return declared_.contains(handle.name()); }
  /// Whether the command has it, and the user gave it.
  [[nodiscard]] bool is_given(const Handle& handle) const { return takes(handle) && has(handle); }
  [[nodiscard]] bool has(const Handle& handle) const { return find(handle) != nullptr; }
  /// The text given for an option or a positional argument, the last where there are several; empty where there is
  /// none.
  [[nodiscard]] const std::string& text(const Text& handle) const;
  /// All texts given, however many may be.
  [[nodiscard]] std::span<const std::string> all(const Handle& handle) const;
  [[nodiscard]] std::span<const std::string> texts(const Texts& handle) const { return all(handle); }
  /// \throws ArgumentError when the text is no finite number.
  [[nodiscard]] double number(const Number& handle) const { return number_of(handle); }
  /// \throws ArgumentError when the text is no whole number from 1 on.
  [[nodiscard]] unsigned count(const Count& handle, unsigned largest = 1'000'000) const;
  /// \throws as numbers_in().
  [[nodiscard]] std::vector<double> numbers(const Numbers& handle) const { return numbers_in(handle, text(handle)); }
  /// The words of a list "red,blue".
  [[nodiscard]] std::vector<std::string> words(const Words& handle) const;

 private:
  /// \throws std::logic_error
  [[nodiscard]] const std::vector<std::string>* find(const Handle& handle) const;
  [[nodiscard]] double number_of(const Text& handle) const;

  std::set<std::string, std::less<>> declared_;
  std::map<std::string, std::vector<std::string>, std::less<>> values_;
};

}  // namespace lobe::cli
