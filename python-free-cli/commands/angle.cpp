#include <fmt/core.h>

#include <cmath>

#include "interface/pair.hpp"
#include "lobe/core/error.hpp"

namespace lobe::cli {
namespace {

/// \throws NumericError where one of the materials is zero under the lighting.
void require_angle(const PairAnswer& answer) {
  if (!std::isnan(answer.combined.angle_deg.estimate.value)) return;
  const bool is_first = !(answer.combined.norm_a.estimate.value > answer.combined.norm_a.estimate.error);
  throw NumericError(
      fmt::format("there is no angle to '{}', whose norm under lighting '{}' is zero within its error; "
                  "give materials that reflect something, or another --lighting",
                  answer.operands.at(is_first ? 0 : 1).label(), answer.lighting.name()));
}

ExitCode execute_angle(Session& session) {
  const PairAnswer answer = compare(session);
  require_norms(answer);
  require_distance(answer);
  require_angle(answer);
  print(session, "angle", answer, &Pair::angle_deg);
  return ExitCode::success;
}

}  // namespace

Command angle_command() {
  return {.name = "angle",
          .group = "Metric",
          .summary = "compute the angle between two materials",
          .description =
              "Computes the angle between two materials as vectors, arccos(A.B / (|A| |B|)), in degrees, with an error "
              "bound; for materials with several channels, over all channels together and for each one. The angle "
              "compares shapes: scaling a material does not change it. -v adds norms, product and distance; the JSON "
              "holds them all.\n"
              "Tables are compared on the grid of the first one, and materials beside them are tabulated on it; the "
              "error then includes that of the grid.",
          .positionals = pair_positionals(),
          .options = pair_options(),
          .examples = {{"two highlights of about the same width", "lobe angle phong:n=20 ward:m=0.2"},
                       {"whether two albedos differ only by a factor",
                        "lobe angle lambert oren_nayar:sigma=0.5 --lighting daylight"}},
          .execute = execute_angle};
}

}  // namespace lobe::cli
