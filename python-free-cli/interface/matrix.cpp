#include "interface/matrix.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "core/text.hpp"
#include "interface/measuring.hpp"
#include "interface/operand_list.hpp"
#include "interface/options.hpp"
#include "interface/output_file.hpp"
#include "lobe/core/error.hpp"

namespace lobe::cli {
namespace {

constexpr Texts kFamily{"family"};

constexpr std::size_t kMatrixColumns = 100;  // of a line of text

using Rows = std::vector<std::vector<std::string>>;

/// A matrix and what it is of.
struct MatrixBlock {
  const Lighting& lighting;
  std::string channel;  ///< "combined", "0", "1", ...
  const Metric& metric;
  const ProductDeviations* deviations = nullptr;  ///< null: none are known
};

std::vector<MatrixBlock> blocks_of(const Measurement& measurement) {
  std::vector<MatrixBlock> blocks;
  for (std::size_t k = 0; k < measurement.results.size(); ++k) {
    const MetricResult& result = measurement.results[k];
    const MetricDeviations* found = measurement.deviations.empty() ? nullptr : &measurement.deviations[k];
    blocks.push_back({result.lighting, "combined", result.combined, found == nullptr ? nullptr : &found->combined});
    for (std::size_t c = 0; c < result.channels.size(); ++c) {
      blocks.push_back({result.lighting, std::to_string(c + 1), result.channels[c],
                        found == nullptr ? nullptr : &found->channels[c]});
    }
  }
  return blocks;
}

/// \throws as require_root() where a square of a distance is negative
void require_distances(const std::vector<MatrixBlock>& blocks, const std::vector<std::string>& labels) {
  for (const MatrixBlock& block : blocks) {
    const Metric& metric = block.metric;
    const Eigen::MatrixXd& gram = metric.gram;
    const Eigen::MatrixXd& error = metric.gram_error;
    for (Eigen::Index i = 0; i < gram.rows(); ++i) {
      for (Eigen::Index j = 0; j < i; ++j) {
        require_root({metric.distance(i, j), metric.distance_error(i, j)},
                     "distance of '" + labels[static_cast<std::size_t>(j)] + "' and '" +
                         labels[static_cast<std::size_t>(i)] + "'",
                     {gram(i, i) - 2 * gram(i, j) + gram(j, j), error(i, i) + 2 * error(i, j) + error(j, j)},
                     block.lighting);
      }
    }
  }
}

std::string title(const MatrixBlock& block, const MatrixKind& kind, const std::string& domain, bool has_channels) {
  std::string text = block.lighting.name();
  if (!domain.empty()) text += ", " + domain;
  if (has_channels) text += block.channel == "combined" ? ", channels combined" : ", channel " + block.channel;
  text += fmt::format(": {}", kind.formula);
  const std::string_view unit = kind.unit(block.lighting);
  return unit == "1" ? text : fmt::format("{}/{}", text, unit);
}

/// The lower triangle, its columns headed by the numbers of the rows, as many side by side as fit into a line.
std::string triangle_text(const MatrixBlock& block, const MatrixKind& kind, const std::vector<std::string>& labels,
                          bool color) {
  const Eigen::MatrixXd& value = block.metric.*kind.value;
  const Eigen::MatrixXd& error = block.metric.*kind.error;
  const auto cell = [&](std::size_t row, std::size_t column) {
    const auto i = static_cast<Eigen::Index>(row);
    const auto j = static_cast<Eigen::Index>(column);
    Figure figure{{value(i, j), error(i, j)}};
    if (block.deviations != nullptr) figure.measurement = (block.deviations->*kind.deviation)(i, j);
    return format_figure(figure);
  };
  std::size_t cell_width = 0;
  std::size_t label_width = 0;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    label_width = std::max(label_width, display_width(labels[i]));
    for (std::size_t j = 0; j <= i; ++j) cell_width = std::max(cell_width, display_width(cell(i, j)));
  }
  const std::size_t margin = std::to_string(labels.size()).size() + 2 + label_width;
  const std::size_t side_by_side =
      std::max<std::size_t>(1, (kMatrixColumns - std::min(kMatrixColumns, margin)) / (cell_width + 2));

  std::string text;
  for (std::size_t from = 0; from < labels.size(); from += side_by_side) {
    const std::size_t to = std::min(labels.size(), from + side_by_side);
    Rows rows{{"", "material"}};
    for (std::size_t column = from; column < to; ++column) rows.front().push_back(std::to_string(column + 1));
    for (std::size_t row = from; row < labels.size(); ++row) {
      rows.push_back({std::to_string(row + 1), labels[row]});
      for (std::size_t column = from; column < std::min(to, row + 1); ++column)
        rows.back().push_back(cell(row, column));
    }
    text += (from > 0 ? "\n" : "") + format_table(rows, 2, color);
  }
  return text;
}

std::string matrices_text(const Measurement& measurement, const MatrixKind& kind,
                          const std::vector<std::string>& labels, bool color) {
  const bool has_channels = !measurement.results.front().channels.empty();
  std::string text;
  for (const auto& block : blocks_of(measurement)) {
    if (!text.empty()) text += "\n";
    text +=
        title(block, kind, domain_text(measurement), has_channels) + "\n" + triangle_text(block, kind, labels, color);
  }
  return text;
}

/// One table: rows are those of the matrices, after columns that say of which.
std::string matrices_csv(const Measurement& measurement, const MatrixKind& kind,
                         const std::vector<std::string>& labels) {
  std::string text = "lighting,channel,quantity,material";
  for (const auto& label : labels) text += "," + csv_field(label);
  text += "\n";
  const std::string domain = domain_text(measurement);
  const auto add = [&](const MatrixBlock& block, const std::string& quantity, const Eigen::MatrixXd& matrix) {
    const std::string lighting = block.lighting.name() + (domain.empty() ? "" : " " + domain);
    for (std::size_t i = 0; i < labels.size(); ++i) {
      text += fmt::format("{},{},{},{}", csv_field(lighting), block.channel, quantity, csv_field(labels[i]));
      for (const double entry : matrix.row(static_cast<Eigen::Index>(i))) text += "," + shortest(entry);
      text += "\n";
    }
  };
  for (const auto& block : blocks_of(measurement)) {
    add(block, std::string(kind.name), block.metric.*kind.value);
    add(block, fmt::format("{}_error", kind.name), block.metric.*kind.error);
    if (block.deviations == nullptr) continue;
    add(block, fmt::format("{}_measurement", kind.name), block.deviations->*kind.deviation);
  }
  return text;
}

Json matrix_json(const Eigen::MatrixXd& matrix) {
  Json json = Json::array();
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    json.push_back(Json::array());
    for (const double entry : matrix.row(i)) json.back().push_back(to_json(entry));
  }
  return json;
}

Json block_json(const MatrixBlock& block, const MatrixKind& kind) {
  Json json{{kind.name, matrix_json(block.metric.*kind.value)},
            {fmt::format("{}_error", kind.name), matrix_json(block.metric.*kind.error)}};
  if (block.deviations != nullptr) {
    json[fmt::format("{}_measurement", kind.name)] = matrix_json(block.deviations->*kind.deviation);
  }
  return json;
}

/// \param blocks of the result, the combined one first
Json lighting_json(const MetricResult& result, std::span<const MatrixBlock> blocks, const MatrixKind& kind,
                   const std::vector<std::string>& labels, double tolerance) {
  Json json{{"lighting", result.lighting.name()},
            {"tolerance", tolerance},
            {"units", {{kind.name, kind.unit(result.lighting)}}}};
  json.update(block_json(blocks.front(), kind));
  if (blocks.size() > 1) {
    json["channels"] = Json::array();
    for (const MatrixBlock& channel : blocks.subspan(1)) json["channels"].push_back(block_json(channel, kind));
  }
  json["unresolved"] = Json::array();
  for (const auto& pair : result.unresolved) {
    json["unresolved"].push_back({{"first", labels.at(pair.first)},
                                  {"second", labels.at(pair.second)},
                                  {"relative_error", to_json(pair.relative_error)}});
  }
  return json;
}

Json answer_json(const MatrixKind& kind, const OperandList& list, const Measurement& measurement,
                 const std::vector<std::string>& labels, const OutputFile& file) {
  Json answer = json_answer(kind.command);
  if (file.is_wanted()) answer["file"] = file.path().string();
  answer["materials"] = Json::array();
  for (const auto& operand : list.operands) answer["materials"].push_back(operand_json(operand));
  if (!list.channel_weights.empty()) answer["channel_weights"] = list.channel_weights;
  answer["lightings"] = Json::array();
  const auto blocks = blocks_of(measurement);
  std::size_t first = 0;
  for (const auto& result : measurement.results) {
    const std::size_t count = 1 + result.channels.size();
    answer["lightings"].push_back(
        lighting_json(result, std::span(blocks).subspan(first, count), kind, labels, result.tolerance));
    first += count;
  }
  answer.update(circumstances_json(measurement));
  return answer;
}

}  // namespace

ExitCode answer_matrix(Session& session, const MatrixKind& kind) {
  const auto& arguments = session.arguments();
  if (arguments.has(option::csv) && session.wants_json()) throw ArgumentError("--csv and --json are given; choose one");
  const OutputFile file(session);
  if (file.is_wanted() && file.path().extension() != ".csv") {
    throw ArgumentError("--output " + file.path().string() + " is no name of a table of text; expected FILE.csv");
  }
  auto lightings = lightings_of(arguments);
  const OperandList list = read_operands(session, arguments.texts(argument::materials), arguments.texts(kFamily));
  if (!arguments.has(option::lighting) && !list.lightings.empty()) lightings = list.lightings;
  std::vector<std::string> labels;
  for (const auto& operand : list.operands) labels.push_back(operand.label());

  const Measurement measurement = measured(session, list.operands, lightings, list.channel_weights);
  if (kind.value == &Metric::distance) require_distances(blocks_of(measurement), labels);
  if (file.is_wanted()) file.write(matrices_csv(measurement, kind, labels));
  if (session.wants_json()) {
    session.print_json(answer_json(kind, list, measurement, labels, file));
  } else if (file.is_wanted()) {
    session.print(file.path().string() + "\n");
  } else if (arguments.has(option::csv)) {
    session.print(matrices_csv(measurement, kind, labels));
  } else {
    session.print(matrices_text(measurement, kind, labels, session.colors_output()));
  }
  return ExitCode::success;
}

std::vector<Positional> matrix_positionals() {
  return {{.handle = argument::materials,
           .help = "materials, tables and study files (FILE.toml for all materials, FILE.toml#FAMILY for a family)",
           .is_material = true,
           .is_repeated = true}};
}

std::vector<Option> matrix_options() {
  std::vector<Option> options{
      {.handle = kFamily, .value = "NAME", .help = "use only this family of the study files; may be repeated"},
      set_option()};
  for (const auto& option : measuring_options(true)) options.push_back(option);
  options.push_back({.handle = option::csv, .help = "print comma-separated values in full precision, with errors"});
  options.push_back({.handle = option::output, .letter = 'o', .value = "FILE.csv", .help = "write these to a file"});
  options.push_back({.handle = option::force, .letter = 'f', .help = "replace an existing file"});
  options.push_back(json_option());
  return options;
}

}  // namespace lobe::cli
