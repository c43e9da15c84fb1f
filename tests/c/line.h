/* A uniform line for tests, its runs and one call of the sweep in memory of exactly its size. */
#ifndef LINE_H
#define LINE_H

#include "base/complex.h"
#include "chain/runs.h"
#include "sweep/sweep.h"

enum { LINE_NODES = 512, LINE_POINTS = 40 };

struct line {
    struct rd_chain chain;
    struct rd_runs runs;
    struct rd_run run[LINE_NODES];
    int32_t coordinate[2], first[LINE_NODES], element[LINE_NODES], term[LINE_NODES];
    int32_t term_of[LINE_NODES]; /* the stretches follow from it */
    double length[1], tension[1], flexibility[9];
    double inertia[2]; /* of continuous elements */
    double drag[2];    /* of continuous elements */
    double mass[5 * 4], stiffness[5 * 4], damping[5 * 4], hinge[5 * 2];
    uint8_t held[5 * 2];
};

/* node terms: both ends, inner nodes, and two free ones for the test */
enum { LEFT, INNER, RIGHT, FIRST, SECOND };

/* width 1 (z) or 2 (z, beta), elements of length L/elements, linear density mu, ends as held in z
   and, at width 2, in beta; L = 1 m */
void line_make(struct line *line, enum rd_kind kind, size_t width, size_t elements, double T,
               double B, double mu, int hold_beta);

/* finds the runs; call it after the last change */
void line_find(struct line *line);

/* z at `response` per force in z at `drive` at omega (count); nothing but dashpots and drag is
   damped */
enum rd_status line_frf(const struct line *line, int32_t drive, int32_t response,
                        const double *omega, size_t count, double complex *value, double *error);

/* the same with `less` bytes too few */
enum rd_status line_frf_less(const struct line *line, int32_t drive, int32_t response,
                             const double *omega, size_t count, double complex *value,
                             double *error, size_t less, size_t *failed);

#endif
