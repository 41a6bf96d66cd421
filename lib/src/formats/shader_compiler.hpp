#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formats/shader_code.hpp"
#include "formats/shader_types.hpp"
#include "lobe/formats/measured.hpp"

namespace lobe {

/// A function of a shader as a program, and what it was taken from.
struct CompiledShader {
  ShaderProgram program;
  std::string function;               ///< its name
  std::string light;                  ///< the name of the parameter that points to the light
  std::string view;                   ///< the name of the one that points to the viewer
  std::vector<std::string> uniforms;  ///< "roughness = 0.3"
  std::size_t candidates = 0;         ///< functions that qualify, or that have the name asked for
};

/// Compiles a shader and chooses a function of it: one that returns float or vec3 and takes vec3 L, vec3 V and, if it
/// has three or five parameters, the normal N and the tangents X and Y. Parameters with usual names of light, view or
/// normal count by name, others by place.
/// \param options the function (default: the last one that qualifies), and values of uniforms
/// \throws IoError that names the place in the text; ArgumentError for options that the text does not meet
[[nodiscard]] CompiledShader compile_shader(const FileBytes& file, const ReadOptions& options);

/// Elements of an array whose parts tell how many.
inline constexpr std::uint32_t kNoCount = 0xffffffffU;

/// What an expression is: slots, known or not, or a place that can be written to.
struct ShaderValue {
  ShaderType type;
  std::uint32_t slot = 0;
  std::optional<std::uint32_t> offset = {};  ///< slot with the offset of an element that is only known in a run
  bool is_place = false;                     ///< whether it can be assigned to
  bool is_variable = false;                  ///< whether it may change before it is used
  std::vector<std::uint8_t> picked = {};     ///< components that do not follow each other
  std::optional<std::uint32_t> copied = {};  ///< slots of its value before later arguments may change it
  ShaderPlace at = {};
};

/// Reads a shader in one pass and writes its program.
class ShaderCompiler {
 public:
  ShaderCompiler(const FileBytes& file, const ReadOptions& options);
  CompiledShader compile();

 private:
  enum class Direction { in, out, inout };
  struct Parameter {
    std::string_view name;
    ShaderType type;
    Direction direction = Direction::in;
    std::uint32_t slot = 0;
  };
  struct Function {
    std::string_view name;
    ShaderType type;
    std::vector<Parameter> parameters;
    std::uint32_t result = 0;
    std::uint32_t entry = 0;
    bool is_defined = false;
    ShaderPlace at = {};
    std::map<std::size_t, ShaderPlace> calls = {};  // where it calls others first
  };
  using Scope = std::map<std::string_view, ShaderValue>;
  struct Loop {
    std::vector<std::uint32_t> breaks = {};
    std::vector<std::uint32_t> continues = {};
  };
  /// Counts how deep the text is nested while it lives.
  class Nesting {
   public:
    explicit Nesting(ShaderCompiler& compiler);
    ~Nesting() { --compiler_.depth_; }
    Nesting(const Nesting&) = delete;
    Nesting& operator=(const Nesting&) = delete;

   private:
    ShaderCompiler& compiler_;
  };

  // Tokens.
  [[noreturn]] void refuse(const ShaderPlace& at, const std::string& complaint) const;
  [[noreturn]] void refuse_here(std::string_view expected) const;
  void advance();
  [[nodiscard]] bool accept(std::string_view sign);
  void expect(std::string_view sign);
  [[nodiscard]] ShaderToken take_name(std::string_view of_what);

  // Types and names.
  [[nodiscard]] bool at_type() const;
  [[nodiscard]] ShaderType read_type();
  [[nodiscard]] std::uint32_t read_count();
  void read_array(ShaderType& type);
  [[nodiscard]] std::uint32_t slots_of(const ShaderType& type) const;
  [[nodiscard]] std::string name_of(const ShaderType& type) const;
  void declare(const ShaderToken& name, ShaderValue value);
  [[nodiscard]] const ShaderValue* find(std::string_view name) const;

  // Declarations.
  void read_global();
  void read_structure();
  void read_members(ShaderStructure& structure);
  void read_constants();
  void read_uniform();
  void set_uniform(const ShaderToken& name, const ShaderType& type);
  void read_variables(const ShaderType& type, bool is_constant, ShaderToken name);
  void read_variable(ShaderType type, bool is_constant, const ShaderToken& name);
  void read_precision();
  [[nodiscard]] bool skip_precision();
  void read_function(const ShaderType& type, const ShaderToken& name);
  [[nodiscard]] std::vector<Parameter> read_parameters();
  [[nodiscard]] Parameter read_parameter();
  [[nodiscard]] std::size_t declare_function(Function function);
  void read_body(std::size_t index);

  // Statements.
  void read_statement();
  void read_block();
  void read_simple_statement();
  void read_assignment(const ShaderValue& target);
  void read_if();
  void read_for();
  void read_while();
  void read_do();
  void read_return();
  void read_jump(bool is_break);
  void end_loop(std::uint32_t continue_at);
  /// Reads a condition and writes the jump that is taken where it does not hold.
  [[nodiscard]] std::uint32_t read_condition();

  // Expressions.
  [[nodiscard]] ShaderValue read_expression();
  [[nodiscard]] ShaderValue read_choice(ShaderValue condition);
  [[nodiscard]] ShaderValue read_operators(unsigned lowest);
  [[nodiscard]] ShaderValue read_logical(ShaderValue left, const ShaderToken& sign, unsigned level);
  [[nodiscard]] ShaderValue read_unary();
  [[nodiscard]] ShaderValue read_postfix();
  [[nodiscard]] ShaderValue read_primary();
  [[nodiscard]] ShaderValue read_number();
  [[nodiscard]] std::vector<ShaderValue> read_arguments();
  [[nodiscard]] ShaderValue member(const ShaderValue& of, const ShaderToken& name);
  [[nodiscard]] ShaderValue components(const ShaderValue& of, const ShaderToken& name);
  [[nodiscard]] ShaderValue element(const ShaderValue& of, const ShaderValue& index, const ShaderPlace& at);
  [[nodiscard]] ShaderValue operate(const ShaderToken& sign, const ShaderValue& a, const ShaderValue& b);
  [[nodiscard]] ShaderValue arithmetic(const ShaderToken& sign, ShaderValue a, ShaderValue b);
  [[nodiscard]] ShaderValue product(const ShaderToken& sign, const ShaderValue& a, const ShaderValue& b);
  [[nodiscard]] ShaderValue compare(const ShaderToken& sign, const ShaderValue& a, const ShaderValue& b);
  [[nodiscard]] ShaderValue construct(const ShaderType& type, const ShaderPlace& at);
  [[nodiscard]] ShaderValue construct_whole(const ShaderType& type, const std::vector<ShaderValue>& parts,
                                            const ShaderPlace& at);
  [[nodiscard]] ShaderValue construct_matrix(const ShaderType& type, const ShaderValue& scalar, const ShaderPlace& at);
  [[nodiscard]] ShaderValue call(const ShaderToken& name);
  [[nodiscard]] ShaderValue call_function(std::size_t index, std::vector<ShaderValue> arguments, const ShaderPlace& at);
  [[nodiscard]] ShaderValue call_builtin(const ShaderToken& name, std::vector<ShaderValue> arguments);
  [[nodiscard]] ShaderValue by_components(const ShaderBuiltin& builtin, const ShaderToken& name,
                                          std::vector<ShaderValue> arguments);
  [[nodiscard]] std::optional<std::size_t> matching_function(const ShaderToken& name,
                                                             std::span<const ShaderValue> arguments) const;
  [[nodiscard]] std::string call_text(const ShaderToken& name, std::span<const ShaderValue> arguments) const;

  // Values.
  [[nodiscard]] ShaderValue fresh(const ShaderType& type, const ShaderPlace& at);
  [[nodiscard]] ShaderValue constant(const ShaderType& type, std::span<const double> values, const ShaderPlace& at);
  [[nodiscard]] bool is_known(const ShaderValue& value) const;
  [[nodiscard]] double known(const ShaderValue& value, std::uint32_t component = 0) const;
  /// The same value in slots that follow each other and do not change until it is used.
  [[nodiscard]] ShaderValue plain(const ShaderValue& value);
  [[nodiscard]] ShaderValue converted(const ShaderValue& value, ShaderBase base, const ShaderPlace& at);
  /// Whether a value of one type serves as another without being written out.
  [[nodiscard]] static bool converts(const ShaderType& from, const ShaderType& to);
  [[nodiscard]] ShaderValue as(const ShaderValue& value, const ShaderType& type, std::string_view what);
  void assign(const ShaderValue& target, const ShaderValue& value);
  /// An operation by components; known operands give a known result.
  [[nodiscard]] ShaderValue apply(ShaderOp op, const ShaderType& type, std::span<const ShaderValue> operands,
                                  const ShaderPlace& at);

  // The end.
  void require_calls() const;
  [[nodiscard]] std::size_t deepest_calls(std::size_t function, std::vector<std::size_t>& depths,
                                          std::vector<bool>& is_open) const;
  [[nodiscard]] std::size_t choose_function(CompiledShader& made) const;
  /// What the parameters of a function are, by number: L, V, N, X and Y; nothing if it is no function of directions.
  [[nodiscard]] static std::optional<std::vector<std::uint32_t>> roles_of(const Function& function);
  void write_entry(std::size_t index, CompiledShader& made);
  void run_setup(ShaderProgram& program) const;
  void require_uniforms() const;

  const FileBytes& file_;
  const ReadOptions& options_;
  ShaderTokens tokens_;
  ShaderToken token_;
  ShaderToken next_;
  ShaderCode code_;
  std::vector<ShaderStructure> structures_;
  std::vector<Function> functions_;
  std::vector<Scope> scopes_{1};
  std::vector<Loop> loops_;
  std::optional<std::size_t> current_;  // function
  bool has_side_effects_ = false;       // whether calls may change variables
  std::size_t depth_ = 0;
  std::vector<std::string> uniforms_;
  std::vector<ShaderToken> missing_;  // uniforms without a value
  std::vector<std::string_view> uniform_names_;

  friend class Nesting;
};

}  // namespace lobe
