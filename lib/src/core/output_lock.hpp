#pragma once

#include "lobe/core/output_lock.hpp"
