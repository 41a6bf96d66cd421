// Reflectances as matrices on the angle bases of Klems, in the XML of LBNL's WINDOW and of Radiance.
// Sources: Klems 1994 ("A new method for predicting the solar heat gain of complex fenestration systems"); schema
// BSDF-v1.7.7 of LBNL; Ward et al. 2011 for the directions that the indices stand for.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "core/text.hpp"
#include "formats/format.hpp"
#include "formats/window_xml.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"
#include "table/tabulate.hpp"

namespace lobe {
namespace {

constexpr double kLimitTolerance = 0.01;  // degrees, of limits of rings as files print them

/// A name stands for one basis, but for "half", of which WINDOW and Radiance have one each.
struct NamedBasis {
  std::string_view name;
  std::size_t patches;
};
constexpr std::array<NamedBasis, 4> kBases{
    {{"LBNL/Klems Full", 145}, {"LBNL/Klems Half", 77}, {"LBNL/Klems Half", 73}, {"LBNL/Klems Quarter", 41}}};

double degrees(double radians) {
  return std::round(to_degrees(radians) * 1e6) / 1e6;
}

bool is_near(const std::optional<double>& limit, double radians) {
  return !limit || std::abs(*limit - degrees(radians)) <= kLimitTolerance;
}

bool has_rings_of(const WindowBasis& basis, const HemisphereGrid& grid) {
  return !basis.has_phi && std::ranges::equal(basis.rings, grid.rings(), [](const WindowRing& ring, const Ring& own) {
    return ring.phis == static_cast<double>(own.count) && is_near(ring.lower, own.theta_low) &&
           is_near(ring.upper, own.theta_high);
  });
}

/// The patches that a basis may have: by its rings where the file has them, else by its name.
std::vector<std::size_t> patches_of(const FileBytes& file, const WindowXml& xml, const WindowBlock& block) {
  std::vector<std::size_t> patches;
  const auto described = std::ranges::find_if(xml.bases, [&](const WindowBasis& basis) {
    return !basis.rings.empty() && is_same_text(basis.name, block.column_basis);
  });
  if (described != xml.bases.end()) {
    for (const NamedBasis& basis : kBases) {
      if (has_rings_of(*described, HemisphereGrid::klems(basis.patches))) patches.push_back(basis.patches);
    }
    if (patches.empty()) {
      file.refuse_line(described->line, fmt::format("the rings of '{}' are not those of LBNL/Klems Full, Half or "
                                                    "Quarter; expected one of these bases",
                                                    described->name));
    }
    return patches;
  }
  for (const NamedBasis& basis : kBases) {
    if (is_same_text(basis.name, block.column_basis)) patches.push_back(basis.patches);
  }
  if (patches.empty()) {
    file.refuse_line(block.line, fmt::format("unknown angle basis '{}'; expected LBNL/Klems Full, Half or Quarter",
                                             block.column_basis));
  }
  return patches;
}

HemisphereGrid grid_of(const FileBytes& file, const WindowXml& xml, const WindowBlock& block) {
  if (!is_same_text(block.column_basis, block.row_basis)) {
    file.refuse_line(block.line, fmt::format("columns are on '{}' and rows on '{}'; expected the same basis",
                                             block.column_basis, block.row_basis));
  }
  std::vector<std::string> expected;
  for (const std::size_t patches : patches_of(file, xml, block)) {
    if (block.words == patches * patches) return HemisphereGrid::klems(patches);
    expected.push_back(fmt::format("{} ({} x {})", patches * patches, patches, patches));
  }
  file.refuse_line(block.line,
                   fmt::format("ScatteringData of {} numbers; expected {}", block.words, fmt::join(expected, " or ")));
}

/// Values by L and V. The file has an incident direction by the patch that the light goes to, were it not reflected:
/// the one opposite to that of the light, so that mirrors are diagonal.
TableValues read_values(const FileBytes& file, const WindowChoice& choice, const HemisphereGrid& grid,
                        bool is_columns) {
  const std::size_t n = grid.nodes();
  TableValues values(choice.blocks.size() * n * n);
  std::size_t k = 0;  // of all words
  read_scattering_data(file, choice.blocks, [&](std::size_t, std::string_view word, std::size_t line) {
    const std::size_t channel = k / (n * n);
    const std::size_t row = k / n % n;
    const std::size_t column = k % n;
    const std::size_t in = grid.opposite(is_columns ? column : row);
    values[(channel * n + in) * n + (is_columns ? row : column)] = window_number(file, word, line);
    ++k;
  });
  return values;
}

/// A matrix that is 0 but for the mirror and retro directions is no smooth reflectance but delta parts; at the normal,
/// where both directions are the same, the part that is there elsewhere. False: it is smooth.
bool separate_delta_parts(BrdfTable& table) {
  const std::size_t n = table.grid.nodes();
  bool has_mirror = false;
  bool has_retro = false;
  for (std::size_t k = 0; k < table.values.size(); ++k) {
    if (table.values[k] == 0) continue;
    const std::size_t in = k / n % n;
    const std::size_t out = k % n;
    const std::size_t mirrored = table.grid.opposite(in);
    if (out != in && out != mirrored) return false;
    has_mirror = has_mirror || (out == mirrored && out != in);
    has_retro = has_retro || (out == in && out != mirrored);
  }
  if (!has_mirror && !has_retro) return false;
  const auto take = [&](std::vector<double>& factors, auto partner) {
    factors.resize(table.channels * n);
    for (std::size_t row = 0; row < factors.size(); ++row) {
      const std::size_t out = partner(row % n);
      factors[row] = table.values[row * n + out] * table.grid.weights()[out];
      table.values[row * n + out] = 0;
    }
  };
  // The first one takes the normal.
  if (has_mirror) take(table.mirror, [&](std::size_t in) { return table.grid.opposite(in); });
  if (has_retro) take(table.retro, [](std::size_t in) { return in; });
  return true;
}

BrdfValues cell_values(const BrdfTable& table, std::span<const Directions> pairs) {
  BrdfValues values;
  values.value.resize(static_cast<Eigen::Index>(pairs.size()), static_cast<Eigen::Index>(table.channels));
  const std::size_t n = table.grid.nodes();
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const Directions& pair = pairs[i];
    const std::size_t in = table.grid.node_at({pair.theta_in, pair.phi_in});
    const std::size_t out = table.grid.node_at({pair.theta_out, pair.phi_in + pair.delta_phi});
    for (std::size_t c = 0; c < table.channels; ++c) {
      values.value(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(c)) = table.values[(c * n + in) * n + out];
    }
  }
  return values;
}

BrdfFunction read(const FileBytes& file, const ReadOptions& options) {
  const WindowXml xml = read_window_xml(file);
  // Where a long geometry comes first, what the file is stands beyond the bytes that it is recognised by.
  if (is_tensor_tree(xml.structure)) return kTensorTreeFormat.read(file, options);
  const bool is_columns = is_same_text(xml.structure, "Columns");
  if (!is_columns && !is_same_text(xml.structure, "Rows")) {
    file.refuse_line(xml.structure_line,
                     fmt::format("IncidentDataStructure '{}'; expected Columns or Rows", xml.structure));
  }
  std::vector<std::string> remarks;
  const WindowChoice choice = choose_component(file, xml, options, remarks);
  BrdfFunction brdf = window_function(file, xml, choice, kKlemsFormat.title);
  brdf.remarks = std::move(remarks);
  brdf.is_isotropic = false;

  BrdfTable table;
  table.grid = grid_of(file, xml, xml.blocks[choice.blocks.front()]);
  for (const std::size_t i : choice.blocks) {
    const WindowBlock& block = xml.blocks[i];
    if (grid_of(file, xml, block) != table.grid) {
      file.refuse_line(block.line, fmt::format("'{}' is on another angle basis than the rest", block.band));
    }
  }
  table.form = TableForm::general;
  table.channels = choice.blocks.size();
  table.values = read_values(file, choice, table.grid, is_columns);
  const auto negative = std::ranges::count_if(table.values, [](double value) { return value < 0; });
  if (negative > 0) {
    brdf.remarks.push_back(fmt::format("{} of {} values are negative, and kept", negative, table.values.size()));
  }
  if (separate_delta_parts(table)) {
    brdf.remarks.emplace_back("all but the mirror and retro directions is 0: read as delta parts");
  }
  brdf.conventions = fmt::format(
      "{}, averages over the patches of {} in sr^-1 without cosine, constant on each; incident directions turned by "
      "180 "
      "degrees, for the file has them by where light goes; azimuths as the file counts them",
      choice.component, table.grid.name());
  describe_cells(brdf, table);
  brdf.cells = std::make_shared<const BrdfTable>(std::move(table));
  brdf.at = [cells = brdf.cells](std::span<const Directions> pairs) { return cell_values(*cells, pairs); };
  return brdf;
}

std::string basis_name(const HemisphereGrid& grid) {
  return std::string(std::ranges::find(kBases, grid.nodes(), &NamedBasis::patches)->name);
}

std::string angle_basis(const HemisphereGrid& grid) {
  std::string text = fmt::format("      <AngleBasis>\n        <AngleBasisName>{}</AngleBasisName>\n", basis_name(grid));
  for (const Ring& ring : grid.rings()) {
    text += fmt::format(
        "        <AngleBasisBlock><Theta>{}</Theta><ThetaBounds><LowerTheta>{}</LowerTheta><UpperTheta>{}</UpperTheta>"
        "</ThetaBounds><nPhis>{}</nPhis></AngleBasisBlock>\n",
        shortest(degrees(ring.theta)), shortest(degrees(ring.theta_low)), shortest(degrees(ring.theta_high)),
        ring.count);
  }
  return text + "      </AngleBasis>\n";
}

/// All of a channel, delta parts as averages over the patches that they hit, as rows of V and columns of L.
std::string scattering_data(const BrdfTable& table, std::size_t channel) {
  const std::size_t n = table.grid.nodes();
  std::string text;
  for (std::size_t out = 0; out < n; ++out) {
    for (std::size_t column = 0; column < n; ++column) {
      const std::size_t in = table.grid.opposite(column);
      double value = table.channel(channel)[in * n + out];
      const double weight = table.grid.weights()[out];
      if (!table.mirror.empty() && out == column) value += table.mirror[channel * n + in] / weight;
      if (!table.retro.empty() && out == in) value += table.retro[channel * n + in] / weight;
      if (!std::isfinite(value)) {
        throw NumericError("'" + table.expression + "' has values that are no finite numbers");
      }
      text += shortest(value);
      text += column + 1 == n ? ",\n" : ", ";
    }
  }
  return text;
}

bool is_klems(const HemisphereGrid& grid) {
  return grid.kind() == GridKind::klems &&
         std::ranges::any_of(kBases, [&](const NamedBasis& basis) { return basis.patches == grid.nodes(); });
}

/// The file's own cells, or averages over patches.
std::shared_ptr<const BrdfTable> patch_table(const BrdfFunction& brdf) {
  if (brdf.cells && is_klems(brdf.cells->grid)) return brdf.cells;
  if (brdf.cells && brdf.cells->has_delta()) {
    throw ArgumentError(
        fmt::format("'{}' has delta parts on the grid {}; expected klems:145, 77, 73 or 41 for a Klems "
                    "file",
                    brdf.name, brdf.cells->grid.name()));
  }
  return std::make_shared<const BrdfTable>(tabulate(brdf, HemisphereGrid::klems(145), {.allow_unresolved = true}));
}

std::string write(const BrdfFunction& brdf, const WriteOptions& options) {
  const auto table = patch_table(brdf);
  const std::string basis = basis_name(table->grid);
  return window_text(brdf, options, "Columns", angle_basis(table->grid), [&](std::size_t channel) {
    return fmt::format(
        "        <ColumnAngleBasis>{}</ColumnAngleBasis>\n        <RowAngleBasis>{}</RowAngleBasis>\n"
        "        <ScatteringDataType>BTDF</ScatteringDataType>\n        <ScatteringData>\n{}        "
        "</ScatteringData>\n",
        basis, basis, scattering_data(*table, channel));
  });
}

}  // namespace

const Format kKlemsFormat{"klems", "Klems BSDF XML (WINDOW, Radiance)", is_window_xml, read, false, write, true};

}  // namespace lobe
