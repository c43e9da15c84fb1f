/* All that a sweep works with, laid out in one workspace. */
#include "sweep/plan.h"

#include "span/span.h"
#include "sweep/order.h"

#include <math.h>
#include <stdbool.h>

#pragma GCC diagnostic ignored "-Wpsabi"

enum {
    DISTINCT_MOST = 64,   /* element coefficients kept per block of frequencies */
    ALIGN = 8 * RD_LANES, /* [B] of a lane vector in the workspace */
};

static const struct sweep_kernel *const kernels[] = {&rd_sweep_kernel_1, &rd_sweep_kernel_2,
                                                     &rd_sweep_kernel_3, &rd_sweep_kernel_4};

/* lane vectors want more alignment than the workspace gives */
static void *take_lanes(struct rd_workspace *workspace, size_t count, size_t size)
{
    return rd_take_aligned(workspace, count, size, ALIGN);
}

/* pieces of 1, 2, 4, .. elements or parts of them, up to all of the chain */
static size_t levels_most(const struct rd_chain *chain)
{
    size_t levels = chain->inertia ? 1 + RD_HALVINGS_MOST : 1;
    for (size_t n = chain->nodes - 1; n > 1; n /= 2)
        levels++;
    return levels;
}

/* Mass that couples z and beta and whose determinant does not cancel, such as the end correction of
   tensed elements. The one of an eccentric mass does: it needs its rank-one parts. */
static bool is_skew(const struct rd_chain *chain, const double *mass, size_t i, size_t j)
{
    const size_t w = chain->width;
    const double both = mass[i * w + j] * mass[i * w + j];
    return chain->coordinate[i] == RD_Z && chain->coordinate[j] == RD_BETA &&
           fabs(mass[i * (w + 1)] * mass[j * (w + 1)] - both) >= 0.5 * both;
}

/* Whether a walk without rows may go by minors: they know elements by their triple. */
static bool has_minors(const struct rd_chain *chain, const struct sweep_kernel *kernel)
{
    for (size_t e = 0; e < chain->distinct; e++)
        if (sweep_is_strut(chain, e))
            return false;
    return kernel->walk_plain[0] && !chain->sag &&
           (chain->width == 2 || chain->coordinate[chain->width - 1] == RD_BETA);
}

/* what the third coordinate of a chain follows of its bending, squared */
static double largest_shear(const struct rd_chain *chain)
{
    const int twists = chain->width == 3 && chain->coordinate[1] == RD_ALPHA;
    const size_t c = twists ? RD_TORSION : RD_AXIAL;
    double most = 0.0;
    for (size_t e = 0; chain->width == 3 && e < chain->distinct; e++) {
        const double *S = chain->flexibility + e * RD_CHANNELS * RD_CHANNELS;
        const double r = S[c * RD_CHANNELS + RD_BENDING] / S[RD_BENDING * (RD_CHANNELS + 1)];
        most = fmax(most, r * r);
    }
    return most;
}

/* what a node term needs besides adding masses */
static uint8_t trait_of(const struct rd_chain *chain, size_t t)
{
    const size_t w = chain->width;
    int trait = RD_FIXED;
    for (size_t i = 0; i < w; i++) {
        if (chain->held[t * w + i])
            trait |= RD_COUPLED;
        else
            trait &= ~RD_FIXED;
        if (chain->hinge && chain->hinge[t * w + i] != 0.0)
            trait |= RD_HINGED;
        for (size_t j = 0; j < w; j++) {
            const size_t at = (t * w + i) * w + j;
            if (chain->stiffness[at] != 0.0)
                trait |= RD_SPRUNG;
            if (chain->mass[at] != 0.0)
                trait |= RD_MASSIVE;
            if (chain->damping && chain->damping[at] != 0.0)
                trait |= i == j ? RD_DASHED : RD_COUPLED | RD_DASHED;
            if (i < j && (chain->stiffness[at] != 0.0 || chain->mass[at] != 0.0))
                trait |=
                    chain->stiffness[at] == 0.0 && is_skew(chain, chain->mass + t * w * w, i, j)
                        ? RD_SKEW
                        : RD_COUPLED;
        }
    }
    if (rd_attached_is_of(chain, rd_attached_first(chain, t), (int32_t)t))
        trait |= RD_COUPLED | RD_CARRIES;
    return (uint8_t)trait;
}

/* the element coefficients of a block are kept where few elements differ */
static void coefficients_take(struct sweep *s, struct rd_workspace *workspace)
{
    const struct rd_chain *chain = s->chain;
    if (chain->distinct > DISTINCT_MOST || chain->inertia)
        return;
    s->coefficients = take_lanes(workspace, chain->distinct * s->coefs, sizeof *s->coefficients);
    if (s->kernel->walk_plain[0])
        s->plain = take_lanes(workspace, chain->distinct * RD_PLAIN, sizeof *s->plain);
}

/* all arrays but those of runs and taps */
static void arrays_take(struct sweep *s, size_t frequencies, struct rd_workspace *workspace)
{
    const struct rd_chain *chain = s->chain;
    const size_t w = chain->width, left = 2 * (s->sym + s->carried * w);
    s->rank = rd_take(workspace, s->carried, sizeof *s->rank);
    s->record = take_lanes(workspace, s->records * left, sizeof *s->record);
    s->rows = take_lanes(workspace, 2 * s->carried * w, sizeof *s->rows);
    s->table = take_lanes(workspace, levels_most(chain) * s->coefs, sizeof *s->table);
    s->triple = take_lanes(workspace, 2 * s->coefs, sizeof *s->triple);
    s->value = take_lanes(workspace, s->carried, sizeof *s->value);
    s->error = take_lanes(workspace, s->carried, sizeof *s->error);
    s->weight = take_lanes(workspace, s->carried, sizeof *s->weight);
    coefficients_take(s, workspace);
    s->foot = take_lanes(workspace, chain->attached, sizeof *s->foot);
    s->trait = rd_take(workspace, chain->terms, sizeof *s->trait);
    s->order = rd_take(workspace, frequencies, sizeof *s->order);
}

struct sweep *rd_sweep_plan(const struct rd_chain *chain, const struct rd_factors *factors,
                            const struct rd_ports *drives, const struct rd_ports *responses,
                            struct rd_workspace *workspace)
{
    const size_t w = chain->width, sym = w * (w + 1) / 2;
    const int swapped = drives->count < responses->count;
    const struct rd_ports *carry = swapped ? drives : responses;
    const struct rd_ports *meet = swapped ? responses : drives;
    struct sweep plan = {
        .chain = chain,
        .between = factors->between,
        .kernel = kernels[w - 1],
        .coefs = w * w + 2 * sym,
        .sym = sym,
        .carried = carry->count,
        .swapped = swapped,
        .failed = factors->count,
    };
    struct sweep *s = take_lanes(workspace, 1, sizeof *s);
    rd_taps_find(carry, chain, &plan.carry, workspace);
    rd_taps_find(meet, chain, &plan.meet, workspace);
    plan.records = plan.meet.tap ? rd_taps_nodes(&plan.meet) : plan.meet.count;
    struct rd_run *run = rd_take(workspace, rd_runs_capacity(chain), sizeof *run);
    arrays_take(&plan, factors->count, workspace);
    if (!rd_workspace_fits(workspace))
        return NULL;
    *s = plan;
    s->minors = has_minors(chain, s->kernel);
    s->shear = s->minors ? largest_shear(chain) : 0.0;
    rd_runs_find(chain, run, &s->runs);
    rd_taps_rank(&s->carry, s->carried, s->rank);
    for (size_t t = 0; t < chain->terms; t++)
        s->trait[t] = trait_of(chain, t);
    for (size_t b = 0; b < 2; b++)
        s->walk[b] = (struct sweep_walk){chain,           &s->block, &s->way[b], s->trait,
                                         s->coefficients, s->plain,  &s->made,   s->foot};
    return s;
}
