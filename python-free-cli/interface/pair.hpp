#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "interface/measuring.hpp"
#include "interface/session.hpp"

namespace lobe::cli {

// Code shared by the commands on two operands A and B: product, distance, angle.

/// Relation of A and B under a lighting.
struct Pair {
  Figure distance;  ///< NaN, as norms and the angle, where its square is negative
  Figure norm_a;
  Figure norm_b;
  Figure product;
  Figure angle_deg;  ///< NaN when one of them is zero under the lighting
};

/// The two operands and what was found.
struct PairAnswer {
  std::array<Operand, 2> operands;
  Lighting lighting;
  Measurement measurement;
  Pair combined;
  std::vector<Pair> channels;  ///< one per channel, if there are several
};

/// Whether infinite norms are no error under point light: nowhere, everywhere, or where the delta parts of A and B are
/// equal and cancel in their distance.
enum class InfiniteNorms { refused, allowed, of_equal_deltas };

/// Measures A and B under --lighting.
/// \throws as measured().
[[nodiscard]] PairAnswer compare(Session& session, InfiniteNorms norms = InfiniteNorms::refused);

/// \throws NumericError where the square of a norm is negative, of the distance likewise
void require_norms(const PairAnswer& answer);
void require_distance(const PairAnswer& answer);

/// Prints one of the quantities, or all of them with --json; with -v all of them on standard error, too.
/// \param more further members of the JSON object
void print(Session& session, std::string_view command, const PairAnswer& answer, Figure Pair::*quantity,
           const Json& more = Json::object());

/// A and B.
[[nodiscard]] std::vector<Positional> pair_positionals();
/// `own` between those of measuring_options() and --json.
[[nodiscard]] std::vector<Option> pair_options(const std::vector<Option>& own = {});

}  // namespace lobe::cli
