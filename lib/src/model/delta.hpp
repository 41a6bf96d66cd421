#pragma once

#include "lobe/model/material.hpp"

namespace lobe {

/// Where a delta part sends light.
enum class DeltaKind { mirror, retro };

/// A delta part as a lobe.
struct DeltaLobe {
  DeltaKind kind = DeltaKind::mirror;
  Term term;  ///< reflects everything but what its factors, pumping and complement leave; weight 1
};

/// \param term of a delta part
[[nodiscard]] DeltaLobe delta_lobe(const Term& term);

/// A Lambertian term of weight 1 with the factors and pumping of a delta part.
[[nodiscard]] Term without_delta(const DeltaLobe& delta);

/// A material's delta parts apart from the rest; each may have no terms.
struct DeltaSplit {
  Material smooth;  ///< the terms with values in sr^-1
  Material deltas;
};

[[nodiscard]] DeltaSplit split_delta(const Material& material);

/// The terms with values in sr^-1 as a material of as many channels, black where there are none.
[[nodiscard]] Material smooth_part(const Material& material);

}  // namespace lobe
