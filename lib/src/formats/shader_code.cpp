#include "formats/shader_code.hpp"

#include <fmt/format.h>

#include <bit>

namespace lobe {
namespace {

constexpr std::uint32_t kMostSlots = std::uint32_t{1} << 16;
constexpr std::uint32_t kMostInstructions = std::uint32_t{1} << 16;

}  // namespace

std::uint32_t ShaderCode::take_slots(std::uint32_t count, const ShaderPlace& at) {
  if (count > kMostSlots - slots_) {
    refuse_shader(file_, at, fmt::format("its variables have more than {} components; expected fewer", kMostSlots));
  }
  const std::uint32_t first = slots_;
  slots_ += count;
  return first;
}

std::uint32_t ShaderCode::constants(std::span<const double> values, const ShaderPlace& at) {
  if (values.size() == 1) {
    const auto known = single_.find(std::bit_cast<std::uint64_t>(values.front()));
    if (known != single_.end()) return known->second;
  }
  if (values.size() > kMostSlots - constants_.size()) {
    refuse_shader(file_, at, fmt::format("its constants have more than {} components; expected fewer", kMostSlots));
  }
  const std::uint32_t first = static_cast<std::uint32_t>(constants_.size()) | kConstants;
  constants_.insert(constants_.end(), values.begin(), values.end());
  if (values.size() == 1) single_.emplace(std::bit_cast<std::uint64_t>(values.front()), first);
  return first;
}

ShaderInstruction& ShaderCode::emit(ShaderInstruction instruction) {
  auto& block = blocks_[index()];
  if (block.size() == kMostInstructions) {
    refuse_shader(file_, instruction.at, fmt::format("more than {} operations; expected fewer", kMostInstructions));
  }
  return block.emplace_back(instruction);
}

ShaderProgram ShaderCode::link(std::span<const std::uint32_t> entries) {
  ShaderProgram program;
  std::array<std::uint32_t, 3> bases{};
  for (const Block block : {Block::functions, Block::setup, Block::reset}) {
    go_to(block);
    if (block == Block::setup) emit({.op = ShaderOp::halt});
    bases[index()] = static_cast<std::uint32_t>(program.code.size());
    program.code.insert(program.code.end(), blocks_[index()].begin(), blocks_[index()].end());
  }
  program.setup = bases[static_cast<std::size_t>(Block::setup)];
  program.entry = bases[static_cast<std::size_t>(Block::reset)];
  const auto placed = [&](std::uint32_t& slot) {
    if (is_constant(slot)) slot = slots_ + (slot & ~kConstants);
  };
  for (std::size_t k = 0; k < program.code.size(); ++k) {
    ShaderInstruction& one = program.code[k];
    placed(one.a);
    placed(one.b);
    placed(one.c);
    const std::size_t block = k >= program.entry ? 2 : k >= program.setup ? 1 : 0;
    if (one.op == ShaderOp::jump || one.op == ShaderOp::jump_if_false) one.dst += bases[block];
    if (one.op == ShaderOp::call) one.dst = entries[one.dst];
  }
  program.slots.assign(slots_, 0);
  program.slots.insert(program.slots.end(), constants_.begin(), constants_.end());
  return program;
}

}  // namespace lobe
