#include <fmt/core.h>

#include <limits>

#include "core/text.hpp"
#include "interface/options.hpp"
#include "interface/pair.hpp"
#include "interface/terminal.hpp"

namespace lobe::cli {
namespace {

constexpr Number kFailAbove{"fail-above"};

ExitCode execute_distance(Session& session) {
  const auto& arguments = session.arguments();
  const bool has_limit = arguments.has(kFailAbove);
  const double limit = has_limit ? arguments.number(kFailAbove) : std::numeric_limits<double>::infinity();
  const PairAnswer answer = compare(session, InfiniteNorms::of_equal_deltas);
  require_distance(answer);
  const bool is_above = answer.combined.distance.estimate.value > limit;
  Json more = Json::object();
  if (has_limit) more = {{"fail_above", to_json(limit)}, {"is_above", is_above}};
  print(session, "distance", answer, &Pair::distance, more);
  if (is_above && !arguments.has(option::quiet)) {
    write_error(fmt::format("lobe: the distance is above {}\n", shortest(limit)));
  }
  return is_above ? ExitCode::negative : ExitCode::success;
}

}  // namespace

Command distance_command() {
  return {.name = "distance",
          .group = "Metric",
          .summary = "compute the distance between two materials",
          .description =
              "Computes the distance |A-B| between two materials under a lighting, with an error bound; for materials "
              "with several channels, for their weighted sum and for each one. -v adds norms, scalar product and "
              "angle; the JSON holds them all.\n"
              "Under 'point', light from every direction counts by itself. Under 'daylight', the sky is uniform and "
              "only the directional albedos count, so that different materials can be at distance 0.\n"
              "Tables are compared on the grid of the first one, and materials beside them are tabulated on it; the "
              "error then includes that of the grid.\n"
              "Mirrors have no norm under 'point', but mirrors that are the same in A and B leave the distance alone.",
          .positionals = pair_positionals(),
          .options = pair_options(
              {{.handle = kFailAbove, .value = "X", .help = "exit with status 1 if the distance is above X"}}),
          .examples = {{"two highlights under point light", "lobe distance phong:n=20 ward:m=0.2"},
                       {"a check for a script: whether two materials are alike under daylight",
                        "lobe distance lambert oren_nayar:sigma=0.1 --lighting daylight --fail-above 0.1"}},
          .execute = execute_distance};
}

}  // namespace lobe::cli
