/* The kind of number (base/number.h) that functions of one width work with after this. Included by
   sweep/kernel/width.h with RD_REAL 0 and 1. */
#include "base/number.h"

#undef N_
#if RD_REAL
#define N_(verb) NAME(real_##verb, RD_WIDTH)
#else
#define N_(verb) K_(verb)
#endif
