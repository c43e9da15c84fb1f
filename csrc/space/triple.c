/* Triples of uniform pieces in space, of complex numbers. */
#include "base/complex.h"

#include <math.h>

#define NUM double _Complex

static inline NUM times(NUM a, NUM b)
{
    return CMPLX(creal(a) * creal(b) - cimag(a) * cimag(b),
                 creal(a) * cimag(b) + cimag(a) * creal(b));
}

static inline double size(NUM a)
{
    return fabs(creal(a)) + fabs(cimag(a));
}

static inline NUM over(NUM a)
{
    const double square = creal(a) * creal(a) + cimag(a) * cimag(a);
    return CMPLX(creal(a) / square, -cimag(a) / square);
}

#include "space/kernel.h"

int rd_space_triple(const double _Complex *rates, double length, int halvings, int doublings,
                    double gentle, double _Complex *triple)
{
    struct rates E;
    struct triple t, longer;
    memcpy(&E, rates, sizeof E);
    first(&E, ldexp(length, -halvings), &t);
    int reached = 0;
    while (reached < doublings && join(&t, &t, NULL, &longer) <= gentle) {
        t = longer;
        reached++;
    }
    memcpy(triple, &t, sizeof t);
    return reached;
}
