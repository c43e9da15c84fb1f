/* Energy of shapes by what stores it, and what drags on them. */
#ifndef RD_ENERGY_H
#define RD_ENERGY_H

#include "base/status.h"
#include "chain/chain.h"

enum rd_strain {
    RD_STRAIN_BENDING,
    RD_STRAIN_TWIST,
    RD_STRAIN_STRETCH,
    RD_STRAIN_LAY, /* what the coupled entries of S store; may be negative */
    RD_STRAIN_TENSION,
    RD_STRAIN_SPRING,
    RD_STRAINS
};

/* Twice the energies [J] of a shape (nodes, width): strain (RD_STRAINS), and kinetic (width) [kg m^2]
   what each coordinate gives to shape^T M shape. Inertia that couples two coordinates is the first
   one's: the end correction of lumped masses, M_z,beta, is inertia of z; and dragged [N s m], which
   is shape^T C shape of dashpots and of drag along the spans.

   The motion inside continuous elements is that at the eigenvalue lambda, and the integrals along
   them are exact; they must be shorter than their first resonance as a cantilever.
   RD_NOT_POSITIVE_DEFINITE where one is not. */
enum rd_status rd_energy(const struct rd_chain *chain, double lambda, const double *shape,
                         double *strain, double *kinetic, double *dragged);

#endif
