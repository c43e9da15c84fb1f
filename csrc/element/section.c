/* Section flexibility of a rope. */
#include "element/section.h"

#include <math.h>
#include <string.h>

/* [EA D; D C]^-1 */
struct pair {
    double aa, tt, at;
    int positive;
};

/* With D^2 near EA C few digits are left of EA C - D^2 unless both products are kept whole (Kahan;
   Jeannerod, Louvet, Muller 2013); scaled by powers of two, so that nothing overflows. */
static struct pair invert(double EA, double C, double D)
{
    if (D == 0)
        return (struct pair){EA > 0 ? 1 / EA : 0, C > 0 ? 1 / C : 0, 0, 1};
    int a, t;
    const double x = frexp(EA, &a);
    double y = frexp(C, &t);
    if ((a + t) % 2 != 0) {
        y *= 2;
        t--;
    }
    const double z = ldexp(D, -(a + t) / 2), square = z * z, product = x * y;
    const double left = (product - square) + (fma(x, y, -product) - fma(z, z, -square));
    return (struct pair){ldexp(y / left, -a), ldexp(x / left, -t), ldexp(-z / left, -(a + t) / 2),
                         left > 0};
}

enum rd_status rd_section_flexibility(const struct rd_section *section, double *flexibility)
{
    const double EA = section->axial;
    const double C = section->torsion;
    const double B = section->bending;
    const double D = section->coupling;
    const double H = C > 0 && B > 0 ? section->slope : 0;
    const struct pair pair = invert(EA, C, D);
    if (EA < 0 || C < 0 || B < 0 || !pair.positive)
        return RD_NOT_POSITIVE_DEFINITE;

    /* the flexibility about the section's own axes: a axial, t torsion, b bending */
    const double aa = pair.aa, tt = pair.tt, at = pair.at;
    const double bb = B > 0 ? 1 / B : 0;

    /* tilted by the lay slope */
    const double c = 1 / hypot(1, H);
    const double s = H * c;
    // clang-format off
    const double S[9] = {
        aa,     at * c,                   at * s,
        at * c, c * c * tt + s * s * bb,  c * s * (tt - bb),
        at * s, c * s * (tt - bb),        s * s * tt + c * c * bb,
    };
    // clang-format on
    memcpy(flexibility, S, sizeof S);
    return RD_OK;
}
