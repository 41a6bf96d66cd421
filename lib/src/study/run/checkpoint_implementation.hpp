#pragma once

#include "lobe/study/checkpoint.hpp"
#include "study/run/record_file.hpp"

namespace lobe {

struct Checkpoint::Implementation {
  RecordFile file;
};

}  // namespace lobe
