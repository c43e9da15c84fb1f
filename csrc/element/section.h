/* Section flexibility of a rope. */
#ifndef RD_SECTION_H
#define RD_SECTION_H

#include "base/status.h"

struct rd_section {
    double axial;    /* EA [N],     0: absent */
    double torsion;  /* C [N m^2],  0: absent */
    double bending;  /* B [N m^2],  0: absent */
    double coupling; /* D [N m]     extension-twist */
    double
        slope; /* H [1]       tilt of the section axes: couples twist and bending where both are */
};

/* flexibility (3, 3): (axial strain, twist rate, curvature) = S (axial force, torque, moment),

       S = R^T | [EA D; D C]^-1   0  | R,   R = 1/sqrt(1 + H^2) | sqrt(1 + H^2)  0  0 |
               |      0          1/B |                         |       0        1  H |
                                                               |       0       -H  1 |

   with zero rows and columns for absent channels. RD_NOT_POSITIVE_DEFINITE where EA C <= D^2. */
enum rd_status rd_section_flexibility(const struct rd_section *section, double *flexibility);

#endif
