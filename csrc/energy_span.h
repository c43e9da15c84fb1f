/* Strain and kinetic energy of the modes of continuous spans, by what stores it. */
#ifndef RD_ENERGY_SPAN_H
#define RD_ENERGY_SPAN_H

#include "energy.h"

/* As rd_energy_strain, rd_energy_kinetic and rd_energy_dashpots, with the drag of the spans, of a
   shape (nodes, width) at its eigenvalue lambda: the integrals along the spans are exact. Elements must be shorter than their first resonance as a
   cantilever. RD_NOT_POSITIVE_DEFINITE where one is not. */
enum rd_status rd_energy_span(const struct rd_chain *chain, double lambda, const double *shape,
                              double *strain, double *kinetic, double *dragged);

#endif
