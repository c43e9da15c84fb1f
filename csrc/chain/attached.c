/* Structures that nodes carry, condensed to their foot. */
#include "chain/attached.h"

#include "base/complex_step.h"
#include "base/krylov.h"

#include <math.h>
#include <string.h>

/* in place of an exact zero of e: what is divided by it is multiplied by it elsewhere */
static const double NO_GAP = 1e-20;

/* w e y^2 - 2 w y v^T u + u^T diag(rest) u, u being the motion of the foot */
static double _Complex form_of(const struct rd_foot *foot, const double *moved, double y)
{
    const double _Complex along = foot->lever[0] * moved[0] + foot->lever[1] * moved[1];
    return foot->weight * y * (foot->gap * y - 2 * along) + foot->rest[0] * moved[0] * moved[0] +
           foot->rest[1] * moved[1] * moved[1];
}

/* A mass m on a spring k and a dashpot c: k'/k y is its motion, k' = k + s c,
       D = -lambda m k'/(k' - lambda m),
   which is -w/e with w = lambda m k'/k and e = (k' - lambda m)/k. value: m, k, unused, c */
static void fill_resonator(const double *value, double _Complex inertia, double _Complex dashpot,
                           struct rd_foot *foot)
{
    const double _Complex force = inertia * value[0], drag = dashpot * value[3];
    const double _Complex stiff = 1 + drag / value[1];
    *foot = (struct rd_foot){
        .weight = -force * stiff,
        .gap = 1 + (force + drag) / value[1],
        .lever = {1},
        .tip = {stiff},
    };
    foot->held = creal(foot->gap) < 0;
}

static double highest_of_resonator(const double *value)
{
    return value[1] / value[0];
}

/* k times the square of what the spring is longer by, lambda m y/k */
static double stiffer_resonator(const double *value, double lambda, const double *moved, double y)
{
    const double force = lambda * value[0] * y;
    (void)moved;
    return force * (force / value[1]);
}

/* The roots of 1 + cos x cosh x below x, one in each ((n - 1) pi, n pi): e is positive behind the
   even ones. */
static double roots_below(double x, double gap)
{
    const double pi = 3.14159265358979323846;
    const double n = floor(x / pi);
    return n + ((gap >= 0) != (fmod(n, 2) == 0));
}

/* A slender cantilever with a free tip, E I u'''' = lambda rho A u, of mass m and k = E I/l^3: with
   q = lambda m/k = x^4 and Krylov's functions c_j of -4 q (base/krylov.h), e = (1 + c_0)/2,

       D_zz = -lambda m c_1/e,  D_z,beta = -lambda m l c_2/e,  D_beta,beta = -2 lambda m l^2 c_3/e
       det D = 2 (lambda m l)^2 c_4/e

   taken apart by the larger of the two diagonal entries, so that neither part has a zero of the pivot.
   Its damping ratio z makes the modulus E (1 + 2 i z), in every mode the same, where anything moves in
   time. value: m, k, l, z */
static void fill_wire(const double *value, double _Complex inertia, double _Complex dashpot,
                      struct rd_foot *foot)
{
    const double l = value[2], turn = dashpot == 0 ? 0 : 2 * value[3];
    const double _Complex stiff = value[1] * CMPLX(1, turn);
    const double _Complex pull = -inertia * value[0], q = pull / stiff;
    const double _Complex growth = rd_krylov_growth(-4 * q);
    const struct rd_krylov f = rd_krylov(-4 * q, growth), tip = rd_krylov(q, growth);
    *foot = (struct rd_foot){
        .growth = growth,
        .gap = (f.one + f.c[0]) / 2,
        .tip = {tip.c[0], l * tip.c[1]},
    };
    if (cabs(f.c[1]) >= 2 * cabs(f.c[3])) {
        foot->weight = pull * f.c[1];
        foot->lever[0] = 1;
        foot->lever[1] = l * f.c[2] / f.c[1];
        foot->rest[1] = -2 * l * l * pull * f.c[4] / f.c[1];
    } else {
        foot->weight = 2 * pull * f.c[3];
        foot->lever[0] = f.c[2] / (2 * f.c[3]);
        foot->lever[1] = l;
        foot->rest[0] = -pull * f.c[4] / f.c[3];
    }
    foot->held = creal(q) > 0 ? roots_below(sqrt(sqrt(creal(q))), creal(foot->gap)) : 0;
}

static double highest_of_wire(const double *value)
{
    (void)value;
    return INFINITY;
}

/* by a step in the modulus E (1 + 2 i z) */
static double stiffer_wire(const double *value, double lambda, const double *moved, double y)
{
    const double stepped[RD_ATTACHED_VALUES] = {value[0], value[1], value[2], RD_COMPLEX_STEP / 2};
    struct rd_foot foot;
    fill_wire(stepped, -lambda, I, &foot);
    return cimag(form_of(&foot, moved, y)) / RD_COMPLEX_STEP;
}

const struct rd_attached rd_attached_of[RD_ATTACHED_KINDS] = {
    [RD_RESONATOR] = {fill_resonator, highest_of_resonator, stiffer_resonator},
    [RD_WIRE] = {fill_wire, highest_of_wire, stiffer_wire},
};

void rd_attached_fill(const struct rd_chain *chain, size_t k, double _Complex inertia,
                      double _Complex dashpot, struct rd_foot *foot)
{
    const double *value = chain->attached_value + k * RD_ATTACHED_VALUES;
    rd_attached_of[chain->attached_kind[k]].fill(value, inertia, dashpot, foot);
    /* an imaginary part may be a step */
    if (creal(foot->gap) == 0 && fabs(cimag(foot->gap)) < NO_GAP)
        foot->gap += NO_GAP;
}

double rd_attached_highest(const struct rd_chain *chain)
{
    double most = 0;
    for (size_t k = 0; k < chain->attached; k++)
        most = fmax(most, rd_attached_of[chain->attached_kind[k]].highest(chain->attached_value +
                                                                          k * RD_ATTACHED_VALUES));
    return most;
}

void rd_attached_row(const struct rd_chain *chain, size_t k, const double _Complex *x,
                     double _Complex *row)
{
    const double *of = chain->attached_row + k * 2 * chain->width;
    for (size_t i = 0; i < chain->width; i++)
        row[i] = x[0] * of[i] + x[1] * of[chain->width + i];
}

void rd_attached_add(const struct rd_chain *chain, size_t term, double _Complex inertia,
                     double _Complex dashpot, double _Complex *D)
{
    const size_t w = chain->width;
    for (size_t k = rd_attached_first(chain, term); rd_attached_is_of(chain, k, (int32_t)term);
         k++) {
        const double *row = chain->attached_row + k * 2 * w;
        struct rd_foot foot;
        double _Complex v[RD_WIDTH_MAX];
        rd_attached_fill(chain, k, inertia, dashpot, &foot);
        rd_attached_row(chain, k, foot.lever, v);
        for (size_t i = 0; i < w; i++)
            for (size_t j = 0; j < w; j++)
                D[i * w + j] += foot.rest[0] * row[i] * row[j] +
                                foot.rest[1] * row[w + i] * row[w + j] -
                                foot.weight / foot.gap * v[i] * v[j];
    }
}

void rd_attached_tip(const struct rd_chain *chain, size_t k, double _Complex inertia,
                     double _Complex dashpot, double _Complex *row)
{
    struct rd_foot foot;
    rd_attached_fill(chain, k, inertia, dashpot, &foot);
    const double _Complex tip[2] = {foot.tip[0] / foot.gap, foot.tip[1] / foot.gap};
    rd_attached_row(chain, k, tip, row);
}

/* displacement and rotation of the foot with the motion u (width) of the node */
static void move_foot(const struct rd_chain *chain, size_t k, const double *u, double *moved)
{
    const double *row = chain->attached_row + k * 2 * chain->width;
    moved[0] = moved[1] = 0;
    for (size_t i = 0; i < 2 * chain->width; i++)
        moved[i / chain->width] += row[i] * u[i % chain->width];
}

/* The form being stationary in y, twice the kinetic energy over lambda is -d/dlambda of it, the
   strain energy what is left, and its change with a small damping that of the whole. */
static void add_energy(const struct rd_chain *chain, size_t k, double lambda, const double *u,
                       double y, double *energy)
{
    const double *given = chain->attached_value + k * RD_ATTACHED_VALUES;
    const struct rd_attached *kind = rd_attached_of + chain->attached_kind[k];
    double value[RD_ATTACHED_VALUES], moved[2];
    struct rd_foot foot;
    move_foot(chain, k, u, moved);
    rd_attached_fill(chain, k, CMPLX(-lambda, -RD_COMPLEX_STEP), 0, &foot);
    const double _Complex form = form_of(&foot, moved, y);
    const double kinetic = -cimag(form) / RD_COMPLEX_STEP;
    energy[RD_CARRIED_KINETIC] += kinetic;
    energy[RD_CARRIED_STRAIN] += creal(form) + lambda * kinetic;
    if (!(lambda > 0))
        return;
    memcpy(value, given, sizeof value);
    value[RD_ATTACHED_VALUES - 1] *= RD_COMPLEX_STEP;
    kind->fill(value, -lambda, CMPLX(0, sqrt(lambda)), &foot);
    energy[RD_CARRIED_LOST] += cimag(form_of(&foot, moved, y)) / RD_COMPLEX_STEP;
}

void rd_attached_energy(const struct rd_chain *chain, double lambda, const double *shape,
                        const double *y, double *energy)
{
    memset(energy, 0, RD_CARRIED * sizeof *energy);
    for (size_t s = 0; s < chain->stretches; s++) {
        const int32_t term = chain->term[s];
        const double *u = shape + (size_t)chain->first[s] * chain->width;
        for (size_t k = rd_attached_first(chain, (size_t)term); rd_attached_is_of(chain, k, term);
             k++)
            add_energy(chain, k, lambda, u, y[k], energy);
    }
}

/* The form at fixed u and y by m, which lambda multiplies, by k and by the motion of the foot. */
static void fill_slope(const struct rd_chain *chain, size_t k, double lambda, const double *u,
                       double y, double *number, double *row)
{
    const struct rd_attached *kind = rd_attached_of + chain->attached_kind[k];
    double moved[2];
    struct rd_foot foot;
    move_foot(chain, k, u, moved);
    rd_attached_fill(chain, k, CMPLX(-lambda, -RD_COMPLEX_STEP), 0, &foot);
    number[RD_CARRIED_OF_MASS] = -cimag(form_of(&foot, moved, y)) / RD_COMPLEX_STEP;
    number[RD_CARRIED_OF_STIFFNESS] =
        kind->stiffer(chain->attached_value + k * RD_ATTACHED_VALUES, lambda, moved, y);
    for (size_t i = 0; i < 2 * chain->width; i++) {
        const size_t line = i / chain->width;
        const double force =
            creal(foot.rest[line]) * moved[line] - creal(foot.weight) * y * creal(foot.lever[line]);
        row[i] = 2 * force * u[i % chain->width];
    }
}

void rd_attached_slopes(const struct rd_chain *chain, double lambda, const double *shape,
                        const double *y, double *number, double *row)
{
    memset(number, 0, chain->attached * RD_CARRIED_NUMBERS * sizeof *number);
    memset(row, 0, chain->attached * 2 * chain->width * sizeof *row);
    for (size_t s = 0; s < chain->stretches; s++) {
        const int32_t term = chain->term[s];
        const double *u = shape + (size_t)chain->first[s] * chain->width;
        for (size_t k = rd_attached_first(chain, (size_t)term); rd_attached_is_of(chain, k, term);
             k++)
            fill_slope(chain, k, lambda, u, y[k], number + k * RD_CARRIED_NUMBERS,
                       row + k * 2 * chain->width);
    }
}

void rd_attached_inertia(const struct rd_chain *chain, size_t term, double *M)
{
    double _Complex D[RD_WIDTH_MAX * RD_WIDTH_MAX] = {0};
    rd_attached_add(chain, term, CMPLX(0, RD_COMPLEX_STEP), 0, D);
    for (size_t i = 0; i < chain->width * chain->width; i++)
        M[i] += cimag(D[i]) / RD_COMPLEX_STEP;
}
