/* Strain and kinetic energy of shapes, by what stores it. */
#ifndef RD_ENERGY_H
#define RD_ENERGY_H

#include "chain.h"
#include "status.h"

enum rd_strain {
    RD_STRAIN_BENDING,
    RD_STRAIN_TWIST,
    RD_STRAIN_STRETCH,
    RD_STRAIN_LAY, /* what the coupled entries of S store; may be negative */
    RD_STRAIN_TENSION,
    RD_STRAIN_SPRING,
    RD_STRAINS
};

/* strain (RD_STRAINS), twice the energy [J] of shape (nodes, width). The force on the right end of
   each element follows from the shape: short elements lose digits, being differences of nearly
   equal motions. */
enum rd_status rd_energy_strain(const struct rd_chain *chain, const double *shape, double *strain);

/* twice the energy [J] of the springs at the nodes */
double rd_energy_springs(const struct rd_chain *chain, const double *shape);

/* shape^T C shape [N s m] of the dashpots at the nodes */
double rd_energy_dashpots(const struct rd_chain *chain, const double *shape);

/* kinetic (width) [kg m^2]: what each coordinate gives to shape^T M shape. What couples two is the
   first one's: the end correction of lumped masses, M_z,beta, is inertia of z. */
void rd_energy_kinetic(const struct rd_chain *chain, const double *shape, double *kinetic);

#endif
