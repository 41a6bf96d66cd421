#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string_view>

// Built as a library of its own with -march=native and hidden symbols: Eigen's types and inline functions must not be
// shared with code built for another instruction set, so only plain arrays cross this interface.
#define LOBE_PEER __attribute__((visibility("default")))

namespace peers {

/// Nodes as rows of `stride` values in the order cos_i, cos_o, cos_h, cos_d, tan2_h, log_cos_h, log_rv, factor; the
/// first `count` of each row are meant.
struct Nodes {
  const double* rows;
  std::size_t stride;
  std::size_t count;
};

/// A lobe: model and the constants of its formula.
struct HostLobe {
  std::string_view model;
  std::array<double, 4> constants;
};

/// factor * f at every node, nodes x lobes by columns: what a C++ programmer writes in an afternoon with Eigen arrays
/// and OpenMP.
LOBE_PEER void tabulate(const Nodes& nodes, std::span<const HostLobe> lobes, double* samples);

/// gram (lobes x lobes) += samples^T samples by Eigen's product (OpenMP).
LOBE_PEER void accumulate(const double* samples, std::size_t nodes, std::size_t lobes, double* gram);

/// Distances (lobes x lobes) from products.
LOBE_PEER void find_distances(const double* gram, std::size_t lobes, double* distance);

/// c = a b by Eigen's product (OpenMP), for row-major n x n matrices.
LOBE_PEER void multiply(const double* a, const double* b, std::size_t n, double* c);
LOBE_PEER void multiply(const float* a, const float* b, std::size_t n, float* c);

}  // namespace peers
