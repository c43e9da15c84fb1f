/* The sweep's inner operations, one table of them per width. */
#ifndef RD_SWEEP_KERNEL_H
#define RD_SWEEP_KERNEL_H

#include "base/lanes.h"
#include "chain/attached.h"
#include "chain/elements.h"
#include "element/shape.h"
#include "element/strut.h"
#include "span/compound.h"
#include "span/rate_matrix.h"

enum {
    RD_PLAIN = 9,   /* complex lanes of an element in a walk without rows */
    RD_MINORS = 14, /* numbers of the plane behind such a walk, at most */
};

/* what a node term needs besides adding masses */
enum rd_trait {
    RD_COUPLED = 1,  /* a coordinate is held or two are coupled */
    RD_SPRUNG = 2,   /* it has stiffness */
    RD_HINGED = 4,   /* a hinge on its right */
    RD_SKEW = 8,     /* its mass couples z and beta, far from an eccentric one */
    RD_CARRIES = 16, /* structures, see chain/attached.h; with RD_COUPLED */
    RD_MASSIVE = 32, /* it has mass */
    RD_DASHED = 64,  /* it has damping */
    RD_FIXED = 128,  /* all coordinates are held; with RD_COUPLED */
};

enum { RD_PAIRS_MAX = RD_WIDTH_MAX * (RD_WIDTH_MAX + 1) / 2 };

/* What RD_LANES frequencies share with every element: scales and complex factors. */
struct sweep_block {
    int bends;                  /* the chain has bending: z, beta and F_z,beta exist */
    int channel[RD_WIDTH_MAX];  /* enum rd_channel of each coordinate */
    int arm[RD_WIDTH_MAX];      /* 1 for z in bending */
    lanes z[RD_WIDTH_MAX];      /* scale of each coordinate: u = z u^, f = f^/z */
    lanes ratio[RD_WIDTH_MAX];  /* z_beta/z_i */
    cv flex[RD_PAIRS_MAX];      /* 1/(section z_i z_j) */
    struct shape_series series; /* of phi = tension/section */
    cv pull;                    /* tension z_beta^2 */
    cv slack;                   /* 1/(tension z_z^2) */
    cv soft, tension;           /* 1/section and the factor on tension themselves */
    cv spring, inertia;         /* factors of node stiffness and mass */
    cv dashpot;                 /* of node damping, 0 where the chain has none */
    int real;                   /* spring and inertia are */
    lane_mask undamped;         /* nothing takes energy away */
    lane_mask waves;            /* nor adds any: inertia <= 0 too */
};

/* What depends on the direction of the walk as well: backward all is seen with u -> D u. */
struct sweep_way {
    int backward;
    double sign[RD_WIDTH_MAX]; /* D */
    cv spring[RD_PAIRS_MAX];   /* factor z_i z_j D_i D_j */
    cv inertia[RD_PAIRS_MAX];
    cv dashpot[RD_PAIRS_MAX]; /* filled where the chain has damping */
};

/* rd_foot (chain/attached.h) of RD_LANES frequencies, seen by the motion of its node */
struct sweep_foot {
    cv weight, gap, rest[2];
    cv lever[RD_WIDTH_MAX];
    cv phase; /* common factor left out of weight and gap: phase e^growth */
    lanes growth;
    int rests[2];            /* rest is not zero in every lane */
    int moves[RD_WIDTH_MAX]; /* nor is lever */
};

struct sweep_walk {
    const struct rd_chain *chain;
    const struct sweep_block *block;
    const struct sweep_way *way;
    const uint8_t *trait;          /* (terms) enum rd_trait */
    cv *coefficients;              /* of each distinct element, or NULL: made on the way */
    cv *plain;                     /* (distinct, RD_PLAIN) the same for a walk without rows */
    struct sweep_made *made;       /* which of these there are */
    const struct sweep_foot *foot; /* (attached) */
};

/* bits of distinct elements */
struct sweep_made {
    uint64_t coefficients, plain;
};

/* whether an element's bit was not set, which it is then */
RD_INLINE int sweep_is_first(uint64_t *made, int32_t e)
{
    const uint64_t before = *made;
    *made |= (uint64_t)1 << e;
    return before != *made;
}

/* A rigid element under so much compression is a string beside an element without it: below
   T S_bb l^2 = -1, a third of the critical load of its cantilever, which the chain does not know.
   Elements so long are never joined, and tensed ones never so long. */
static inline bool sweep_is_strut(const struct rd_chain *chain, size_t e)
{
    if (chain->kind != RD_RIGID || !(chain->tension[e] < 0))
        return false;
    const struct rd_element element = rd_chain_element(chain, e);
    return rd_element_is_strut(&element);
}

/* The part behind the walk: u = U s, f = i (I - U) s, and responses in it as rows over s. */
struct sweep_state {
    cv U[RD_PAIRS_MAX];
    lanes A
        [RD_PAIRS_MAX]; /* sizes of what the last step added to: U may be a small difference of it */
    size_t stretch;     /* of the node ahead */
    int absorbed;       /* the node ahead is part of U already */
    size_t rows;        /* of E that are under way */
    cv *E;              /* (rows, width), inside E_all: a port's row, its companion, .. */
    cv *E_all;          /* (all carried ports, 2, width) */
    int flat;           /* minors say what is behind the walk, and not U */
    cv minors[RD_MINORS]; /* of sweep/kernel/plane.h, as complex or as real numbers */
};

/* the largest of some sizes */
RD_INLINE lanes sweep_most(const cv *x, int count)
{
    lanes most = {0};
    for (int j = 0; j < count; j++) {
        const lanes size = c_size(x[j]);
        most = l_select(size > most, size, most);
    }
    return most;
}

/* An error of a row of so many eps in every coordinate is added to its companion: m times 1, -1, i,
   -i, signs that do not cancel where the terms of E s do. */
RD_INLINE void sweep_disturb(lanes most, int width, cv *companion)
{
    for (int j = 0; j < width; j++) {
        const lanes m = j % 2 ? -most : most;
        companion[j] = c_add(companion[j], j < 2 ? (cv){m, (lanes){0}} : (cv){(lanes){0}, m});
    }
}

/* Rounding moves a row E by eps of its largest entry. */
RD_INLINE void sweep_accompany(const cv *E, int width, cv *companion)
{
    sweep_disturb(sweep_most(E, width), width, companion);
}

/* a span by 2^(joins + doublings) parts: joined below their first cantilever resonance, then doubled */
struct sweep_cut {
    int joins, doublings, terms; /* terms: of the series of a part */
};

struct sweep_kernel {
    void (*make_element)(const struct rd_chain *, const struct sweep_block *, size_t e, cv *triple);
    void (*make_slice)(const struct rd_chain *, const struct sweep_block *, size_t e, int halvings,
                       int terms, cv *triple);
    void (*make_rate)(const struct rd_chain *, const struct sweep_block *, size_t e,
                      struct rate_matrix *);
    void (*make_span)(const struct rate_matrix *, double length, int halvings, int terms,
                      cv *triple);
    void (*make_whole)(const struct rd_chain *, const struct sweep_block *, size_t e, double length,
                       cv *coef, lanes *radians);
    void (*make_coupled)(const struct rd_chain *, const struct sweep_block *, size_t e,
                         const struct sweep_cut *, cv *coef, lanes *steps);
    void (*make_coefficients)(const cv *triple, cv *coef);
    /* those of two equal pieces with a node term (negative: none) between them */
    void (*twice)(const struct rd_chain *, const struct sweep_way *, int32_t term, const cv *half,
                  cv *whole);
    void (*make_single)(const struct rd_chain *, const struct sweep_block *, size_t e, cv *coef);
    /* these of complex numbers, and of real ones where nothing is damped; minors from U and U from
       minors, and a walk by them */
    void (*flatten[2])(const struct sweep_block *, struct sweep_state *);
    void (*scatter[2])(const struct sweep_block *, struct sweep_state *);
    void (*walk_plain[2])(const struct sweep_walk *, size_t node, size_t count,
                          struct sweep_state *);
    void (*join[2])(const struct rd_chain *, const struct sweep_way *, int32_t term, const cv *one,
                    const cv *two, cv *joined);
    /* by real minors: across a node, equal pieces and a whole span, in which nothing is damped */
    void (*walk_node)(const struct sweep_walk *, size_t term, struct sweep_state *);
    void (*walk_triples)(const struct sweep_walk *, const cv *triple, int32_t term, size_t count,
                         struct sweep_state *);
    void (*make_compound)(const struct rd_chain *, const struct sweep_block *, size_t e,
                          double length, struct bent_compound *);
    void (*walk_compound)(const struct bent_compound *, struct sweep_state *);
    void (*walk)(const struct sweep_walk *, size_t node, size_t count, struct sweep_state *);
    void (*walk_pieces)(const struct sweep_walk *, const cv *piece, int32_t term, size_t count,
                        struct sweep_state *);
    void (*absorb)(const struct sweep_walk *, size_t term, struct sweep_state *);
    void (*open)(const struct sweep_walk *, size_t term, struct sweep_state *);
    void (*listen)(const struct sweep_walk *, const double *motion, const double *force,
                   const struct sweep_state *, cv *row);
    void (*meet)(const struct sweep_walk *, const double *motion, const double *force,
                 const cv *left, const struct sweep_state *right, size_t rows, cv *value,
                 lanes *error, lanes *singular);
};

extern const struct sweep_kernel rd_sweep_kernel_1, rd_sweep_kernel_2, rd_sweep_kernel_3,
    rd_sweep_kernel_4;

#endif
