// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Compiles a function, with all that it calls inlined, for AVX2 as well; the processor at hand
/// decides which runs. The same bits either way: no fused multiply-add. For GCC, which alone can
/// have both attributes; VDB_SHELL_ONE_TARGET turns it off, to look at that. Where all is compiled
/// for AVX2 (src/CMakeLists.txt) there is nothing to decide, and callers may inline it.
#if defined(__GNUC__) && !defined(__clang__) && defined(__AVX2__)
#define VDB_SHELL_TWO_TARGETS __attribute__((flatten))
#elif defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && defined(__ELF__) &&       \
    !defined(VDB_SHELL_ONE_TARGET)
#define VDB_SHELL_TWO_TARGETS __attribute__((target_clones("avx2", "default"), flatten))
#else
#define VDB_SHELL_TWO_TARGETS
#endif
