#include "reference/models.hpp"

namespace lobe::reference {

Real lambert(const Vector&, const Vector&) {
  return 1 / kPi;
}

}  // namespace lobe::reference
