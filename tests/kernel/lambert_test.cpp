#include "kernel/model_kernel.hpp"

namespace lobe::test {
namespace {

Real no_condition(const Vector&, const Vector&) {
  return 1;
}

INSTANTIATE_TEST_SUITE_P(lambert, ModelKernel,
                         ::testing::Values(ModelCase{"lambert", reference::lambert, no_condition, 1}), ByName{});

}  // namespace
}  // namespace lobe::test
