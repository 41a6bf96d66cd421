#pragma once

#include <concepts>
#include <cstddef>
#include <initializer_list>
#include <memory>
#include <ranges>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "lobe/model/material.hpp"
#include "lobe/table/brdf_function.hpp"
#include "lobe/table/table.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// A surface's reflectance in any form: formulas, a function of pairs of directions (a measured file), or a table (the
/// operator on a grid). An immutable value that is cheap to copy. Formulas, functions and tables convert to it wherever
/// a verb takes reflectances.
class Reflectance {
 public:
  /// Reflectance given by formulas.
  Reflectance(Material formula);  // NOLINT(google-explicit-constructor,hicpp-explicit-conversions)
  /// Reflectance given as a function.
  Reflectance(BrdfFunction function);  // NOLINT(google-explicit-constructor,hicpp-explicit-conversions)
  /// Reflectance given as a table.
  Reflectance(BrdfTable table);  // NOLINT(google-explicit-constructor,hicpp-explicit-conversions)

  /// Name of a material or a function, or expression of a table.
  [[nodiscard]] const std::string& name() const;
  /// Number of channels.
  [[nodiscard]] std::size_t channels() const;
  /// Whether it is independent of the azimuth of incidence.
  [[nodiscard]] bool is_isotropic() const;
  /// Whether it has mirror or retro-reflecting parts, which no value at a pair of directions shows.
  [[nodiscard]] bool has_delta() const;

  /// The formulas, or null if it has another form.
  [[nodiscard]] const Material* formula() const { return std::get_if<Material>(content_.get()); }
  /// The function, or null if it has another form.
  [[nodiscard]] const BrdfFunction* function() const { return std::get_if<BrdfFunction>(content_.get()); }
  /// The table, or null if it has another form.
  [[nodiscard]] const BrdfTable* table() const { return std::get_if<BrdfTable>(content_.get()); }

  /// Calls `visitor` with the Material, BrdfFunction or BrdfTable that it holds.
  template <typename Visitor>
  decltype(auto) visit(Visitor&& visitor) const {
    return std::visit(std::forward<Visitor>(visitor), *content_);
  }

 private:
  std::shared_ptr<const std::variant<Material, BrdfFunction, BrdfTable>> content_;
};

/// A list of reflectances, converted from any range of formulas, functions, tables or reflectances.
class ReflectanceList {
 public:
  /// List of single reflectances: {paint, phong}.
  ReflectanceList(std::initializer_list<Reflectance> list) : list_(list) {}
  /// Copies the elements of a range.
  template <std::ranges::input_range Range>
  requires std::convertible_to<std::ranges::range_reference_t<Range>, Reflectance> &&
      (!std::same_as<std::remove_cvref_t<Range>, ReflectanceList>)
          ReflectanceList(Range&& range) {  // NOLINT(google-explicit-constructor,hicpp-explicit-conversions)
    for (auto&& one : range) list_.emplace_back(one);
  }

  /// Number of reflectances.
  [[nodiscard]] std::size_t size() const { return list_.size(); }
  /// Whether the list is empty.
  [[nodiscard]] bool empty() const { return list_.empty(); }
  /// The reflectance with this index.
  [[nodiscard]] const Reflectance& operator[](std::size_t i) const { return list_[i]; }
  /// The first reflectance.
  [[nodiscard]] const Reflectance& front() const { return list_.front(); }
  /// Begin of a loop over the list.
  [[nodiscard]] auto begin() const { return list_.begin(); }
  /// End of a loop over the list.
  [[nodiscard]] auto end() const { return list_.end(); }

 private:
  std::vector<Reflectance> list_;
};

}  // namespace lobe
