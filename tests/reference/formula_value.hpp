#pragma once

#include <map>
#include <string>
#include <string_view>

namespace lobe::reference {

/// The value of a formula in double precision, by Dijkstra's two stacks; conditions are 1 and 0. For formulas that are
/// known to be well-formed: anything else is a std::logic_error.
/// \param names values of what stands without parentheses behind it
[[nodiscard]] double formula_value(std::string_view text, const std::map<std::string, double, std::less<>>& names);

}  // namespace lobe::reference
