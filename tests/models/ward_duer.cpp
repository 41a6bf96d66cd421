#include "models/family/ward_variants.hpp"
#include "models/model_test.hpp"

namespace lobe::test {
namespace {

ModelCase duer(const std::string& m) {
  return ward_case("ward_duer", reference::ward_duer, m);
}

}  // namespace

ModelTest ward_duer_test() {
  return {.budget = {16, 3.9, 8, 1.7},
          .cases = {duer("0.01"), duer("0.3"), duer("1")},
          .excess = AlbedoExcess{"ward_duer:m=0.1", 89.99, 157.4}};
}

}  // namespace lobe::test
