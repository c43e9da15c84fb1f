/* Modes and counts of chains that bend: what stands left and right of a face meets there. */
#ifndef __clang__
#pragma GCC optimize("schedule-insns") /* what a lane waits for is done while others are: 30 % */
#endif

#include "closed/chain_lanes.h"

enum { SPAN_NUMBERS = 4, LENGTH = 0, INERTIA, TENSION, STIFFNESS };
enum { STATION_NUMBERS = 4, MASS = 0, TURNING, SPRING_Z, SPRING_BETA };

static size_t at_span(size_t e)
{
    return SPAN_NUMBERS * e;
}

static size_t at_station(size_t spans, size_t s)
{
    return SPAN_NUMBERS * spans + STATION_NUMBERS * s;
}

/* both of its sides go their own ways */
static _Bool chain_splits(const struct rd_chains *chains, const double *number, size_t s)
{
    const double *here = number + at_station(chains->spans, s);
    return here[SPRING_Z] == (double)INFINITY &&
           (here[SPRING_BETA] == (double)INFINITY || chains->hinge[s]);
}

static _Bool chain_valid(const struct rd_chains *chains, const double *number)
{
    _Bool valid = 1;
    for (size_t e = 0; e < chains->spans; e++) {
        const double *span = number + at_span(e);
        valid &= span[LENGTH] > 0 && span[INERTIA] > 0 && span[STIFFNESS] > 0 &&
                 span[LENGTH] < (double)INFINITY && span[INERTIA] < (double)INFINITY &&
                 span[STIFFNESS] < (double)INFINITY && fabs(span[TENSION]) < (double)INFINITY;
    }
    for (size_t s = 0; s <= chains->spans; s++) {
        const double *here = number + at_station(chains->spans, s);
        valid &= fabs(here[MASS]) < (double)INFINITY && here[MASS] >= 0 &&
                 fabs(here[TURNING]) < (double)INFINITY && here[TURNING] >= 0 &&
                 here[SPRING_Z] > -(double)INFINITY && here[SPRING_BETA] > -(double)INFINITY;
    }
    return valid;
}

/* omega of mode n of one span between held ends that is as long and as heavy, or so */
static double chain_guess(const struct rd_chains *chains, const double *number, size_t first,
                          size_t last, double n)
{
    double L = 0, m = 0, T = 0, B = 0;
    for (size_t e = first; e < last; e++) {
        const double *span = number + at_span(e), l = span[LENGTH];
        L += l;
        m += l * span[INERTIA];
        T += l * span[TENSION];
        B += l * span[STIFFNESS];
    }
    /* masses are felt by waves that are longer than what is between them */
    for (size_t s = first; s <= last && n < (double)(last - first); s++)
        m += number[at_station(chains->spans, s) + MASS];
    const double beta = n * PI / L;
    return beta * sqrt(((T > 0 ? T : 0) + B * beta * beta) / m);
}

static void chain_fill(struct chain_lanes *chain, size_t i, const double *number)
{
    for (size_t e = 0; e < chain->spans; e++) {
        const double *span = number + at_span(e);
        chain->load[e][i] = sqrt(span[INERTIA] / span[STIFFNESS]);
        chain->pull[e][i] = 0.5 * span[TENSION] / span[STIFFNESS];
    }
}

RD_INLINE _Bool chain_turns_free(const struct chain_lanes *chain, size_t s)
{
    return chain->hinge[s];
}

RD_INLINE struct standing chain_standing(const struct chain_lanes *chain, size_t s)
{
    const lanes *here = chain->number + at_station(chain->spans, s);
    return (struct standing){here[MASS], here[TURNING], here[SPRING_Z], here[SPRING_BETA]};
}

/* the waves of a span, and how fast its kl grows with ln omega */
RD_INLINE lanes chain_span(struct chain_lanes *chain, size_t e, lanes omega)
{
    const lanes *span = chain->number + at_span(e);
    struct span_waves *w = chain->wave + e;
    *w = span_waves(span[LENGTH], chain->load[e], chain->pull[e], span[STIFFNESS], omega);
    return w->kl * w->alpha * w->alpha;
}

RD_INLINE struct pair chain_pass(struct part *part, const struct span_waves *w, lanes *near)
{
    return pass_span(part, w, near);
}

RD_INLINE lanes chain_beyond(const struct meeting *m, const struct chain_place *place)
{
    return meeting_beyond(m, place->odd, place->turns);
}

RD_INLINE struct duo chain_wave(const struct meeting *m, const struct chain_place *place)
{
    return meeting_wave(m, place->odd);
}

/* how far the other phase is, as a sine */
RD_INLINE lanes chain_split(const struct meeting *m)
{
    return m->size;
}

/* of springs and inertia, by what they are over the scales */
RD_INLINE void chain_station_slopes(lanes *slope, lanes of_z, lanes of_beta, lanes square)
{
    slope[SPRING_Z] += of_z;
    slope[SPRING_BETA] += of_beta;
    slope[MASS] -= square * of_z;
    slope[TURNING] -= square * of_beta;
}

RD_INLINE void chain_span_slopes(struct chain_lanes *chain, size_t e, struct chain_slope *sum)
{
    const lanes *span = chain->number + at_span(e);
    lanes *slope = chain->slope + at_span(e);
    const struct span_slopes of =
        span_slopes(chain->wave + e, chain->pull[e], chain->in[0][e], chain->in[1][e]);
    slope[LENGTH] = of.length / span[LENGTH];
    slope[INERTIA] = of.inertia / span[INERTIA];
    slope[TENSION] = of.tension / span[STIFFNESS];
    slope[STIFFNESS] = of.stiffness / span[STIFFNESS];
    sum->of_omega += 2.0 * of.inertia;
    sum->noise += of.noise;
}

#include "closed/chain_roots.h"
#include "closed/chain_walk.h"

size_t rd_chain_work(size_t spans, size_t number)
{
    struct rd_workspace workspace = {0};
    struct chain_lanes chain;
    struct chain_block block;
    lay(&workspace, spans, rd_bent_numbers(spans), number, &chain, &block);
    return workspace.used;
}

void rd_bent_chain_modes(const struct rd_chains *chains, size_t first, size_t last,
                         const struct rd_closed_modes *modes, const struct rd_workspace *workspace)
{
    chain_modes(chains, rd_bent_numbers(chains->spans), first, last, modes, *workspace);
}

void rd_bent_chain_count(const struct rd_chains *chains, size_t first, size_t last, double omega,
                         int64_t *count, const struct rd_workspace *workspace)
{
    chain_count(chains, rd_bent_numbers(chains->spans), first, last, omega, count, *workspace);
}
