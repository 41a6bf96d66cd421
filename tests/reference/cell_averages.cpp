#include "reference/cell_averages.hpp"

#include <cmath>
#include <numbers>
#include <vector>

#include "reference/quadrature.hpp"

namespace lobe::reference {
namespace {

using std::numbers::pi;

struct Sample {
  Vector direction;
  double weight;
};

std::vector<Sample> samples_of(const PolarCell& cell, int order) {
  const GaussRule rule = gauss_legendre(order);
  const auto count = static_cast<std::size_t>(order);
  std::vector<Sample> samples;
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i) {
    // In the angle itself, in which reflectances are smooth at the normal and at the horizon.
    const double theta = (cell.theta_low + cell.theta_high + (cell.theta_high - cell.theta_low) * rule.nodes[i]) / 2;
    for (std::size_t j = 0; j < count; ++j) {
      const double phi = (cell.phi_low + cell.phi_high + (cell.phi_high - cell.phi_low) * rule.nodes[j]) / 2;
      samples.push_back({{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)},
                         rule.weights[i] * rule.weights[j] * std::sin(theta) * std::cos(theta)});
      sum += samples.back().weight;
    }
  }
  for (Sample& sample : samples) sample.weight /= sum;
  return samples;
}

/// Shirley and Chiu 1997, by quadrants of the square turned to the first one.
Vector on_hemisphere(double a, double b) {
  const double r = std::max(std::abs(a), std::abs(b));
  double phi = 0;
  if (r == 0) return {0, 0, 1};
  if (a == r) {
    phi = pi / 4 * b / r;
  } else if (b == r) {
    phi = pi / 2 - pi / 4 * a / r;
  } else if (a == -r) {
    phi = pi - pi / 4 * b / r;
  } else {
    phi = 3 * pi / 2 + pi / 4 * a / r;
  }
  return {r * std::cos(phi), r * std::sin(phi), std::sqrt(std::max(0.0, 1 - r * r))};
}

/// Over the triangle of three corners, by a square that is collapsed to it.
void add_triangle(std::vector<Sample>& samples, const double (&x)[3], const double (&y)[3], int order) {
  const GaussRule rule = gauss_legendre(order);
  const auto count = static_cast<std::size_t>(order);
  for (std::size_t i = 0; i < count; ++i) {
    const double s = (1 + rule.nodes[i]) / 2;
    for (std::size_t j = 0; j < count; ++j) {
      const double t = (1 + rule.nodes[j]) / 2;
      const double a = x[0] + s * ((x[1] - x[0]) * (1 - t) + (x[2] - x[0]) * t);
      const double b = y[0] + s * ((y[1] - y[0]) * (1 - t) + (y[2] - y[0]) * t);
      samples.push_back({on_hemisphere(a, b), rule.weights[i] * rule.weights[j] * s});
    }
  }
}

std::vector<Sample> samples_of(const SquareCell& cell, int order) {
  const double a0 = cell.a;
  const double b0 = cell.b;
  const double a1 = a0 + cell.side;
  const double b1 = b0 + cell.side;
  std::vector<Sample> samples;
  // The kink of a cell on a = b runs from its lower to its upper corner, on a = -b the other way.
  if (std::abs(a0 - b0) < std::abs(a0 + b1)) {
    add_triangle(samples, {a0, a1, a1}, {b0, b0, b1}, order);
    add_triangle(samples, {a0, a1, a0}, {b0, b1, b1}, order);
  } else {
    add_triangle(samples, {a0, a1, a0}, {b1, b0, b0}, order);
    add_triangle(samples, {a0, a1, a1}, {b1, b0, b1}, order);
  }
  double sum = 0;
  for (const Sample& sample : samples) sum += sample.weight;
  for (Sample& sample : samples) sample.weight /= sum;
  return samples;
}

template <typename Cell>
double average(const Reflectance& f, const Cell& in, const Cell& out, int order) {
  const auto lights = samples_of(in, order);
  const auto views = samples_of(out, order);
  double sum = 0;
  for (const Sample& light : lights) {
    for (const Sample& view : views) {
      sum += light.weight * view.weight * static_cast<double>(f(light.direction, view.direction));
    }
  }
  return sum;
}

}  // namespace

double cell_average(const Reflectance& f, const PolarCell& in, const PolarCell& out, int order) {
  return average(f, in, out, order);
}

double cell_average(const Reflectance& f, const SquareCell& in, const SquareCell& out, int order) {
  return average(f, in, out, order);
}

}  // namespace lobe::reference
