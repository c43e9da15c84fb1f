/* What stands at a node and on its right, in scattering form. */
#include "march/form/joint.h"

#include "base/dense.h"
#include "chain/elements.h"
#include "element/element.h"
#include "element/strut.h"
#include "element/triple.h"
#include "march/form/resonator.h"

#include <math.h>
#include <string.h>

enum { SQUARE = RD_WIDTH_MAX * RD_WIDTH_MAX };

/* a joint's blocks while it is filled */
struct joint {
    size_t w;
    double *block[RD_JOINT_BLOCKS];
    double *number;
};

static struct joint joint_of(const struct rd_march *march, size_t stretch)
{
    struct joint joint = {.w = march->chain->width};
    double *at = rd_joint_of(march, stretch);
    for (int i = 0; i < RD_JOINT_BLOCKS; i++)
        joint.block[i] = at + (size_t)i * joint.w * joint.w;
    joint.number = at + RD_JOINT_BLOCKS * joint.w * joint.w;
    return joint;
}

/* M += x a b^T, entry by entry the same on both sides where a is b */
static void add_dyad(size_t w, double x, const double *a, const double *b, double *M)
{
    for (size_t i = 0; i < w; i++)
        for (size_t j = 0; j < w; j++)
            M[i * w + j] += x * (a[i] * b[j]);
}

static void symmetrise(size_t w, double *M)
{
    for (size_t i = 0; i < w; i++)
        for (size_t j = 0; j < i; j++) {
            const double mean = (M[i * w + j] + M[j * w + i]) / 2;
            M[i * w + j] = mean;
            M[j * w + i] = mean;
        }
}

static void column_of(size_t w, const double *M, size_t i, double *column)
{
    for (size_t j = 0; j < w; j++)
        column[j] = M[j * w + i];
}

/* scaled D = F - I, G, Q of the element alone */
static enum rd_status fill_triple(const struct rd_march *march, size_t e, struct joint *joint)
{
    const struct rd_element element = rd_chain_element(march->chain, e);
    const double *z = march->number->z;
    double *D = joint->block[RD_JOINT_D], *G = joint->block[RD_JOINT_G];
    double *Q = joint->block[RD_JOINT_Q];
    if (rd_element_is_strut(&element))
        return RD_CRITICAL_ELEMENT;
    const enum rd_status status = rd_triple_change(&element, D, G, Q);
    for (size_t i = 0; i < joint->w; i++)
        for (size_t j = 0; j < joint->w; j++) {
            D[i * joint->w + j] *= z[j] / z[i];
            G[i * joint->w + j] /= z[i] * z[j];
            Q[i * joint->w + j] *= z[i] * z[j];
        }
    return status;
}

/* A = K G, B - I = D - A - A D, W = Q + D + D^T + D^T D - F^T A F of the stage: G/r and r Q.
   Nothing is taken from the unit matrix, so that small elements keep their digits. */
static enum rd_status scatter(double r, struct joint *joint)
{
    const size_t w = joint->w, ww = w * w;
    const double *D = joint->block[RD_JOINT_D];
    double *A = joint->block[RD_JOINT_A0], *B = joint->block[RD_JOINT_B0];
    double *W = joint->block[RD_JOINT_W0], K[SQUARE], G[SQUARE], T[SQUARE], X[SQUARE];
    for (size_t i = 0; i < ww; i++) {
        G[i] = joint->block[RD_JOINT_G][i] / r;
        K[i] = G[i] + (i % (w + 1) == 0);
    }
    if (!rd_dense_invert(w, K))
        return RD_NOT_POSITIVE_DEFINITE;
    rd_dense_multiply(w, w, w, K, G, A);
    symmetrise(w, A);
    rd_dense_multiply(w, w, w, A, D, B); /* A D */
    rd_dense_transpose(w, w, D, T);
    for (size_t i = 0; i < ww; i++)
        X[i] = D[i] - A[i] - B[i];
    rd_dense_multiply(w, w, w, T, X, W); /* D^T (D - A - A D) */
    for (size_t i = 0; i < w; i++)
        for (size_t j = 0; j < w; j++)
            W[i * w + j] += r * joint->block[RD_JOINT_Q][i * w + j] + X[i * w + j] + T[i * w + j];
    symmetrise(w, W);
    memcpy(B, X, ww * sizeof *B);
    return RD_OK;
}

/* the hinge in coordinate i of compliance t: of the stage's matrices by P = W + I, of the
   element's by Q, at whose left end a free one without tension leaves no force */
static void hinge(size_t i, double t, double r, struct joint *joint)
{
    const size_t w = joint->w;
    double *A = joint->block[RD_JOINT_A0], *B = joint->block[RD_JOINT_B0];
    double *W = joint->block[RD_JOINT_W0], *D = joint->block[RD_JOINT_D];
    double *G = joint->block[RD_JOINT_G], *Q = joint->block[RD_JOINT_Q];
    double b[RD_WIDTH_MAX], p[RD_WIDTH_MAX], f[RD_WIDTH_MAX], q[RD_WIDTH_MAX];
    column_of(w, B, i, b);
    column_of(w, W, i, p);
    b[i] += 1;
    p[i] += 1;
    const double x = 1 / (p[i] + r / t);
    add_dyad(w, x, b, b, A);
    add_dyad(w, -x, b, p, B);
    add_dyad(w, -x, p, p, W);
    column_of(w, D, i, f);
    column_of(w, Q, i, q);
    f[i] += 1;
    const double resists = q[i] + 1 / t;
    if (resists > 0) {
        add_dyad(w, 1 / resists, f, f, G);
        add_dyad(w, -1 / resists, f, q, D);
        add_dyad(w, -1 / resists, q, q, Q);
        return;
    }
    joint->number[RD_JOINT_OPEN] = 1;
    for (size_t j = 0; j < w; j++)
        D[j * w + i] = -(double)(i == j);
}

static void fill_node(const struct rd_march *march, size_t term, struct joint *joint)
{
    const struct rd_chain *chain = march->chain;
    const double *z = march->number->z, theta = march->number->theta;
    const size_t w = joint->w;
    double *W = joint->block[RD_JOINT_W0];
    const double damped = 1 + march->beside->spring_rate / theta;
    for (size_t i = 0; i < w; i++)
        for (size_t j = 0; j < w; j++) {
            const size_t at = i * w + j, in = term * w * w + at;
            const double zz = z[i] * z[j];
            const double M = chain->mass[in] / theta * zz / theta;
            const double C = chain->damping ? chain->damping[in] / theta * zz : 0;
            const double K = chain->stiffness[in] * zz;
            joint->block[RD_JOINT_MASS][at] = M;
            joint->block[RD_JOINT_DRAG][at] = C;
            joint->block[RD_JOINT_SPRING][at] = K;
            joint->block[RD_JOINT_REST][at] = K + joint->block[RD_JOINT_Q][at];
            W[at] += M + C + damped * K + (i == j && chain->held[term * w + i]);
        }
    for (size_t k = rd_attached_first(chain, term); rd_attached_is_of(chain, k, (int32_t)term); k++)
        rd_resonator_add(march, k, W);
}

/* At the last node nothing is on the right: W = N - I, no A and B. */
enum rd_status rd_joint_fill(const struct rd_march *march, size_t stretch)
{
    const struct rd_chain *chain = march->chain;
    struct joint joint = joint_of(march, stretch);
    const size_t w = joint.w, term = (size_t)chain->term[stretch];
    memset(joint.block[0], 0, rd_joint_size(march) * sizeof(double));
    if (stretch + 1 == chain->stretches) {
        for (size_t i = 0; i < w; i++)
            joint.block[RD_JOINT_W0][i * (w + 1)] = -1;
        fill_node(march, term, &joint);
        return RD_OK;
    }
    const size_t e = (size_t)chain->element[stretch];
    const double theta = march->number->theta, rate = march->beside->rate[e] / theta;
    enum rd_status status = fill_triple(march, e, &joint);
    if (status == RD_OK)
        status = scatter(1 + rate, &joint);
    if (status != RD_OK)
        return status;
    for (size_t i = 0; chain->hinge && i < w; i++)
        if (chain->hinge[term * w + i] > 0) {
            const double z = march->number->z[i];
            hinge(i, chain->hinge[term * w + i] / (z * z), 1 + rate, &joint);
        }
    fill_node(march, term, &joint);
    joint.number[RD_JOINT_RATE] = rate;
    joint.number[RD_JOINT_STRING] = march->beside->string[e];
    joint.number[RD_JOINT_DAMPED] = march->beside->drag[e] / theta;
    if (march->iz < w) {
        const double z = march->number->z[march->iz];
        joint.number[RD_JOINT_REACH] = z * z / chain->length[e];
    }
    return RD_OK;
}

/* the string beside the element: k, a = A e_z, b = (B - I)^T e_z */
enum rd_status rd_joint_tighten(const struct rd_march *march, size_t stretch)
{
    struct joint joint = joint_of(march, stretch);
    const size_t w = joint.w, ww = w * w, iz = march->iz;
    double *A = joint.block[RD_JOINT_A], *B = joint.block[RD_JOINT_B], *W = joint.block[RD_JOINT_W];
    memcpy(A, joint.block[RD_JOINT_A0], ww * sizeof *A);
    memcpy(B, joint.block[RD_JOINT_B0], ww * sizeof *B);
    memcpy(W, joint.block[RD_JOINT_W0], ww * sizeof *W);
    const double *number = joint.number;
    const double tension = number[RD_JOINT_STRING] + march->number->extra + number[RD_JOINT_DAMPED];
    const double k = number[RD_JOINT_REACH] * tension;
    joint.number[RD_JOINT_STIFF] = k;
    joint.number[RD_JOINT_TURNED] = 0;
    if (stretch + 1 == march->chain->stretches)
        return RD_OK;
    if (k != 0) {
        double a[RD_WIDTH_MAX], b[RD_WIDTH_MAX];
        const double whole = 1 + k * A[iz * (w + 1)];
        if (whole == 0 || !isfinite(whole))
            return RD_SINGULAR;
        joint.number[RD_JOINT_TURNED] = whole < 0;
        column_of(w, A, iz, a);
        memcpy(b, B + iz * w, w * sizeof *b);
        add_dyad(w, -k / whole, a, a, A);
        add_dyad(w, -k / whole, a, b, B);
        add_dyad(w, k / whole, b, b, W);
    }
    for (size_t i = 0; i < w; i++)
        B[i * (w + 1)] += 1;
    return RD_OK;
}
