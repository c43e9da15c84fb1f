/* Chains as lanes: where their numbers, sections and parts are while modes are looked for.

   A station that holds all that meets there splits a chain: its sections are chains of their own,
   and a lane has one of them, from station `first` to `last`. */
#ifndef RD_CHAIN_LANES_H
#define RD_CHAIN_LANES_H

#include "base/workspace.h"
#include "closed/chains.h"
#include "closed/rope_lanes.h"
#include "closed/scattering.h"

struct chain_lanes {
    size_t spans, numbers;
    const uint8_t *hinge;
    _Bool split; /* not every lane has the whole chain */
    lane_mask first, last;
    lanes *number; /* (numbers), as given */
    lanes *load;   /* (spans) sqrt(mu/B) */
    lanes *pull;   /* (spans) T/2B */
    struct span_waves *wave;
    struct part *left;          /* (spans + 1) at the right face of the span before a station */
    struct station *station[2]; /* (spans + 1) on the way from the left and from the right */
    struct pair *Y[2];          /* (spans) likewise */
    lanes *near[2];             /* (spans) likewise */
    struct duo *in[2];          /* (spans) what goes in at the right and at the left face */
    lanes *slope;               /* (numbers) */
};

/* what is to be known of a mode in a lane */
struct chain_place {
    lane_mask odd;
    lanes turns;    /* floor((n - 1)/2) */
    lane_mask wide; /* meets where the chain moves most, not at its right end */
};

/* of the phase that passes 0 at a mode */
struct chain_slope {
    lanes beyond;
    lanes of_omega; /* by ln omega */
    lanes noise;    /* in eps */
    lanes split;    /* how far the other phase is, as a sine */
};

RD_INLINE struct duo duo_add(struct duo a, struct duo b)
{
    return (struct duo){c_add(a.z, b.z), c_add(a.beta, b.beta)};
}

RD_INLINE struct duo duo_where(lane_mask m, struct duo x)
{
    const struct duo none = {c_zero(), c_zero()};
    put_where(~m, &x, &none, sizeof x);
    return x;
}

#endif
