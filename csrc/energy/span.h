/* How the form of continuous elements, and of massless ones that hang, changes with their numbers. */
#ifndef RD_SENSITIVITY_SPAN_H
#define RD_SENSITIVITY_SPAN_H

#include "base/status.h"
#include "energy/property.h"
#include "sweep/kernel/transfer.h"

enum { RD_SLOPE_GROUPS = (RD_PROPERTIES - 1 + RD_LANES - 1) / RD_LANES };

/* An element at one lambda, ready to be asked; of a rigid one that bends without its string. */
struct rd_wave_slopes {
    const struct rd_chain *chain;
    size_t element;             /* which distinct one; `distinct` before the first */
    size_t count;               /* numbers that are stepped, a lane each */
    size_t at[RD_PROPERTIES];   /* (count)  enum rd_property */
    double step[RD_PROPERTIES]; /* (count)  dPi/dp per imaginary part of the mixed form */
    struct rate_matrix rate;
    struct rd_transfer transfer[RD_SLOPE_GROUPS];
    double F[RD_WIDTH_MAX * RD_WIDTH_MAX], Q[RD_WIDTH_MAX * RD_WIDTH_MAX];
    double G[RD_WIDTH_MAX * RD_WIDTH_MAX], stiff[RD_WIDTH_MAX * RD_WIDTH_MAX]; /* and G^-1 */
};

/* RD_NOT_POSITIVE_DEFINITE where the element is longer than its first resonance as a cantilever */
enum rd_status rd_wave_slopes_of(const struct rd_chain *chain, size_t e, double lambda,
                                 struct rd_wave_slopes *slopes);

/* u (2, width), the motion of the nodes, <- that of the element's ends, with compliances `hinge`
   (width) or NULL between the left ones; adds the squares of the jumps to jump (width) */
void rd_wave_slopes_open(const struct rd_wave_slopes *slopes, const double *hinge, double *u,
                         double *jump);

/* adds dPi/dp of an element with its ends moved by u (2, width) to slope (RD_PROPERTIES) */
void rd_wave_slopes_add(const struct rd_wave_slopes *slopes, const double *u, double *slope);

#endif
