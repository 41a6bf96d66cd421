#pragma once

#include <vector>

#include "interface/command.hpp"
#include "interface/table_report.hpp"
#include "lobe/formats/measured.hpp"
#include "lobe/table/brdf_function.hpp"

namespace lobe::cli {

// Code shared by the commands that read measured files.

/// --channels, --wavelengths, --luminance, --component, --theta-max and --srgb.
[[nodiscard]] std::vector<Option> reading_options();
[[nodiscard]] ReadOptions read_options(const Arguments& arguments);
/// \throws ArgumentError where such options are given and none of a command's materials is a file.
void require_file(const Command& command, const Arguments& arguments);

/// Format, conventions, channels and remarks.
[[nodiscard]] std::vector<Field> function_fields(const BrdfFunction& function);
[[nodiscard]] Json function_json(const BrdfFunction& function);

/// The formats, for help: "MERL .binary (...); ...".
[[nodiscard]] std::string format_list(bool only_written);

}  // namespace lobe::cli
