/* Many chains of uniform spans at once, in closed form: lanes are places of (rope, mode).

   A chain has spans, and stations between them and at both ends. Its numbers, a row for each rope:

       bent:   for each span length, mu, T, B; for each station mass, rotary inertia and springs
               against z and beta
       plain:  for each span length, m, D; for each station mass and spring

   (strings, rods that twist or stretch: m u,tt = D u''). T has either sign. Springs have either sign
   or hold (infinite); what stands at a station is 0 where there is nothing. A hinge lets beta jump
   between a station and the span on its right. Bits of a row do not depend on the others. */
#ifndef RD_CHAINS_H
#define RD_CHAINS_H

#include "base/workspace.h"
#include "closed/closed.h"

struct rd_chains {
    size_t spans;           /* at least 1 */
    const double *number;   /* rows x rd_..._numbers(spans) */
    const uint8_t *hinge;   /* (spans + 1), for bent chains */
    size_t columns;         /* of slopes */
    const double *jacobian; /* numbers x columns: d number / d what slopes are by */
};

static inline size_t rd_bent_numbers(size_t spans)
{
    return 4 * spans + 4 * (spans + 1);
}

static inline size_t rd_plain_numbers(size_t spans)
{
    return 3 * spans + 2 * (spans + 1);
}

/* Bytes of the workspace for chains of so many spans and modes; SIZE_MAX where that is too much. */
size_t rd_chain_work(size_t spans, size_t number);

/* As rd_bent_modes; `slope` is rows x number x columns. The workspace is used from its start. */
void rd_bent_chain_modes(const struct rd_chains *chains, size_t first, size_t last,
                         const struct rd_closed_modes *modes, const struct rd_workspace *workspace);
void rd_plain_chain_modes(const struct rd_chains *chains, size_t first, size_t last,
                          const struct rd_closed_modes *modes,
                          const struct rd_workspace *workspace);

/* As rd_bent_count; the workspace as for two modes. */
void rd_bent_chain_count(const struct rd_chains *chains, size_t first, size_t last, double omega,
                         int64_t *count, const struct rd_workspace *workspace);
void rd_plain_chain_count(const struct rd_chains *chains, size_t first, size_t last, double omega,
                          int64_t *count, const struct rd_workspace *workspace);

#endif
