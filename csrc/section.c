/* Section flexibility of a rope. */
#include "section.h"

#include <math.h>
#include <string.h>

enum rd_status rd_section_flexibility(const struct rd_section *section, double *flexibility)
{
    const double EA = section->axial;
    const double C = section->torsion;
    const double B = section->bending;
    const double D = section->coupling;
    const double H = C > 0 && B > 0 ? section->slope : 0;
    const double left = D == 0 ? 1 : 1 - (D / EA) * (D / C);
    if (EA < 0 || C < 0 || B < 0 || !(left > 0))
        return RD_NOT_POSITIVE_DEFINITE;

    /* the flexibility about the section's own axes: a axial, t torsion, b bending */
    const double own = 1 / left;
    const double aa = EA > 0 ? own / EA : 0;
    const double tt = C > 0 ? own / C : 0;
    const double at = D == 0 ? 0 : -own * (D / EA) / C;
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
