/* Motions of the whole chain that nothing resists. */
#include "modes/certify/rigid.h"

#include "chain/attached.h"

#include "base/lapack.h"
#include "graded/blocks.h"

#include <math.h>
#include <string.h>

enum { W = RD_WIDTH_MAX };

/* relative; below it a resistance is rounding of the levers */
static const double NOTHING = 1e-11;

/* R^T R += row^T row by plane rotations, R upper triangular */
static void gather(size_t w, double *row, double R[W][W])
{
    for (size_t i = 0; i < w; i++) {
        if (row[i] == 0)
            continue;
        const double size = hypot(R[i][i], row[i]);
        const double c = R[i][i] / size, s = row[i] / size;
        for (size_t j = i; j < w; j++) {
            const double x = R[i][j], y = row[j];
            R[i][j] = c * x + s * y;
            row[j] = c * y - s * x;
        }
    }
}

/* the rows of A T, scaled to 1 */
static void resist(size_t w, const double *A, const double T[W][W], double R[W][W])
{
    for (size_t i = 0; i < w; i++) {
        double row[W], size = 0;
        for (size_t j = 0; j < w; j++) {
            row[j] = 0;
            for (size_t k = 0; k < w; k++)
                row[j] += A[i * w + k] * T[k][j];
            size = fmax(size, fabs(row[j]));
        }
        if (size == 0)
            continue;
        for (size_t j = 0; j < w; j++)
            row[j] /= size;
        gather(w, row, R);
    }
}

static void resist_node(const struct rd_walk *walk, int32_t term, const double T[W][W],
                        double R[W][W])
{
    const size_t w = walk->chain->width;
    const uint8_t *held = rd_walk_held(walk, term);
    double hold[W * W] = {0};
    for (size_t i = 0; i < w; i++)
        hold[i * (w + 1)] = held[i];
    resist(w, hold, T, R);
    resist(w, rd_walk_springs(walk, term), T, R);
}

/* What an element without end forces makes of a motion: D_z,beta = l, and its tension resists any
   beta; of sag D_x,z = l w/T. D, Q (width, width) */
static void levers(const struct rd_chain *chain, int32_t element, double *D, double *Q)
{
    const size_t w = chain->width, beta = w - 1;
    memset(D, 0, w * w * sizeof *D);
    memset(Q, 0, w * w * sizeof *Q);
    const bool hinge = (size_t)element >= chain->distinct;
    if (chain->sag && !hinge)
        D[1] = chain->length[element] * chain->sag[element];
    if (hinge || chain->coordinate[beta] != RD_BETA || chain->kind == RD_DIFFERENCE)
        return;
    const size_t z = rd_coordinate_find(w, chain->coordinate, RD_Z);
    if (z < w)
        D[z * w + beta] = chain->length[element];
    Q[beta * w + beta] = chain->tension[element];
    if (rd_is_graded(chain, (size_t)element))
        Q[beta * w + beta] = fabs(chain->tension[element]) + fabs(chain->rise[element]);
}

/* DT = D T */
static void tilt(size_t w, const double *D, const double T[W][W], double DT[W][W])
{
    for (size_t i = 0; i < w; i++)
        for (size_t j = 0; j < w; j++) {
            DT[i][j] = 0;
            for (size_t k = 0; k < w; k++)
                DT[i][j] += D[i * w + k] * T[k][j];
        }
}

/* T <- F^n T, D^2 = 0: of sag but for what beta does to x, and no beta is left under tension */
static void advance(size_t w, const double *D, size_t n, double T[W][W])
{
    double DT[W][W];
    tilt(w, D, T, DT);
    for (size_t i = 0; i < w; i++)
        for (size_t j = 0; j < w; j++)
            T[i][j] += (double)n * DT[i][j];
}

/* every direction is resisted for certain, far from rounding */
static bool is_full(size_t w, const double R[W][W])
{
    for (size_t i = 0; i < w; i++)
        if (!(fabs(R[i][i]) > 0.1))
            return false;
    return true;
}

static void begin(const struct rd_walk *walk, double T[W][W])
{
    const struct rd_chain *chain = walk->chain;
    memset(T, 0, W * sizeof *T);
    for (size_t i = 0; i < chain->width; i++)
        T[i][i] = chain->coordinate[i] == RD_BETA ? 1 / walk->length : 1;
}

/* all that resists the motions T of the left end */
static void resistance(const struct rd_walk *walk, double R[W][W])
{
    const struct rd_chain *chain = walk->chain;
    const size_t w = chain->width;
    double T[W][W], D[W * W], Q[W * W];
    begin(walk, T);
    for (size_t r = 0; r < walk->legs && !is_full(w, R); r++) {
        const struct rd_leg *leg = walk->leg + r;
        levers(chain, leg->element, D, Q);
        resist_node(walk, leg->first, T, R);
        resist(w, Q, T, R);
        advance(w, D, 1, T);
        if (leg->count > 1)
            resist_node(walk, leg->term, T, R);
        advance(w, D, leg->count - 1, T);
        if (leg->count > 2)
            resist_node(walk, leg->term, T, R);
    }
    resist_node(walk, walk->last, T, R);
}

/* The right singular vectors V of R (w, w) whose size is nothing belong to the motions that nothing
   resists. LAPACK, which counts by columns, takes R for its transpose and V for the left ones. */
static size_t null_space(size_t w, double R[W][W], double motion[W][W])
{
    double size[W], V[W][W], work[16 * W];
    const int n = (int)w;
    LAPACKE_dgesvd_work(LAPACK_COL_MAJOR, 'A', 'N', n, n, *R, W, size, *V, W, NULL, 1, work,
                        16 * W);
    size_t count = 0;
    for (size_t p = 0; p < w; p++) {
        if (size[p] > NOTHING)
            continue;
        for (size_t i = 0; i < w; i++)
            motion[i][count] = V[p][i];
        count++;
    }
    return count;
}

/* A += factor (B^T M C + C^T M B)/2 */
static void add_inertia(size_t w, const double *M, const double B[W][W], const double C[W][W],
                        double factor, double A[W][W])
{
    for (size_t a = 0; a < w; a++)
        for (size_t b = 0; b < w; b++)
            for (size_t i = 0; i < w; i++)
                for (size_t j = 0; j < w; j++)
                    A[a][b] += factor / 2 * M[i * w + j] * (B[i][a] * C[j][b] + C[i][a] * B[j][b]);
}

/* the inertia M (width, width) of an element of its own; false where it has none */
static bool rope_of(const struct rd_walk *walk, const struct rd_leg *leg, double *M)
{
    const struct rd_chain *chain = walk->chain;
    const size_t w = chain->width, e = (size_t)leg->element;
    if (!chain->inertia || e >= chain->distinct)
        return false;
    memset(M, 0, w * w * sizeof *M);
    for (size_t i = 0; i < w; i++)
        M[i * (w + 1)] = chain->length[e] * chain->inertia[e * w + i];
    return true;
}

/* a node alone, with the structures that it carries */
static void add_node(const struct rd_walk *walk, int32_t term, const double T[W][W], double A[W][W])
{
    const size_t w = walk->chain->width;
    double M[W * W];
    memcpy(M, rd_walk_mass(walk, term), w * w * sizeof *M);
    if (term != RD_NO_TERM)
        rd_attached_inertia(walk->chain, (size_t)term, M);
    add_inertia(w, M, T, T, 1, A);
}

/* T^T M T over all nodes and continuous elements, in which T is linear; in a run T + k D T, with sums of k and k^2 for k = 1 .. n - 1 */
static void inertia(const struct rd_walk *walk, double A[W][W])
{
    const struct rd_chain *chain = walk->chain;
    const size_t w = chain->width;
    double T[W][W], DT[W][W], D[W * W], Q[W * W], own[W * W];
    begin(walk, T);
    memset(A, 0, W * sizeof *A);
    for (size_t r = 0; r < walk->legs; r++) {
        const struct rd_leg *leg = walk->leg + r;
        levers(chain, leg->element, D, Q);
        const double n = (double)leg->count;
        const double *M = rd_walk_mass(walk, leg->term);
        tilt(w, D, T, DT);
        add_node(walk, leg->first, T, A);
        add_inertia(w, M, T, T, n - 1, A);
        add_inertia(w, M, T, DT, n * (n - 1), A);
        add_inertia(w, M, DT, DT, (n - 1) * n * (2 * n - 1) / 6, A);
        if (rope_of(walk, leg, own)) {
            add_inertia(w, own, T, T, n, A);
            add_inertia(w, own, T, DT, n * n, A);
            add_inertia(w, own, DT, DT, n * n * n / 3, A);
        }
        advance(w, D, leg->count, T);
    }
    add_node(walk, walk->last, T, A);
}

/* motion <- motion L^-T with motion^T A motion = L L^T */
static bool orthonormalise(size_t w, const double A[W][W], struct rd_rigid *rigid)
{
    for (size_t k = 0; k < rigid->count; k++)
        for (size_t pass = 0; pass <= k; pass++) {
            double size = 0, share = 0, whole = 0;
            for (size_t i = 0; i < w; i++)
                for (size_t j = 0; j < w; j++) {
                    const double x = A[i][j] * rigid->motion[j][k];
                    size += rigid->motion[i][k] * x;
                    whole += fabs(rigid->motion[i][k] * x);
                    share += pass < k ? rigid->motion[i][pass] * x : 0;
                }
            for (size_t i = 0; i < w && pass < k; i++)
                rigid->motion[i][k] -= share * rigid->motion[i][pass];
            if (pass < k)
                continue;
            if (!(size > 1e-14 * whole))
                return false;
            for (size_t i = 0; i < w; i++)
                rigid->motion[i][k] /= sqrt(size);
        }
    return true;
}

enum rd_status rd_rigid_fill(const struct rd_walk *walk, struct rd_rigid *rigid)
{
    const size_t w = walk->chain->width;
    double R[W][W] = {{0}}, A[W][W];
    memset(rigid, 0, sizeof *rigid);
    resistance(walk, R);
    rigid->count = null_space(w, R, rigid->motion);
    if (rigid->count == 0)
        return RD_OK;
    inertia(walk, A);
    return orthonormalise(w, A, rigid) ? RD_OK : RD_UNSTABLE_MASSLESS;
}

/* y = v^T u of the structures of a node, at rest */
static void carry_along(const struct rd_chain *chain, int32_t term, const double *u, double *y)
{
    if (term == RD_NO_TERM)
        return;
    for (size_t k = rd_attached_first(chain, (size_t)term); rd_attached_is_of(chain, k, term);
         k++) {
        struct rd_foot foot;
        double _Complex v[W];
        rd_attached_fill(chain, k, 0, 0, &foot);
        rd_attached_row(chain, k, foot.lever, v);
        y[k] = 0;
        for (size_t i = 0; i < chain->width; i++)
            y[k] += creal(v[i]) * u[i];
    }
}

void rd_rigid_shape(const struct rd_walk *walk, const struct rd_rigid *rigid, size_t k, double *u,
                    double *y)
{
    const struct rd_chain *chain = walk->chain;
    const size_t w = chain->width;
    double T[W][W], DT[W][W], D[W * W], Q[W * W];
    if (chain->attached > 0)
        memset(y, 0, chain->attached * sizeof *y);
    begin(walk, T);
    for (size_t r = 0; r <= walk->legs; r++) {
        const struct rd_leg last = {.node = chain->nodes - 1, .count = 1, .first = walk->last};
        const struct rd_leg *leg = r < walk->legs ? walk->leg + r : &last;
        levers(chain, leg->element, D, Q);
        tilt(w, D, T, DT);
        for (size_t n = 0; n < leg->count; n++) {
            const uint8_t *held = rd_walk_held(walk, n == 0 ? leg->first : leg->term);
            for (size_t i = 0; i < w; i++) {
                double sum = 0;
                for (size_t j = 0; j < w; j++)
                    sum += (T[i][j] + (double)n * DT[i][j]) * rigid->motion[j][k];
                u[(leg->node + n) * w + i] = held[i] ? 0 : sum;
            }
            if (n == 0)
                carry_along(chain, leg->first, u + leg->node * w, y);
        }
        advance(w, D, leg->count, T);
    }
}
