/* What the compiler may spend for speed. Builds that are not optimised, sanitizers and RD_ONE_COPY,
   which the C tests set, are to be compiled soon: the code is the same, and so are its bits. */
#ifndef RD_FAST_H
#define RD_FAST_H

#include <stdint.h> /* __GLIBC__ is known only after a header of the library */

#if defined(__OPTIMIZE__) && !defined(__SANITIZE_THREAD__) && !defined(__SANITIZE_ADDRESS__) &&    \
    !defined(RD_ONE_COPY)
#define RD_INLINE static inline __attribute__((always_inline))
#if defined(__GNUC__) && !defined(__clang__)
#define RD_FAST 1
#endif
#else
#define RD_INLINE static inline
#endif

#ifndef RD_FAST
#define RD_FAST 0
#endif

/* how often the loop that follows is unrolled */
#ifdef __OPTIMIZE__
#define RD_PRAGMA(text) _Pragma(#text)
#define RD_UNROLL(n) RD_PRAGMA(GCC unroll n)
#else
#define RD_UNROLL(n)
#endif

/* loops of a function take many numbers at once at -O2 too; clang's do */
#if defined(__GNUC__) && !defined(__clang__)
#define RD_VECTORS __attribute__((optimize("O3")))
#else
#define RD_VECTORS
#endif

/* one copy of a function per instruction set, chosen when the library is loaded; RD_ONE_SET, which the
   benchmark of families sets, keeps the one that is compiled for */
#if RD_FAST && defined(__x86_64__) && defined(__GLIBC__) && !defined(RD_ONE_SET)
#define RD_CLONES __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define RD_CLONES
#endif

#endif
