#pragma once

#include <span>
#include <string>
#include <vector>

#include "interface/operand.hpp"
#include "interface/session.hpp"
#include "lobe/metric/lighting.hpp"

namespace lobe::cli {

/// The materials and tables that MATERIAL... stands for.
struct OperandList {
  std::vector<Operand> operands;
  std::vector<double> channel_weights;  ///< from study files with several channels; empty: equal
  std::vector<Lighting> lightings;      ///< lightings of the study files, each once
};

/// Reads them. A study file stands for all its materials, FILE.toml#FAMILY for those of one family.
/// Values of --set change the study file, of which there is one then.
/// \param families the families that study files are restricted to; none: all
/// \throws ArgumentError for a family that no study file has, families without a study file, and study files that
///   weigh their channels in different ways; as Operand and load_study().
[[nodiscard]] OperandList read_operands(const Session& session, std::span<const std::string> texts,
                                        std::span<const std::string> families);

}  // namespace lobe::cli
