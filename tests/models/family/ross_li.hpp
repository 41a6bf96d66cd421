#pragma once

#include "models/model_test.hpp"

namespace lobe::test {

using reference::kPi;

}  // namespace lobe::test
