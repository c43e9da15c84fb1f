/* One real mode, asked for slopes and energies. */
#ifndef MODE_H
#define MODE_H

#include "energy/energy.h"

/* the only load of the only line, in every lane */
struct mode {
    struct rd_lines lines;
    struct rd_fields fields;
    struct rd_sensitivity sensitivity;
    struct rd_workspace workspace;
};

extern const struct rd_pairs MODE_PAIR; /* it with itself */

/* at the eigenvalue lambda; to be forgotten. u (nodes, width) is viewed */
struct mode *mode_ask(const struct rd_chain *chain, double lambda, const double *u);
void mode_forget(struct mode *mode);

/* rd_energy_fill of one mode: strain (RD_STRAINS), kinetic (width), dragged */
enum rd_status mode_energy(const struct rd_chain *chain, double lambda, const double *u,
                           double *strain, double *kinetic, double *dragged);

#endif
