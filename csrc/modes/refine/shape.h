/* Shapes of what the iteration found, from its pieces down to the nodes. */
#ifndef RD_REFINE_SHAPE_H
#define RD_REFINE_SHAPE_H

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
        /* the first step of a leg is its largest piece, the last of its levels */
        const struct rd_step *step = r->step + m;
        if (step->leg != leg && step->piece >= 0)
            joint_fill(r, step, lambda, lane, joint);
        leg = step->leg;
        /* a node's own motion is that on the left of its hinge */
        if (step->at > 0 || step->term != RD_NO_TERM)
            descend(joint, step->halvings, step->level, step->at, ua, fb,
                    u + r->walk->leg[leg].node * W);
    }
}

#endif
