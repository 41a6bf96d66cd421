#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "formats/shader_program.hpp"

namespace lobe {

/// A program while it is written: code in blocks, slots of variables, and constants.
class ShaderCode {
 public:
  /// Where code goes: what functions do; what is done once, for constant globals; what is done before each value, for
  /// other globals.
  enum class Block { functions, setup, reset };

  explicit ShaderCode(const FileBytes& file) : file_(file) {}

  /// \throws IoError at this place if the program grows too large
  std::uint32_t take_slots(std::uint32_t count, const ShaderPlace& at);
  /// Slots of constants that follow each other.
  [[nodiscard]] std::uint32_t constants(std::span<const double> values, const ShaderPlace& at);
  [[nodiscard]] static bool is_constant(std::uint32_t slot) { return (slot & kConstants) != 0; }
  [[nodiscard]] double constant(std::uint32_t slot) const { return constants_[slot & ~kConstants]; }

  void go_to(Block block) { block_ = block; }
  [[nodiscard]] Block block() const { return block_; }
  /// Number of the next instruction in the block.
  [[nodiscard]] std::uint32_t here() const { return static_cast<std::uint32_t>(blocks_[index()].size()); }
  ShaderInstruction& emit(ShaderInstruction instruction);
  /// Lets a jump lead to the next instruction.
  void lead_here(std::uint32_t jump) { lead(jump, here()); }
  void lead(std::uint32_t jump, std::uint32_t to) { blocks_[index()][jump].dst = to; }

  /// The program, without inputs and result. Calls lead to functions by their numbers.
  /// \param entries where the code of each function begins
  [[nodiscard]] ShaderProgram link(std::span<const std::uint32_t> entries);

 private:
  static constexpr std::uint32_t kConstants = std::uint32_t{1} << 31;

  [[nodiscard]] std::size_t index() const { return static_cast<std::size_t>(block_); }

  const FileBytes& file_;
  Block block_ = Block::functions;
  std::array<std::vector<ShaderInstruction>, 3> blocks_;
  std::uint32_t slots_ = 0;
  std::vector<double> constants_;
  std::map<std::uint64_t, std::uint32_t> single_;  // constants, by their bits
};

}  // namespace lobe
