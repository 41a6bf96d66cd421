#pragma once

// toml++ 3.3 takes for granted that a table's name begins like one: "[!" fails an assertion there and, with NDEBUG,
// which makes assumptions of them, is undefined behaviour. Without both it complains by itself.
#ifdef NDEBUG
#define LOBE_NDEBUG
#undef NDEBUG
#endif
#define TOML_ASSERT(expression) static_cast<void>(0)
#include <toml++/toml.h>
#ifdef LOBE_NDEBUG
#undef LOBE_NDEBUG
#define NDEBUG
#endif
