#include <algorithm>
#include <cmath>
#include <string>

#include "models/family/anisotropic.hpp"
#include "models/model_test.hpp"

namespace lobe::test {
namespace {

ModelCase lafortune_matrix(const std::string& parameters, const reference::SymmetricMatrix& m, Real n) {
  return {"lafortune_matrix:" + parameters,
          [=](const Vector& l, const Vector& v) { return reference::lafortune_matrix(l, v, m, n); },
          // 1 + n k / base
          [=](const Vector& l, const Vector& v) {
            const Real size = std::max({std::abs(m.xx), std::abs(m.xy), std::abs(m.yy)}) + std::abs(m.xz) +
                              std::abs(m.yz) + std::abs(m.zz);
            return 1 + n * size / std::max(reference::lafortune_matrix(l, v, m, 1), 1e-10L);
          },
          static_cast<double>(1 / std::sqrt(n)), lafortune_floor(1, n)};
}

}  // namespace

ModelTest lafortune_matrix_test() {
  return {.budget = {4, 1.2, 4, 1},
          .cases = {lafortune_matrix("m_xx=-1,m_yy=-0.8,m_zz=0.9,m_xy=0.1,m_xz=0.3,m_yz=-0.2,n=20",
                                     {-1, -0.8L, 0.9L, 0.1L, 0.3L, -0.2L}, 20),
                    lafortune_matrix("m_xx=0.5,m_yy=-0.3,m_zz=0.2,m_xy=-0.7,m_xz=1,n=3",
                                     {0.5L, -0.3L, 0.2L, -0.7L, 1, 0}, 3),
                    lafortune_matrix("m_xx=-0.9,m_yy=-1,m_zz=1,m_xz=0.4,n=200", {-0.9L, -1, 1, 0, 0.4L, 0}, 200)},
          .excess = AlbedoExcess{"lafortune_matrix:m_xx=-1,m_yy=-1,m_zz=1,m_xz=0.5,n=8", 0, 1.3720}};
}

}  // namespace lobe::test
