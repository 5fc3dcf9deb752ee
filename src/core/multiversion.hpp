#pragma once

// IGSP_MULTIVERSION before a function compiles it for the baseline, AVX2 and AVX-512 and picks one when the program
// starts, so that one binary serves every x86-64 machine. Sanitizers run before the IFUNC resolvers may, hence the
// plain function there.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define IGSP_MULTIVERSION __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define IGSP_MULTIVERSION
#endif
