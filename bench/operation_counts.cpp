#include "operation_counts.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdio>
#include <regex>
#include <set>
#include <sstream>
#include <stdexcept>
#include <vector>

namespace bench {
namespace {

/// Built-in functions that are a few instructions, or none of the model's work.
const std::set<std::string> kCheap{"clamp",    "fabs",   "fmin",    "fmax",          "min", "select",
                                   "copysign", "vload8", "vstore8", "get_global_id", "all"};

/// The optimised code of the kernel as LLVM prints it. Built-in functions are declared convergent, which would keep
/// them in loops; drivers see their bodies instead.
std::string optimised_code(const CountedKernel& kernel, lobe::Precision precision) {
  const std::string command = fmt::format(
      "{4} -target spir64 -x cl -cl-std=CL1.2 -Xclang -finclude-default-header -Xclang -fdeclare-opencl-builtins "
      "-O2 -Xclang -disable-llvm-passes -S -emit-llvm -I '{0}' -D REAL_BITS={1} -D REAL_WIDTH=8 {2}"
      "-include models/{3}.clh -D MODEL={3} '{0}/lobes/evaluate_lobes.cl' -o - | sed 's/convergent/willreturn/' | "
      "{4} -target spir64 -x ir -O2 -mllvm -inline-threshold=100000 -S -emit-llvm - -o -",
      LOBE_KERNELS, precision == lobe::Precision::double_precision ? 64 : 32,
      kernel.is_anisotropic ? "-D ANISOTROPIC=1 " : "", kernel.name, LOBE_CLANG);
  std::string output;
  if (std::FILE* pipe = ::popen(command.c_str(), "r")) {
    std::array<char, 4096> buffer{};
    while (std::fgets(buffer.data(), buffer.size(), pipe) != nullptr) output += buffer.data();
    ::pclose(pipe);
  }
  return output;
}

/// Straight code, what it calls, and where it goes on.
struct Block {
  std::vector<std::string> operations;
  std::vector<std::string> next;
};

std::map<std::string, Block> blocks_of(const std::string& code) {
  static const std::regex label(R"(^([\w.$-]+):)");
  static const std::regex target(R"(label %([\w.$-]+))");
  static const std::regex call(R"(call [^@]*@_Z(\d+)(\w+)\()");
  static const std::regex division(R"(= fdiv )");
  std::map<std::string, Block> blocks;
  std::istringstream lines(code);
  bool inside = false;
  std::string current = "entry";
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("define") && line.find("@evaluate_lobes(") != std::string::npos) inside = true;
    if (!inside) continue;
    if (line == "}") break;
    std::smatch match;
    if (std::regex_search(line, match, label)) current = match[1];
    Block& block = blocks[current];
    if (std::regex_search(line, match, call)) {
      std::string name = match[2].str().substr(0, std::stoul(match[1]));
      if (!kCheap.contains(name) && !name.starts_with("convert_")) block.operations.push_back(std::move(name));
    }
    if (std::regex_search(line, division)) block.operations.emplace_back("divide");
    for (std::sregex_iterator at(line.begin(), line.end(), target), end; at != end; ++at) {
      block.next.push_back((*at)[1]);
    }
  }
  return blocks;
}

using Names = std::set<std::string>;

/// What can be reached from a block without passing another one; with the block itself.
Names reached(const std::map<std::string, Block>& blocks, const std::string& from, const std::string& without) {
  Names seen;
  std::vector<std::string> open{from};
  while (!open.empty()) {
    const std::string name = open.back();
    open.pop_back();
    if (name == without || !seen.insert(name).second) continue;
    for (const auto& next : blocks.at(name).next) open.push_back(next);
  }
  return seen;
}

/// How many loops each block is in: of a loop are the blocks that its head dominates and that lead back to it.
std::map<std::string, int> loop_depths(const std::map<std::string, Block>& blocks) {
  std::map<std::string, int> depths;
  for (const auto& [head, block] : blocks) {
    const Names others = reached(blocks, "entry", head);
    const auto is_dominated = [&](const std::string& name) { return !others.contains(name); };
    Names tails;
    for (const auto& [name, candidate] : blocks) {
      for (const auto& next : candidate.next) {
        if (next == head && is_dominated(name)) tails.insert(name);
      }
    }
    if (tails.empty()) continue;
    ++depths[head];
    for (const auto& [name, candidate] : blocks) {
      if (name == head || !is_dominated(name)) continue;
      const Names inner = reached(blocks, name, head);
      for (const auto& tail : tails) {
        if (!inner.contains(tail)) continue;
        ++depths[name];
        break;
      }
    }
  }
  return depths;
}

}  // namespace

OperationCounts count_operations(const CountedKernel& kernel, lobe::Precision precision) {
  const auto blocks = blocks_of(optimised_code(kernel, precision));
  if (!blocks.contains("entry")) {
    throw std::runtime_error(fmt::format("{} has no code of kernels/models/{}.clh", LOBE_CLANG, kernel.name));
  }
  auto depths = loop_depths(blocks);
  // Outside, over nodes, over packs, over the terms of a series.
  const std::array<double, 4> weights{0, 1 / kernel.packs, 1, kernel.terms};
  OperationCounts counts;
  for (const auto& [name, block] : blocks) {
    for (const auto& operation : block.operations) {
      const auto depth = static_cast<std::size_t>(depths[name]);
      if (depth >= weights.size() || (depth == 3 && kernel.terms == 0)) {
        throw std::runtime_error(fmt::format("kernels/models/{}.clh has a loop of unknown length", kernel.name));
      }
      counts[operation] += weights.at(depth);
    }
  }
  return counts;
}

}  // namespace bench
