/* Complex numbers of C. glibc's header gives CMPLX to gcc alone. */
#ifndef RD_COMPLEX_H
#define RD_COMPLEX_H

#include <complex.h>

#ifndef CMPLX
#define CMPLX(re, im) __builtin_complex((double)(re), (double)(im))
#endif

#endif
