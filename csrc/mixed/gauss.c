/* Gauss with row exchanges, in the widest numbers there are. */
#include "mixed/gauss.h"

#include <math.h>

/* glibc's header gives it to gcc alone */
#ifndef CMPLXL
#define CMPLXL(re, im) __builtin_complex((long double)(re), (long double)(im))
#endif

#define NUMBER long double
#define SIZE(x) fabsl(x)
#define CALLED(name) name
#define LESS(a, b, c) ((a) - (b) * (c))
#include "mixed/gauss_number.h"

/* |re| + |im| */
static inline long double size_of(long double _Complex x)
{
    return fabsl(creall(x)) + fabsl(cimagl(x));
}

/* a - b c, whose parts are numbers or not as those of real ones are */
static inline long double _Complex less(long double _Complex a, long double _Complex b,
                                        long double _Complex c)
{
    const long double br = creall(b), bi = cimagl(b), cr = creall(c), ci = cimagl(c);
    return CMPLXL(creall(a) - (br * cr - bi * ci), cimagl(a) - (br * ci + bi * cr));
}

#define NUMBER long double _Complex
#define SIZE(x) size_of(x)
#define CALLED(name) name##_complex
#define LESS(a, b, c) less(a, b, c)
#include "mixed/gauss_number.h"
