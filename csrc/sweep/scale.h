/* The characteristic receptances that scale a sweep, and how long its pieces may be. */
#ifndef RD_SWEEP_SCALE_H
#define RD_SWEEP_SCALE_H

#include "chain/runs.h"
#include "graded/between.h"
#include "sweep/kernel/kernel.h"

/* The five complex factors of each frequency, real and imaginary part side by side. */
struct rd_factors {
    size_t count;
    const double *section; /* (count, 2)  S/section */
    const double *tension; /* (count, 2)  T tension */
    const double *spring;  /* (count, 2)  node stiffness times it */
    const double *inertia; /* (count, 2)  node mass times it: -omega^2 [1/s^2] */
    const double *dashpot; /* (count, 2)  node damping times it: i omega [1/s]; read where the chain
                                          has any */
    const struct rd_between *between; /* what is known of elements whose tension grows, or NULL */
};

/* sizes of the factors of a frequency, for the length of pieces */
struct sweep_extent {
    double section, tension, spring, inertia, dashpot; /* 1/|section|, |others| */
};

struct sweep_extent rd_sweep_extent(const struct rd_factors *factors, size_t i);

struct rd_sizes rd_sweep_sizes(const struct sweep_extent *extent);

/* the largest of each of `count` extents, whose waves are no longer than any of theirs */
struct sweep_extent rd_sweep_most(const struct sweep_extent *extent, size_t count);

/* z (width): roots of the receptances that scale all coordinates of a sweep, u = z u^, f = f^/z
   [sqrt(m/N), sqrt(1/(N m))] */
void rd_sweep_receptance(const struct rd_chain *chain, const struct rd_runs *runs,
                         const struct sweep_extent *x, double *z);

/* Fills the block and both ways (forward, backward) for the frequencies index[0 .. RD_LANES - 1]
   of the factors, of sizes extent (RD_LANES). A lane depends on its own frequency alone. */
void rd_sweep_scale(const struct rd_chain *chain, const struct rd_runs *runs,
                    const struct rd_factors *factors, const size_t *index,
                    const struct sweep_extent *extent, struct sweep_block *block,
                    struct sweep_way *way);

/* How a run is crossed: by pieces of 2^level first pieces, below their first cantilever resonance.
   A first piece is an element, or one of the 2^halvings parts of a continuous one. */
struct sweep_pieces {
    int halvings;
    size_t count, level; /* first pieces in all; 2^level <= count */
    double radians;      /* of a continuous first piece */
};

/* the largest wavenumber of a run, and of a continuous one that with evanescent waves [1/m] */
struct sweep_waves {
    double propagating, all;
};

struct sweep_waves rd_sweep_waves(const struct rd_chain *chain, const struct rd_run *run,
                                  const struct sweep_extent *extent);

struct sweep_pieces rd_sweep_pieces(const struct rd_chain *chain, const struct rd_run *run,
                                    size_t count, struct sweep_waves waves);

/* steps of a walk through all of the chain, runs by pieces */
size_t rd_sweep_steps(const struct rd_chain *chain, const struct sweep_extent *extent);

/* How far the waves of one coordinate turn from end to end, and more [rad]: what stands between
   continuous elements turns them by half a wave. */
double rd_sweep_turning(const struct rd_chain *chain, const struct sweep_extent *extent);

#endif
