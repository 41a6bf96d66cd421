#pragma once

#include <string_view>

#include "lobe/model/material.hpp"

namespace lobe {

/// f(L,V) = f(V,L) for all models of a material.
[[nodiscard]] bool is_reciprocal(const Material& material);

/// f depends on the difference of azimuths alone, for all models of a material.
[[nodiscard]] bool is_isotropic(const Material& material);

/// \param what what isotropic models are expected for, and what there is for others
/// \throws NumericError that says so
[[noreturn]] void refuse_anisotropic(std::string_view material, std::string_view model, std::string_view what);

}  // namespace lobe
