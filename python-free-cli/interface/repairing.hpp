#pragma once

#include <functional>
#include <string_view>

#include "interface/command.hpp"
#include "interface/table_making.hpp"
#include "lobe/metric/metric.hpp"

namespace lobe::cli {

// Code shared by the commands that repair tables.

struct Repaired {
  Reflectance table;
  Findings findings = {};
};

/// Repairs the argument A, tabulated where it is a material, and ends the command: saves the table, prints what it is
/// and how far it moved.
/// \param command name for the JSON schema
ExitCode repair(Session& session, std::string_view command,
                const std::function<Repaired(const Device&, const Reflectance&)>& work);

/// How far a repair moved a table.
void add_displacement(Findings& findings, const Device& device, const Reflectance& before, const Reflectance& after);

}  // namespace lobe::cli
