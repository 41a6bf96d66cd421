#include <fmt/core.h>

#include <algorithm>

#include "interface/options.hpp"
#include "interface/repairing.hpp"
#include "lobe/energy/repair.hpp"

namespace lobe::cli {
namespace {

constexpr Flag kChannelsTogether{"channels-together"};
constexpr Flag kWhite{"white"};

/// The smallest and largest factors of each channel.
Findings findings(const BalancedTable& balanced) {
  Findings result;
  result.fields.push_back({"sweeps", fmt::format("{}", balanced.sweeps)});
  result.json["sweeps"] = balanced.sweeps;
  result.json["departure"] = balanced.departure;
  result.json["asymmetry"] = balanced.asymmetry;
  result.json["factors"] = Json::array();
  for (std::size_t c = 0; c < balanced.factors.size(); ++c) {
    const auto [least, largest] = std::ranges::minmax(balanced.factors[c]);
    result.fields.push_back(
        {channel_name("factors", balanced.table, c), fmt::format("{:.6g} to {:.6g}", least, largest)});
    result.json["factors"].push_back(balanced.factors[c]);
  }
  return result;
}

ExitCode execute_balance(Session& session) {
  const auto& arguments = session.arguments();
  const BalanceOptions options{.tolerance = session.tolerance(BalanceOptions{}.tolerance),
                               .channels_together = arguments.has(kChannelsTogether),
                               .to_white = arguments.has(kWhite),
                               .reciprocal_part = !arguments.has(option::strict),
                               .progress = session.progress(),
                               .missed = session.missed()};
  return repair(session, "balance", [&](const Device& device, const Reflectance& table) {
    BalancedTable balanced = scale_symmetrically(device, table, options);
    if (balanced.asymmetry > 0) {
      session.warn(
          fmt::format("f(L, V) and f(V, L) differ by {:.3g} sr^-1; the reciprocal part is balanced, their mean, and "
                      "--strict refuses it",
                      balanced.asymmetry));
    }
    Findings found = findings(balanced);
    return Repaired{std::move(balanced.table), std::move(found)};
  });
}

}  // namespace

Command balance_command() {
  return {
      .name = "balance",
      .group = "Repair",
      .summary = "limit a table to the light that it receives",
      .description =
          "Restores the energy balance of a reciprocal table by f*(L, V) = s(L) f(L, V) s(V), which stays reciprocal. "
          "The factors s are at most 1, no albedo exceeds 1 afterwards, and wherever a factor is below 1 the albedo is "
          "1: no direction is darkened more than its own balance requires. Prints the factors and how far the table "
          "moves. A balanced table stays unchanged. Of a table that is not reciprocal the reciprocal part is "
          "balanced, with a warning.\n"
          "Each channel has its own factors, so that a balanced channel is left alone. With --channels-together all "
          "channels share their factors, which preserves the ratios of channels and darkens more.\n"
          "With --white factors may exceed 1, and the albedo is 1 for all directions (Sinkhorn's scaling): the surface "
          "absorbs nothing.",
      .positionals = {{.handle = argument::a, .help = "the table or material", .is_material = true}},
      .options =
          table_command_options({{.handle = kChannelsTogether, .help = "use the same factors for all channels"},
                                 {.handle = kWhite, .help = "make all albedos 1"},
                                 tolerance_option("how far an albedo may be off its bound (default 1e-12)")},
                                "the grid (default: the table's own; else as fine as a material or file needs)", false),
      .examples = {{"a paint that reflects more light than it receives",
                    "lobe tabulate lambert:scale=0.5+phong:n=20,scale=0.7 -o paint.h5"},
                   {"the same paint with no albedo above 1", "lobe balance paint.h5 -o balanced.h5"}},
      .execute = execute_balance};
}

}  // namespace lobe::cli
