/* Shapes of what the iteration found, from its pieces down to the nodes. */
#ifndef RD_REFINE_SHAPE_H
#define RD_REFINE_SHAPE_H

#include "base/complex.h"
#include "modes/refine/refine.h"
#include "modes/walk/piece.h"

#include <string.h>

/* What a joint of two equal halves needs to be taken apart again, for one lane. */
struct joint {
    double D[W][W], V[W][W], X[W][W], XV[W][W];
};

static void joint_fill(const struct rd_refine *r, const struct rd_step *step, lanes lambda,
                       int lane, struct joint *joint)
{
    lanes N[W][W];
    term_load(r->walk, r->walk->leg[step->leg].term, step->element, lambda, N);
    const struct piece *half =
        (const struct piece *)(r->piece + (size_t)(step->piece - step->level) * 6 * W * W);
    for (int32_t k = 0; k < step->level; k++, half += 2, joint++) {
        struct middle middle;
        middle_fill(half, N, &middle);
        for (int i = 0; i < W; i++)
            for (int j = 0; j < W; j++) {
                joint->D[i][j] = half->D[i][j][lane];
                joint->V[i][j] = middle.V[i][j][lane];
                joint->X[i][j] = middle.X[i][j][lane];
                joint->XV[i][j] = middle.XV[i][j][lane];
            }
    }
}

/* Back down the doubling to the nodes, 2^halvings first pieces apart: in the middle of two halves u_m = M F1 u_a + X F2^T f_b with
   M = I - X V, f_m = F2^T f_b - V u_m. joint[k] is that of two halves of level k. */
static void descend(const struct joint *joint, int32_t halvings, int32_t level, size_t at,
                    const double *ua, const double *fb, double *u)
{
    if (level <= halvings) {
        if ((at & (((size_t)1 << halvings) - 1)) == 0)
            memcpy(u + (at >> halvings) * W, ua, W * sizeof *u);
        return;
    }
    const struct joint *half = joint + level - 1;
    double um[W], fm[W], Fu[W], Ff[W];
    for (int i = 0; i < W; i++) {
        Fu[i] = ua[i];
        Ff[i] = fb[i];
        for (int j = 0; j < W; j++) {
            Fu[i] += half->D[i][j] * ua[j];
            Ff[i] += half->D[j][i] * fb[j];
        }
    }
    for (int i = 0; i < W; i++) {
        um[i] = Fu[i];
        for (int j = 0; j < W; j++)
            um[i] += half->X[i][j] * Ff[j] - half->XV[i][j] * Fu[j];
    }
    for (int i = 0; i < W; i++) {
        fm[i] = Ff[i];
        for (int j = 0; j < W; j++)
            fm[i] -= half->V[i][j] * um[j];
    }
    descend(joint, halvings, level - 1, at, ua, fm, u);
    descend(joint, halvings, level - 1, at + ((size_t)1 << (level - 1)), um, fb, u);
}

/* what a plain span of that length does to waves, u_b = A s_b - i B u_a and so on (span/whole.h) */
struct plain_coefficients {
    cv A[W][W], B[W][W], C[W][W];
};

RD_INLINE void plain_coefficients_fill(const struct rate_matrix *rate, const double *z,
                                       lanes length, struct plain_coefficients *c)
{
    enum { B = W - 1 };
    const cv soft = c_scale(rate->S[B][B], 1 / (z[B] * z[B]));
    const cv load[2] = {c_scale(rate->q[0], z[0] * z[0]), c_scale(rate->q[B], z[B] * z[B])};
    if (W == 1) {
        struct plain_span span;
        rd_rod_span(&soft, load, &length, &span);
        c->A[0][0] = span.A;
        c->B[0][0] = span.B;
        c->C[0][0] = span.C;
        return;
    }
    const lanes lever = l_fill(z[B] / z[0]);
    struct bent_span span;
    rd_bent_span(&soft, load, &lever, &length, &span);
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 2; j++) {
            c->A[i * B][j * B] = span.A[i + j];
            c->B[i * B][j * B] = span.B[2 * i + j];
            c->C[i * B][j * B] = span.C[i + j];
        }
}

/* (i, j) of x y and of x y^T */
RD_INLINE cv product_at(const cv x[W][W], const cv y[W][W], int i, int j)
{
    cv sum = c_mul(x[i][0], y[0][j]);
    for (int k = 1; k < W; k++)
        sum = c_add(sum, c_mul(x[i][k], y[k][j]));
    return sum;
}

/* Where the two ends of a plain leg stand still or move, u_a and s_b = u_b - i f_b, scaled, its nodes at x
   move by u: with the coefficients of both sides

       (I - i A1 C2) u = -i (B1 u_a + A1 B2^T s_b) */
RD_INLINE void plain_motion(const struct rate_matrix *rate, const double *z, double length, lanes x,
                            const double *ua, const double _Complex *sb, lanes *u)
{
    struct plain_coefficients left, right;
    cv M[W][W], t[W], y[W];
    plain_coefficients_fill(rate, z, x, &left);
    plain_coefficients_fill(rate, z, length - x, &right);
    for (int i = 0; i < W; i++) {
        t[i] = c_zero();
        for (int j = 0; j < W; j++) {
            const cv s = c_make(l_fill(creal(sb[j])), l_fill(cimag(sb[j])));
            t[i] = c_add(t[i], c_mul(right.B[j][i], s));
        }
    }
    for (int i = 0; i < W; i++) {
        y[i] = c_zero();
        for (int j = 0; j < W; j++) {
            y[i] = c_add(y[i], c_add(c_scale(left.B[i][j], ua[j]), c_mul(left.A[i][j], t[j])));
            M[i][j] = c_neg(c_times_i(product_at(left.A, right.C, i, j)));
            M[i][j].re += l_fill(i == j);
        }
    }
    enum { B = W - 1 };
    if (W == 1) {
        u[0] = c_mul(y[0], c_inverse(M[0][0])).im;
        return;
    }
    const cv d = c_inverse(c_sub(c_mul(M[0][0], M[B][B]), c_mul(M[0][B], M[B][0])));
    u[0] = c_mul(c_sub(c_mul(M[B][B], y[0]), c_mul(M[0][B], y[B])), d).im;
    u[B] = c_mul(c_sub(c_mul(M[0][0], y[B]), c_mul(M[B][0], y[0])), d).im;
}

/* the nodes of a plain leg between its ends, whose first step is m */
static void plain_nodes(const struct rd_refine *r, size_t m, lanes lambda, int lane, double *u)
{
    const struct rd_leg *leg = r->walk->leg + r->step[m].leg;
    const double apart = r->walk->chain->length[leg->element];
    const size_t end = m + PLAIN_STEPS;
    double ua[W];
    double _Complex sb[W];
    struct rate_matrix rate;
    plain_rate(r->walk, leg, l_fill(lambda[lane]), &rate);
    for (size_t i = 0; i < W; i++) {
        ua[i] = r->u[m * W + i][lane];
        sb[i] = CMPLX(r->u[end * W + i][lane], -r->f[(end - 1) * W + i][lane]);
    }
    for (size_t node = 1; node < leg->count; node += RD_LANES) {
        lanes x, between[W];
        for (size_t k = 0; k < RD_LANES; k++)
            x[k] = apart * (double)(node + k < leg->count ? node + k : leg->count - 1);
        plain_motion(&rate, r->z, apart * (double)leg->count, x, ua, sb, between);
        for (size_t k = 0; k < RD_LANES && node + k < leg->count; k++)
            for (size_t i = 0; i < W; i++)
                u[(node + k) * W + i] = between[i][k] * r->z[i];
    }
}

void WIDTH(shape)(struct rd_refine *r, const double *lambdas, int lane, double *u)
{
    const struct rd_chain *chain = r->walk->chain;
    const lanes lambda = lanes_load(lambdas);
    struct joint joint[LEVELS];
    int32_t leg = -1;
    for (size_t m = 0; m <= r->steps; m++) {
        double ua[W], fb[W];
        for (int i = 0; i < W; i++) {
            ua[i] = r->u[m * W + (size_t)i][lane] * r->z[i];
            fb[i] = m < r->steps ? r->f[m * W + (size_t)i][lane] / r->z[i] : 0;
        }
        if (m == r->steps) {
            memcpy(u + (chain->nodes - 1) * W, ua, sizeof ua);
            return;
        }
        const struct rd_step *step = r->step + m;
        double *const node = u + r->walk->leg[step->leg].node * W;
        if (step->plain) {
            if (step->at == 0 && step->term != RD_NO_TERM)
                memcpy(node, ua, sizeof ua);
            if (step->at == 0)
                plain_nodes(r, m, lambda, lane, node);
            leg = step->leg;
            continue;
        }
        if (step->block > 0) {
            if (step->leg != leg && step->term != RD_NO_TERM)
                memcpy(node, ua, sizeof ua);
            leg = step->leg;
            continue;
        }
        /* the first step of a leg is its largest piece, the last of its levels */
        if (step->leg != leg && step->piece >= 0)
            joint_fill(r, step, lambda, lane, joint);
        leg = step->leg;
        /* a node's own motion is that on the left of its hinge */
        if (step->at > 0 || step->term != RD_NO_TERM)
            descend(joint, step->halvings, step->level, step->at, ua, fb, node);
    }
}

#endif
