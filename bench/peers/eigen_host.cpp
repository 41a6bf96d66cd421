#include "peers/eigen_host.hpp"

#include <Eigen/Core>

namespace peers {
namespace {

using Column = Eigen::Map<const Eigen::ArrayXd>;

Eigen::ArrayXd evaluate(const Nodes& nodes, const HostLobe& lobe) {
  const auto row = [&](std::size_t index) {
    return Column(nodes.rows + index * nodes.stride, static_cast<Eigen::Index>(nodes.count));
  };
  const auto [c0, c1, c2, c3] = lobe.constants;
  const Column cos_i = row(0);
  const Column cos_o = row(1);
  const Column cos_d = row(3);
  const Column factor = row(7);
  if (lobe.model == "lambert") return c0 * factor;
  if (lobe.model == "blinn") return c0 * (c1 * row(5)).exp() * factor;
  if (lobe.model == "phong") return c0 * (c1 * row(6)).exp() * factor;
  if (lobe.model == "ward") return c0 * (c1 * row(4)).exp() / (cos_i * cos_o).sqrt() * factor;
  if (lobe.model == "cook_torrance") {
    return c0 * (c1 * row(4) - 4 * row(5)).exp() * (2 * row(2) * cos_i.min(cos_o) / cos_d).min(1.0) *
           (c2 + c3 * (1 - cos_d).square().square() * (1 - cos_d)) / (cos_i * cos_o) * factor;
  }
  if (lobe.model == "metal_phong") return c0 * (c1 * row(6)).exp() / cos_i.max(cos_o) * factor;
  if (lobe.model == "minnaert") return c0 * (c1 * (cos_i * cos_o).log()).exp() * factor;
  if (lobe.model == "oren_nayar") {
    return (c0 + c1 * (2 * cos_d.square() - 1 - cos_i * cos_o).max(0.0) / cos_i.max(cos_o)) * factor;
  }
  if (lobe.model == "exponential_patch") return c0 * (2 * c1 * cos_d * row(2) * row(4).sqrt()).exp() * factor;
  // lafortune
  const Eigen::ArrayXd base = c1 * (2 * cos_d.square() - 1 - cos_i * cos_o) + c2 * cos_i * cos_o;
  return (base > 0).select(c0 * (c3 * base.max(1e-30).log()).exp() * factor, 0.0);
}

template <typename Number>
void multiply_square(const Number* a, const Number* b, std::size_t size, Number* c) {
  using Matrix = Eigen::Matrix<Number, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const auto n = static_cast<Eigen::Index>(size);
  const Eigen::Map<const Matrix> left(a, n, n);
  const Eigen::Map<const Matrix> right(b, n, n);
  Eigen::Map<Matrix>(c, n, n).noalias() = left * right;
}

}  // namespace

void tabulate(const Nodes& nodes, std::span<const HostLobe> lobes, double* samples) {
  const auto count = static_cast<Eigen::Index>(nodes.count);
#pragma omp parallel for schedule(dynamic, 4)
  for (std::size_t i = 0; i < lobes.size(); ++i) {
    Eigen::Map<Eigen::ArrayXd>(samples + i * nodes.count, count) = evaluate(nodes, lobes[i]);
  }
}

void accumulate(const double* samples, std::size_t nodes, std::size_t lobes, double* gram) {
  const auto n = static_cast<Eigen::Index>(lobes);
  const Eigen::Map<const Eigen::MatrixXd> s(samples, static_cast<Eigen::Index>(nodes), n);
  Eigen::Map<Eigen::MatrixXd>(gram, n, n).noalias() += s.transpose() * s;
}

void find_distances(const double* gram, std::size_t lobes, double* distance) {
  const auto n = static_cast<Eigen::Index>(lobes);
  const Eigen::Map<const Eigen::ArrayXXd> g(gram, n, n);
  Eigen::Map<Eigen::ArrayXXd> d(distance, n, n);
  const Eigen::ArrayXd squares = g.matrix().diagonal();
  d = -2 * g;
  d.colwise() += squares;
  d.rowwise() += squares.transpose();
  d = d.max(0.0).sqrt();
}

void multiply(const double* a, const double* b, std::size_t n, double* c) {
  multiply_square(a, b, n, c);
}

void multiply(const float* a, const float* b, std::size_t n, float* c) {
  multiply_square(a, b, n, c);
}

}  // namespace peers
