/* The scaled triple of the first piece of a continuous span.
   Included by sweep/kernel/width.h, once per width. */
#include "span/slice.h"

/* q_i = (inertia p_i + dashpot drag_i) z_i^2, + T z_beta^2 for beta; S'_ij = S_ij/(section z_i z_j);
   Phi_ij z_j/z_i */
RD_INLINE void K_(rate)(const struct rd_chain *chain, const struct sweep_block *b, size_t e,
                        struct rate_matrix *rate)
{
    const double *S = chain->flexibility + 9 * e, *p = chain->inertia + e * W;
    rate->z = -1;
    rate->lever = l_fill(1.0);
    rate->hangs = chain->sag != NULL;
    rate->sag = c_zero();
    if (rate->hangs)
        rate->sag.re = chain->sag[e] * (b->z[W > 1] / b->z[0]);
    KEEP for (int i = 0; i < W; i++) {
        rate->q[i] = c_scale(c_scale_lanes(b->inertia, b->z[i] * b->z[i]), p[i]);
        if (chain->drag)
            rate->q[i] = c_add(rate->q[i], c_scale(c_scale_lanes(b->dashpot, b->z[i] * b->z[i]),
                                                   chain->drag[e * W + (size_t)i]));
        if (b->arm[i]) {
            rate->z = i;
            rate->lever = b->ratio[i];
        }
        KEEP for (int j = 0; j < W; j++) {
            const int string = !b->bends && i == j && b->channel[i] == RD_BENDING;
            const int bent = !b->arm[i] && !b->arm[j] && !string;
            const double s = bent ? S[3 * b->channel[i] + b->channel[j]] : (double)string;
            rate->elastic[i][j] = s != 0.0;
            rate->S[i][j] = string ? c_scale(b->slack, 1.0 / chain->tension[e])
                                   : c_scale(b->flex[at(i, j)], s);
        }
    }
    if (b->bends)
        rate->q[W - 1] = c_add(rate->q[W - 1], c_scale(b->pull, chain->tension[e]));
}

RD_INLINE void K_(slice)(const struct rate_matrix *rate, double l, int terms, cv *triple)
{
    cv D[W][W], G[W][W], Q[W][W];
    slice_fill(rate, l, terms, D, G, Q);
    KEEP for (int i = 0; i < W; i++)
        KEEP for (int j = 0; j < W; j++) {
            triple[i * W + j] = D[i][j];
            if (j < i)
                continue;
            triple[FULL + at(i, j)] = G[i][j];
            triple[FULL + SYM + at(i, j)] = Q[i][j];
        }
}

/* one of the 2^halvings parts of element e */
static RD_CLONES void K_(make_slice)(const struct rd_chain *chain, const struct sweep_block *b,
                                     size_t e, int halvings, int terms, cv *triple)
{
    struct rate_matrix rate;
    K_(rate)(chain, b, e, &rate);
    K_(slice)(&rate, ldexp(chain->length[e], -halvings), terms, triple);
}

/* a whole span, joined from 2^halvings slices */
static RD_CLONES void K_(make_span)(const struct rate_matrix *rate, double l, int halvings,
                                    int terms, cv *triple)
{
    cv half[FULL + 2 * SYM];
    K_(slice)(rate, ldexp(l, -halvings), terms, triple);
    for (int k = 0; k < halvings; k++) {
        KEEP for (int i = 0; i < FULL + 2 * SYM; i++)
            half[i] = triple[i];
        K_(join)(NULL, NULL, -1, half, half, triple);
    }
}
