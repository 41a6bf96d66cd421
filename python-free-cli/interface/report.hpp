#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "lobe/core/estimate.hpp"
#include "lobe/device/device.hpp"
#include "lobe/model/material.hpp"

namespace lobe::cli {

using Json = nlohmann::ordered_json;

/// Characters that a text takes on a terminal.
[[nodiscard]] std::size_t display_width(std::string_view text);

/// A text in lines of at most 80 characters; all but the first are indented.
[[nodiscard]] std::string wrap(std::string_view text, std::size_t indent);

/// Rows of cells with aligned columns, two blanks apart; the first row is the heading, in bold where `color` is true.
/// \param numbers_from index of the first right-aligned column
[[nodiscard]] std::string format_table(const std::vector<std::vector<std::string>>& rows, std::size_t numbers_from,
                                       bool color);

/// Value ± error: as many digits of the value as its error leaves meaningful, two of the error.
[[nodiscard]] std::string format_estimate(const Estimate& estimate);

/// The start of every JSON answer: {"schema": "lobe.<command>/1"}.
[[nodiscard]] Json json_answer(std::string_view command);

/// A number as JSON; infinities and NaN, which JSON lacks, as the texts "inf", "-inf" and "nan".
[[nodiscard]] Json to_json(double value);
/// {"value": ..., "error": ...}
[[nodiscard]] Json to_json(const Estimate& estimate);
[[nodiscard]] Json to_json(const DeviceInfo& device);
[[nodiscard]] Json material_json(const Material& material);

/// The object as indented text.
[[nodiscard]] std::string json_text(const Json& json);

/// The names of files, without detours.
[[nodiscard]] Json files_json(const std::vector<std::filesystem::path>& files);

}  // namespace lobe::cli
