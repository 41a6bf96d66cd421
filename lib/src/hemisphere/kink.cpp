#include "hemisphere/kink.hpp"

#include <cmath>
#include <functional>
#include <utility>

namespace lobe {

bool Kink::operator<(const Kink& other) const {
  if (order != other.order) return order < other.order;
  if (numbers != other.numbers) return numbers < other.numbers;
  if (text != other.text) return text < other.text;
  if (is_of_anisotropic != other.is_of_anisotropic) return other.is_of_anisotropic;
  return std::less<>()(at, other.at);
}

Kink exchanged(const Kink& kink) {
  Kink result = kink;
  result.by = [kink](KinkPair pair) {
    std::swap(pair.cos_i, pair.cos_o);
    std::swap(pair.in_x, pair.out_x);
    std::swap(pair.in_y, pair.out_y);
    return kink(pair);
  };
  result.text += " exchanged";
  return result;
}

Kink product_kink(double share, double order) {
  const auto at = [](const Kink::Numbers& numbers, const KinkPair& pair) {
    return pair.cos_between - numbers[0] * pair.cos_i * pair.cos_o;
  };
  return {at, {share}, order};
}

Kink difference_kink(double cosine, double order) {
  const auto at = [](const Kink::Numbers& numbers, const KinkPair& pair) { return pair.cos_between - numbers[0]; };
  return {at, {2 * cosine * cosine - 1}, order};
}

Kink distance_kink(double radius, double order) {
  const auto at = [](const Kink::Numbers& numbers, const KinkPair& pair) {
    const double sum = pair.cos_i + pair.cos_o;
    return 2 * (1 + pair.cos_between) - sum * sum - numbers[0];
  };
  return {at, {radius * radius}, order};
}

Kink plane_kink(double order) {
  const auto at = [](const Kink::Numbers&, const KinkPair& pair) {
    return pair.in_x * pair.out_y - pair.in_y * pair.out_x;
  };
  return {.at = at, .order = order, .is_anisotropic = true};
}

std::vector<Kink> cosine_kinks(double cosine, double order) {
  const auto at_in = [](const Kink::Numbers& numbers, const KinkPair& pair) { return pair.cos_i - numbers[0]; };
  const auto at_out = [](const Kink::Numbers& numbers, const KinkPair& pair) { return pair.cos_o - numbers[0]; };
  return {{at_in, {cosine}, order}, {at_out, {cosine}, order}};
}

std::vector<Kink> critical_kinks(double ior, double extinction) {
  constexpr double kTransparent = 0.05;
  if (ior >= 1 || extinction > kTransparent) return {};
  return {difference_kink(std::sqrt((1 - ior) * (1 + ior)), 0.5)};
}

}  // namespace lobe
