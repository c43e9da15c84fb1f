/* Modes and counts of chains of strings, or of rods that twist or stretch: one wave goes each way.

   k = omega sqrt(m/D), scale (D k)^-1/2: a span is G <- e^{2ikl} G, theta/2 += kl, and mode n is where
   theta/2 = (n - 1) pi of the two parts together. beta stays free and does nothing. */
#ifndef __clang__
#pragma GCC optimize("schedule-insns") /* as in closed/bent_chain.c */
#endif

#include "closed/chain_lanes.h"

enum { SPAN_NUMBERS = 3, LENGTH = 0, INERTIA, STIFFNESS };
enum { STATION_NUMBERS = 2, MASS = 0, SPRING };

static const double *at_station(const struct rd_chains *chains, const double *number, size_t s)
{
    return number + SPAN_NUMBERS * chains->spans + STATION_NUMBERS * s;
}

static _Bool chain_splits(const struct rd_chains *chains, const double *number, size_t s)
{
    return at_station(chains, number, s)[SPRING] == (double)INFINITY;
}

static _Bool chain_valid(const struct rd_chains *chains, const double *number)
{
    _Bool valid = 1;
    for (size_t j = 0; j < SPAN_NUMBERS * chains->spans; j++)
        valid &= number[j] > 0 && number[j] < (double)INFINITY;
    for (size_t s = 0; s <= chains->spans; s++) {
        const double *here = at_station(chains, number, s);
        valid &=
            here[MASS] >= 0 && here[MASS] < (double)INFINITY && here[SPRING] > -(double)INFINITY;
    }
    return valid;
}

static double chain_guess(const struct rd_chains *chains, const double *number, size_t first,
                          size_t last, double n)
{
    double time = 0;
    (void)chains;
    for (size_t e = first; e < last; e++) {
        const double *span = number + SPAN_NUMBERS * e;
        time += span[LENGTH] * sqrt(span[INERTIA] / span[STIFFNESS]);
    }
    return n * PI / time;
}

static void chain_fill(struct chain_lanes *chain, size_t i, const double *number)
{
    for (size_t e = 0; e < chain->spans; e++) {
        const double *span = number + SPAN_NUMBERS * e;
        chain->load[e][i] = sqrt(span[INERTIA] / span[STIFFNESS]);
    }
}

RD_INLINE _Bool chain_turns_free(const struct chain_lanes *chain, size_t s)
{
    (void)chain;
    (void)s;
    return 1;
}

RD_INLINE struct standing chain_standing(const struct chain_lanes *chain, size_t s)
{
    const lanes *here = chain->number + SPAN_NUMBERS * chain->spans + STATION_NUMBERS * s;
    return (struct standing){here[MASS], l_fill(0), here[SPRING], l_fill(0)};
}

RD_INLINE lanes chain_span(struct chain_lanes *chain, size_t e, lanes omega)
{
    const lanes *span = chain->number + SPAN_NUMBERS * e;
    struct span_waves *w = chain->wave + e;
    const lanes k = omega * chain->load[e];
    const cv none = c_zero();
    w->kl = k * span[LENGTH];
    w->of_z = span[STIFFNESS] * k;
    w->of_beta = l_fill(1);
    const struct l_circle at = l_circle_of(w->kl);
    w->s = at.sin;
    w->c = at.cos;
    w->P = (struct pair){none, none, none};
    w->N = (struct pair){{w->c, w->s}, none, none};
    return w->kl;
}

/* Y is what the left part gives back */
RD_INLINE struct pair chain_pass(struct part *part, const struct span_waves *w, lanes *near)
{
    const struct pair Y = part->G;
    part->G.a = c_mul(part->G.a, c_mul(w->N.a, w->N.a));
    part->K += w->kl;
    *near = l_fill(1);
    return Y;
}

RD_INLINE lanes chain_beyond(const struct meeting *m, const struct chain_place *place)
{
    struct turned less = m->less;
    less.eighths += 8.0 * place->turns + l_select(place->odd, l_fill(0), l_fill(4));
    return l_less_angle(m->K, less);
}

/* theta/2 moves by half of what theta does, as with a wave of half the size */
RD_INLINE struct duo chain_wave(const struct meeting *m, const struct chain_place *place)
{
    (void)m;
    (void)place;
    return (struct duo){c_real(0.70710678118654752440), c_zero()};
}

RD_INLINE lanes chain_split(const struct meeting *m)
{
    (void)m;
    return l_fill(1);
}

RD_INLINE void chain_station_slopes(lanes *slope, lanes of_z, lanes of_beta, lanes square)
{
    (void)of_beta;
    slope[SPRING] += of_z;
    slope[MASS] -= square * of_z;
}

RD_INLINE void chain_span_slopes(struct chain_lanes *chain, size_t e, struct chain_slope *sum)
{
    const lanes *span = chain->number + SPAN_NUMBERS * e;
    const struct span_waves *w = chain->wave + e;
    lanes *slope = chain->slope + SPAN_NUMBERS * e;
    const cv right = chain->in[0][e].z, left = chain->in[1][e].z;
    const lanes size = c_square(right) + c_square(left), along = w->kl * size;
    const lanes work = -w->s * (left.re * right.re + left.im * right.im);
    const lanes of_k = along - 2.0 * work;
    slope[LENGTH] = along / span[LENGTH];
    slope[INERTIA] = 0.5 * of_k / span[INERTIA];
    slope[STIFFNESS] = -(0.5 * of_k + 2.0 * work) / span[STIFFNESS];
    sum->of_omega += of_k;
    sum->noise += 12.0 * size + 4.0 * along + 4.0 * l_abs(work);
}

#include "closed/chain_roots.h"
#include "closed/chain_walk.h"

void rd_plain_chain_modes(const struct rd_chains *chains, size_t first, size_t last,
                          const struct rd_closed_modes *modes, const struct rd_workspace *workspace)
{
    chain_modes(chains, rd_plain_numbers(chains->spans), first, last, modes, *workspace);
}

void rd_plain_chain_count(const struct rd_chains *chains, size_t first, size_t last, double omega,
                          int64_t *count, const struct rd_workspace *workspace)
{
    chain_count(chains, rd_plain_numbers(chains->spans), first, last, omega, count, *workspace);
}
