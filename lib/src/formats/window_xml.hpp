#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "formats/file_bytes.hpp"
#include "lobe/formats/measured.hpp"

namespace lobe {

/// A ring of an AngleBasis.
struct WindowRing {
  std::optional<double> lower;  ///< degrees
  std::optional<double> upper;
  double phis = 0;
};

struct WindowBasis {
  std::string name;
  std::size_t line = 0;
  bool has_phi = false;  ///< it lists its directions one by one
  std::vector<WindowRing> rings;
};

/// One WavelengthDataBlock, without its numbers.
struct WindowBlock {
  std::string band;                  ///< "Visible"
  std::optional<double> wavelength;  ///< nm
  std::string direction;             ///< "Reflection Front"
  std::string column_basis;          ///< "LBNL/Klems Full"
  std::string row_basis;
  std::string basis;        ///< of tensor trees: "LBNL/Shirley-Chiu"
  std::string type;         ///< "BTDF"
  std::size_t begin = 0;    ///< line
  std::size_t line = 0;     ///< of its ScatteringData; 0: it has none
  std::size_t words = 0;    ///< numbers, and whatever else is apart by separators
  std::size_t braces = 0;   ///< opening ones
  bool has_values = false;  ///< one of the words is not 0
};

/// The XML of WINDOW and Radiance (schema BSDF-v1.7 of LBNL) but for the numbers of its matrices.
struct WindowXml {
  std::string material;
  std::string manufacturer;
  std::size_t structure_line = 0;  ///< the last one where there is no structure
  std::string structure;           ///< IncidentDataStructure: "Columns", "Rows", "TensorTree3", "TensorTree4"
  std::vector<WindowBasis> bases;
  std::vector<WindowBlock> blocks;
};

/// Whether the first bytes of a file are such XML.
[[nodiscard]] bool is_window_xml(const FileBytes& head);

/// Takes no more memory than a few times the size of names and bases, whatever the matrices are. Document types are
/// refused, and with them entities of the file's own.
/// \throws IoError with the line
[[nodiscard]] WindowXml read_window_xml(const FileBytes& file);

/// A word of a ScatteringData, or a brace.
/// \param block index into WindowXml::blocks
using TakeWord = std::function<void(std::size_t block, std::string_view word, std::size_t line)>;

/// Reads the file again and hands out the words of some blocks, in the order of the file.
/// \param blocks indices, rising.
/// \throws what `take` does
void read_scattering_data(const FileBytes& file, const std::vector<std::size_t>& blocks, const TakeWord& take);

/// A finite number.
/// \throws IoError with the line
[[nodiscard]] double window_number(const FileBytes& file, std::string_view word, std::size_t line);

/// The blocks of one reflectance, one of each band: that of options.component, else reflection front, else reflection
/// back. Files that hold transmissions may have reflectances of zeros instead of none: unless one of these is asked for
/// they are refused where all of them are 0, and told of where only the chosen one is.
struct WindowChoice {
  std::string component;            ///< "reflection front"
  std::vector<std::size_t> blocks;  ///< indices, rising
};
/// \param remarks says what was not asked for.
/// \throws ArgumentError where the file does not have it, IoError
[[nodiscard]] WindowChoice choose_component(const FileBytes& file, const WindowXml& xml, const ReadOptions& options,
                                            std::vector<std::string>& remarks);

/// A function without values yet: name, format, channels.
[[nodiscard]] BrdfFunction window_function(const FileBytes& file, const WindowXml& xml, const WindowChoice& choice,
                                           std::string_view format);

/// Describes a table of the file's cells: expression, conventions, names of channels, and errors, which are only those
/// of rounding, because no file states the errors of its values.
void describe_cells(const BrdfFunction& brdf, BrdfTable& table);

/// Content of a file with a reflectance. Both sides have the same values: Radiance takes "back" for the front, WINDOW
/// "front".
/// \param structure IncidentDataStructure
/// \param definition what else the DataDefinition has, whole lines
/// \param block lines of a channel's WavelengthDataBlock but for its direction: bases, type and numbers
[[nodiscard]] std::string window_text(const BrdfFunction& brdf, const WriteOptions& options, std::string_view structure,
                                      std::string_view definition,
                                      const std::function<std::string(std::size_t channel)>& block);

/// Whether the beginning of an IncidentDataStructure is "TensorTree".
[[nodiscard]] bool is_tensor_tree(std::string_view structure);

/// Names and the like are compared without regard to case.
[[nodiscard]] bool is_same_text(std::string_view a, std::string_view b);

}  // namespace lobe
