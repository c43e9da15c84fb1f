/* Energies of a march. */
#ifndef RD_MARCH_ACCOUNT_H
#define RD_MARCH_ACCOUNT_H

#include "march/plan.h"

/* energy (RD_ENERGIES) += input and dissipation of a stage that rd_march_take is to take next;
   taken (laws) likewise. extra [N]: tension from outside, whose work is input. */
void rd_march_account(const struct rd_march *march, double g, const struct rd_push *push,
                      double extra, double *energy, double *taken);

/* kinetic and strain energy at the start of a step [J] */
void rd_march_energy(const struct rd_march *march, double *energy);

#endif
