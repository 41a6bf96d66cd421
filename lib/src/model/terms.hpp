#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "lobe/model/material.hpp"

namespace lobe {

/// A term of kCustomModel with weight 1.
/// \throws ArgumentError for a formula that is not valid, or when there is not one value per parameter
[[nodiscard]] Term make_custom_term(Formula formula, const std::vector<double>& values);

/// \throws ArgumentError when a term has too many factors, not one value per parameter of its formula, or curves of
///   another length than the device reads; for a formula that is not valid
void require_consistent(const Term& term);

/// \throws ArgumentError for an unknown correction, and unless there is a curve, each of kCurveNumbers
[[nodiscard]] Pumping make_pumping(std::string_view correction, std::vector<std::vector<double>> albedos);

/// Factors of the mirror that an adjustment adds: Fresnel's equations or none.
/// \throws ArgumentError for a refractive index out of range
[[nodiscard]] std::vector<Factor> boundary_of(const Adjustment& mirror);

/// The terms of a model, one per channel, as terms of a material: one for all channels where they have the same values,
/// else each with the weight 1 in its channel and 0 in the others.
[[nodiscard]] std::vector<Term> split_by_channel(std::vector<Term> of_channels);

/// Multiplies the weights of terms that make_terms() made by one number, or by one per channel.
/// \throws ArgumentError when the numbers of channels differ
void apply_weight(std::vector<Term>& terms, const std::vector<double>& weight);

/// The terms of a specification: split at '+', but not in exponents such as 1e+3.
[[nodiscard]] std::vector<std::string_view> split_terms(std::string_view text);

/// The family that a material of these terms belongs to unless it says otherwise.
[[nodiscard]] std::string family_of(const std::vector<Term>& terms);

}  // namespace lobe
