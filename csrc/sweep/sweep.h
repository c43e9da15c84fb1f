/* Frequency response by one sweep from each end, in scattering form. */
#ifndef RD_SWEEP_H
#define RD_SWEEP_H

#include "base/status.h"
#include "sweep/scale.h"
#include "sweep/taps.h"

/* Motion Re(.. e^{i omega t}); the factors say all about frequency and damping:
       section 1 + i omega gamma,  inertia -omega^2,  spring 1 + i eta, ...
   with Im >= 0 where they take energy away (omega > 0). inertia = 0: the static solution.

       value (drives, responses, count) complex   displacement (or force) per force
       error (drives, responses, count)           its estimated absolute rounding error

   No stiffness is assembled and nothing grows with a stiffness ratio: the part behind the walk
   is u = U s, f = i (I - U) s, |I - 2U| <= 1, from a free end U = I on.
   RD_NO_MEMORY: the workspace measures too small (base NULL: `used` says what is needed).
   RD_SHORT_WAVES: a span has more pieces than are walked (span/span.h).
   RD_SINGULAR: frequency *failed is a resonance to the last digit; it has no response. */
enum rd_status rd_frf_sweep(const struct rd_chain *chain, const struct rd_factors *factors,
                            const struct rd_ports *drives, const struct rd_ports *responses,
                            struct rd_workspace *workspace, double *value, double *error,
                            size_t *failed);

#endif
