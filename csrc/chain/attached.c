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
   which is -w/e with w = lambda m k'/k and e = (k' - lambda m)/k, exactly 0 at its own lambda_0 = k/m
   where nothing damps it. value: m, k, lambda_0, c */
static void fill_resonator(const double *value, double _Complex inertia, double _Complex dashpot,
                           struct rd_foot *foot)
{
    const double _Complex force = inertia * value[0], drag = dashpot * value[3];
    const double _Complex stiff = 1 + drag / value[1];
    *foot = (struct rd_foot){
        .weight = -force * stiff,
        .gap = (value[2] + inertia) / value[2] + drag / value[1],
        .lever = {1},
        .tip = {stiff},
    };
    foot->held = creal(foot->gap) < 0;
}

static double highest_of_resonator(const double *value)
{
    return value[2];
}

/* e y y' - y v^T u' - y' v^T u */
static double _Complex bracket(double _Complex e, const double _Complex *v,
                               const struct rd_foot_pair *pair)
{
    const double _Complex *u = pair->moved[0], *other = pair->moved[1], *y = pair->y;
    return e * y[0] * y[1] - y[0] * (v[0] * other[0] + v[1] * other[1]) -
           y[1] * (v[0] * u[0] + v[1] * u[1]);
}

/* w = -mu k'/k and e = (k' + mu)/k, mu = inertia m: by mu at fixed u and y, which errors of y change
   by their square only, and by k' the square (mu/k)^2 y y' of what the spring is longer by;
   k' = k + s c, the dashpot c = 2 zeta sqrt(k m) of the damping ratio */
static void slopes_of_resonator(const double *value, double _Complex inertia,
                                double _Complex dashpot, const struct rd_foot_pair *pair,
                                double _Complex *number)
{
    const double m = value[0], k = value[1];
    const double _Complex product = pair->y[0] * pair->y[1];
    const double _Complex drag = dashpot * value[3], stiff = 1 + drag / k;
    const double _Complex force = inertia * m / k, by_stiff = force * force * product;
    const double _Complex lever[2] = {1};
    number[RD_CARRIED_OF_MASS] =
        -m * stiff * (bracket(stiff + force, lever, pair) + force * product);
    number[RD_CARRIED_OF_STIFFNESS] = by_stiff * (k + drag / 2);
    number[RD_CARRIED_OF_DAMPING] = by_stiff * (2 * sqrt(k) * sqrt(m) * dashpot);
    number[RD_CARRIED_OF_MASS_DAMPED] = by_stiff * drag / 2;
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

/* fill_wire's w = Lambda W, e, v and rest = Lambda R, functions of z = -4 q alone but for Lambda */
struct wire_form {
    double _Complex w, e, v[2], rest[2];
};

static double _Complex at_rest(const double _Complex *rest, const struct rd_foot_pair *pair)
{
    return rest[0] * pair->moved[0][0] * pair->moved[1][0] +
           rest[1] * pair->moved[0][1] * pair->moved[1][1];
}

/* fill_wire's two parts and z d/dz of them */
static void form_of_wire(const struct rd_krylov *f, const struct rd_krylov *slope,
                         double _Complex z, double l, struct wire_form *X, struct wire_form *dX)
{
    const double _Complex *c = f->c;
    double _Complex d[5];
    for (int j = 0; j < 5; j++)
        d[j] = z * slope->c[j];
    *X = (struct wire_form){.e = (f->one + c[0]) / 2};
    *dX = (struct wire_form){.e = d[0] / 2};
    if (cabs(c[1]) >= 2 * cabs(c[3])) {
        X->w = c[1];
        dX->w = d[1];
        X->v[0] = 1;
        X->v[1] = l * c[2] / c[1];
        dX->v[1] = l * (d[2] - c[2] / c[1] * d[1]) / c[1];
        X->rest[1] = -2 * l * l * c[4] / c[1];
        dX->rest[1] = -2 * l * l * (d[4] - c[4] / c[1] * d[1]) / c[1];
    } else {
        X->w = 2 * c[3];
        dX->w = 2 * d[3];
        X->v[0] = c[2] / (2 * c[3]);
        dX->v[0] = (d[2] - c[2] / c[3] * d[3]) / (2 * c[3]);
        X->v[1] = l;
        X->rest[0] = -c[4] / c[3];
        dX->rest[0] = -(d[4] - c[4] / c[3] * d[3]) / c[3];
    }
}

/* Lambda = -inertia m and z = -4 Lambda/k': Lambda d/dLambda (Lambda X) = Lambda (X + z X') and
   k' d/dk' (Lambda X) = -Lambda z X'; k' = k (1 + 2 i zeta) */
static void slopes_of_wire(const double *value, double _Complex inertia, double _Complex dashpot,
                           const struct rd_foot_pair *pair, double _Complex *number)
{
    const double turn = dashpot == 0 ? 0 : 2 * value[3];
    const double _Complex stiff = CMPLX(1, turn), pull = -inertia * value[0];
    const double _Complex z = -4 * (pull / (value[1] * stiff)), growth = rd_krylov_growth(z);
    const struct rd_krylov f = rd_krylov(z, growth), slope = rd_krylov_slope(z, growth);
    struct wire_form X, dX;
    form_of_wire(&f, &slope, z, value[2], &X, &dX);
    const double _Complex own = bracket(X.e, X.v, pair);
    const double _Complex all = X.w * own + at_rest(X.rest, pair);
    const double _Complex changed =
        dX.w * own + X.w * bracket(dX.e, dX.v, pair) + at_rest(dX.rest, pair);
    number[RD_CARRIED_OF_MASS] = -value[0] * (all + changed);
    number[RD_CARRIED_OF_STIFFNESS] = -pull * changed;
    number[RD_CARRIED_OF_DAMPING] = dashpot == 0 ? 0 : -pull * changed * (2 * I / stiff);
    number[RD_CARRIED_OF_MASS_DAMPED] = 0;
}

const struct rd_attached rd_attached_of[RD_ATTACHED_KINDS] = {
    [RD_RESONATOR] = {fill_resonator, highest_of_resonator, slopes_of_resonator},
    [RD_WIRE] = {fill_wire, highest_of_wire, slopes_of_wire},
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

size_t rd_attached_node(const struct rd_chain *chain, size_t k)
{
    size_t s = 0;
    while (s < chain->stretches && chain->term[s] != chain->attached_term[k])
        s++;
    return s < chain->stretches ? (size_t)chain->first[s] : chain->nodes;
}

/* moved (2) <- motion of the foot with the motion u (width) of the node, pull (2) <- how it resists;
   *y, or what the motion makes of it, is returned */
static double _Complex pull_foot(const struct rd_chain *chain, size_t k, const struct rd_foot *foot,
                                 const double _Complex *u, const double _Complex *y,
                                 double _Complex *moved, double _Complex *pull)
{
    const size_t w = chain->width;
    const double *of = chain->attached_row + k * 2 * w;
    moved[0] = moved[1] = 0;
    for (size_t i = 0; i < 2 * w; i++)
        moved[i / w] += of[i] * u[i % w];
    const double _Complex along = foot->lever[0] * moved[0] + foot->lever[1] * moved[1];
    const double _Complex own = y ? *y : along / foot->gap;
    for (size_t line = 0; line < 2; line++)
        pull[line] = foot->rest[line] * moved[line] - foot->weight * own * foot->lever[line];
    return own;
}

void rd_attached_pull(const struct rd_chain *chain, size_t k, double _Complex inertia,
                      double _Complex dashpot, const double _Complex *u, const double _Complex *y,
                      double _Complex *force)
{
    struct rd_foot foot;
    double _Complex moved[2], pull[2], row[RD_WIDTH_MAX];
    rd_attached_fill(chain, k, inertia, dashpot, &foot);
    pull_foot(chain, k, &foot, u, y, moved, pull);
    rd_attached_row(chain, k, pull, row);
    for (size_t i = 0; i < chain->width; i++)
        force[i] += row[i];
}

void rd_attached_slopes(const struct rd_chain *chain, size_t k, double _Complex inertia,
                        double _Complex dashpot, const double _Complex *a, const double _Complex *b,
                        const double _Complex *y, double _Complex *number, double _Complex *row)
{
    const double *value = chain->attached_value + k * RD_ATTACHED_VALUES;
    const double _Complex *const u[2] = {a, b};
    const size_t w = chain->width;
    double _Complex pull[2][2];
    struct rd_foot_pair pair;
    struct rd_foot foot;
    rd_attached_fill(chain, k, inertia, dashpot, &foot);
    for (size_t n = 0; n < 2; n++)
        pair.y[n] = pull_foot(chain, k, &foot, u[n], y ? y + n : NULL, pair.moved[n], pull[n]);
    rd_attached_of[chain->attached_kind[k]].slopes(value, inertia, dashpot, &pair, number);
    for (size_t i = 0; i < 2 * w; i++)
        row[i] = pull[0][i / w] * b[i % w] + pull[1][i / w] * a[i % w];
}

/* t = (c_0, l c_1) of q and e = (1 + c_0)/2 of -4 q: q changes with 1/k' and m alike */
void rd_attached_tip(const struct rd_chain *chain, size_t k, double _Complex inertia,
                     double _Complex dashpot, double _Complex *tip)
{
    const double *value = chain->attached_value + k * RD_ATTACHED_VALUES;
    const double turn = dashpot == 0 ? 0 : 2 * value[3];
    const double _Complex stiff = CMPLX(1, turn);
    const double _Complex q = -inertia * value[0] / (value[1] * stiff);
    const double _Complex growth = rd_krylov_growth(-4 * q);
    const struct rd_krylov slope = rd_krylov_slope(-4 * q, growth), of = rd_krylov_slope(q, growth);
    struct rd_foot foot;
    rd_attached_fill(chain, k, inertia, dashpot, &foot);
    const double _Complex gap_slope = -4 * q * slope.c[0] / 2;
    for (int i = 0; i < 2; i++) {
        const double l = i == 0 ? 1 : value[2];
        const double _Complex by_q =
            (l * q * of.c[i] - foot.tip[i] / foot.gap * gap_slope) / foot.gap;
        tip[i] = foot.tip[i] / foot.gap;
        tip[2 + i] = -by_q;
        tip[4 + i] = dashpot == 0 ? 0 : -by_q * (2 * I / stiff);
    }
}

void rd_attached_inertia(const struct rd_chain *chain, size_t term, double *M)
{
    double _Complex D[RD_WIDTH_MAX * RD_WIDTH_MAX] = {0};
    rd_attached_add(chain, term, CMPLX(0, RD_COMPLEX_STEP), 0, D);
    for (size_t i = 0; i < chain->width * chain->width; i++)
        M[i] += cimag(D[i]) / RD_COMPLEX_STEP;
}
