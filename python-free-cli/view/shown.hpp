#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "interface/operand.hpp"
#include "lobe/device/device.hpp"
#include "lobe/table/reflectance.hpp"

namespace lobe::cli {

/// A material that the page offers: one that the command was given, or a file dropped on the page.
struct Offer {
  std::string text;  ///< as the page names it: a specification, or "file:1"
  std::string name;  ///< for people
  Operand operand;
};

/// The reflectances that the page may name. A text from the page is a specification or an offer, never a path.
class ShownMaterials {
 public:
  /// Makes a folder for dropped files, which goes with the object.
  /// \throws IoError
  explicit ShownMaterials(std::vector<Operand> given);
  ~ShownMaterials();
  ShownMaterials(const ShownMaterials&) = delete;
  ShownMaterials& operator=(const ShownMaterials&) = delete;

  [[nodiscard]] const std::vector<Offer>& offers() const { return offers_; }

  /// Takes a dropped file.
  /// \param name as the browser tells it; only its last part counts, and of that only letters, digits, '.', '-' and '_'
  /// \throws ArgumentError for study files, which name other files; as Operand
  const Offer& drop(const std::string& name, std::string_view content);

  /// The formulas of a text as they are written, without adjustments done; none for files.
  /// \throws ArgumentError as parse_material(), and for an offer that there is not
  [[nodiscard]] std::optional<Material> formula(const std::string& text) const;

  /// What a text stands for, with its adjustments done.
  /// \throws as formula() and adjusted(); IoError
  [[nodiscard]] Reflectance reflectance(const Device& device, const std::string& text);

  /// For people: the name of an offer, else the text.
  [[nodiscard]] std::string name(const std::string& text) const;
  /// As the command takes it: the path of a file that was given, the name of one that was dropped, else the text.
  [[nodiscard]] std::string word(const std::string& text) const;
  /// A folder for what does not stay, which goes with the object.
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
  /// A message with the names of dropped files instead of the places where they are kept.
  [[nodiscard]] std::string without_folder(std::string message) const;

 private:
  /// \throws ArgumentError for an offer that there is not
  [[nodiscard]] const Offer* offer(const std::string& text) const;
  const Offer& add(std::string name, Operand operand);

  std::vector<Offer> offers_;
  std::filesystem::path folder_;
  std::map<std::string, Reflectance, std::less<>> adjusted_;
};

}  // namespace lobe::cli
