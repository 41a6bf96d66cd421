#include "models/family/lafortune.hpp"
#include "models/model_test.hpp"

namespace lobe::test {
namespace {

ModelCase lafortune(const std::string& c_xy, const std::string& c_z, const std::string& n) {
  return lafortune_case("lafortune", reference::lafortune, c_xy, c_z, n);
}

}  // namespace

ModelTest lafortune_test() {
  return {.budget = {8, 2.1, 4, 1.3},
          .cases = {lafortune("-1", "1", "20"), lafortune("-1", "0.8", "10"), lafortune("-1", "1.1", "10"),
                    lafortune("1", "0.5", "3"), lafortune("-1", "1", "2000")},
          .excess = AlbedoExcess{"lafortune:c_xy=-1,c_z=1,n=1", 0, 2.094}};
}

}  // namespace lobe::test
