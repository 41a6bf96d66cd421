#pragma once

#include <cstddef>  // __GLIBC__

// A function with LOBE_CLONES is compiled for newer processors, too, and the best one is chosen as the library is
// loaded. That is before sanitizers are ready.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && defined(__GLIBC__) && __GNUC__ >= 12 && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define LOBE_CLONES __attribute__((target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")))
#else
#define LOBE_CLONES
#endif
