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

/// How a surface reflects light, however that is known: by formulas, as a function of pairs of directions (a measured
/// file), or as a table, the operator on a grid. An immutable value that is cheap to copy; formulas, functions and
/// tables become one wherever a verb takes reflectances.
class Reflectance {
 public:
  /// By formulas.
  Reflectance(Material formula);  // NOLINT(google-explicit-constructor,hicpp-explicit-conversions)
  /// As a function.
  Reflectance(BrdfFunction function);  // NOLINT(google-explicit-constructor,hicpp-explicit-conversions)
  /// As a table.
  Reflectance(BrdfTable table);  // NOLINT(google-explicit-constructor,hicpp-explicit-conversions)

  /// The name of a material or a function, the expression of a table.
  [[nodiscard]] const std::string& name() const;
  /// Number of channels.
  [[nodiscard]] std::size_t channels() const;
  /// Whether it does not see the azimuth of incidence.
  [[nodiscard]] bool is_isotropic() const;
  /// Whether it has mirror or retro-reflecting parts, which no value at a pair of directions shows.
  [[nodiscard]] bool has_delta() const;

  /// Its formulas; null: it is known otherwise.
  [[nodiscard]] const Material* formula() const { return std::get_if<Material>(content_.get()); }
  /// The function; null: it is known otherwise.
  [[nodiscard]] const BrdfFunction* function() const { return std::get_if<BrdfFunction>(content_.get()); }
  /// The table; null: it is known otherwise.
  [[nodiscard]] const BrdfTable* table() const { return std::get_if<BrdfTable>(content_.get()); }

  /// Calls `visitor` with whichever of Material, BrdfFunction and BrdfTable it is.
  template <typename Visitor>
  decltype(auto) visit(Visitor&& visitor) const {
    return std::visit(std::forward<Visitor>(visitor), *content_);
  }

 private:
  std::shared_ptr<const std::variant<Material, BrdfFunction, BrdfTable>> content_;
};

/// A list of reflectances, made of any range whose elements are formulas, functions, tables or reflectances.
class ReflectanceList {
 public:
  /// Of single ones: {paint, phong}.
  ReflectanceList(std::initializer_list<Reflectance> list) : list_(list) {}
  /// Those of a range, which are copied.
  template <std::ranges::input_range Range>
  requires std::convertible_to<std::ranges::range_reference_t<Range>, Reflectance> &&
      (!std::same_as<std::remove_cvref_t<Range>, ReflectanceList>)
          ReflectanceList(Range&& range) {  // NOLINT(google-explicit-constructor,hicpp-explicit-conversions)
    for (auto&& one : range) list_.emplace_back(one);
  }

  /// How many there are.
  [[nodiscard]] std::size_t size() const { return list_.size(); }
  /// Whether there are none.
  [[nodiscard]] bool empty() const { return list_.empty(); }
  /// That of a number.
  [[nodiscard]] const Reflectance& operator[](std::size_t i) const { return list_[i]; }
  /// The first of them.
  [[nodiscard]] const Reflectance& front() const { return list_.front(); }
  /// For loops over all of them.
  [[nodiscard]] auto begin() const { return list_.begin(); }
  /// The end of such loops.
  [[nodiscard]] auto end() const { return list_.end(); }

 private:
  std::vector<Reflectance> list_;
};

}  // namespace lobe
