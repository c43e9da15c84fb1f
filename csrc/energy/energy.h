/* Energy of shapes by what stores it, and what drags on them. */
#ifndef RD_ENERGY_H
#define RD_ENERGY_H

#include "energy/sensitivity.h"

enum rd_strain {
    RD_STRAIN_BENDING,
    RD_STRAIN_TWIST,
    RD_STRAIN_STRETCH,
    RD_STRAIN_LAY, /* what the coupled entries of S store; may be negative */
    RD_STRAIN_TENSION,
    RD_STRAIN_SPRING,
    RD_STRAINS
};

/* twice the energies [J] of RD_LANES shapes */
struct rd_energy {
    lanes strain[RD_STRAINS];
    lanes
        kinetic[RD_WIDTH_MAX]; /* (width) [kg m^2] what each coordinate gives to shape^T M shape */
    lanes dragged;             /* [N s m] shape^T C shape of dashpots and drag along the spans */
};

/* Of the first load of a sensitivity turned to lines of real factors. Inertia that couples two
   coordinates is the first one's: the end correction of lumped masses, M_z,beta, is inertia of z.

   The motion inside continuous elements is that at the eigenvalue lambda, and the integrals along
   them are exact; they must be shorter than their first resonance as a cantilever.
   RD_INDEFINITE_ELEMENT where one is not. */
enum rd_status rd_energy_fill(struct rd_sensitivity *sensitivity, struct rd_energy *energy);

#endif
