/* The scaled triple of the first piece of a continuous span, and the coefficients of a whole one.
   Included by sweep/kernel/width.h, once per width. */
#include "span/plain.h"
#include "span/slice.h"
#include "span/three_waves.h"

/* q_i = (inertia p_i + dashpot drag_i) z_i^2, + T z_beta^2 for beta; S'_ij = S_ij/(section z_i z_j);
   Phi_ij z_j/z_i */
RD_INLINE void K_(rate)(const struct rd_chain *chain, const struct sweep_block *b, size_t e,
                        struct rate_matrix *rate)
{
    const double *S = chain->flexibility + 9 * e, *p = chain->inertia + e * W;
    rate->z = rate->across = -1;
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
        if (chain->coordinate[i] == RD_Z)
            rate->across = i;
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

static void K_(make_rate)(const struct rd_chain *chain, const struct sweep_block *b, size_t e,
                          struct rate_matrix *rate)
{
    K_(rate)(chain, b, e, rate);
}

RD_INLINE void K_(pack)(const cv D[W][W], const cv G[W][W], const cv Q[W][W], cv *triple)
{
    KEEP for (int i = 0; i < W; i++)
        KEEP for (int j = 0; j < W; j++) {
            triple[i * W + j] = D[i][j];
            if (j < i)
                continue;
            triple[FULL + at(i, j)] = G[i][j];
            triple[FULL + SYM + at(i, j)] = Q[i][j];
        }
}

static RD_CLONES void K_(slice)(const struct rate_matrix *rate, double l, int terms, cv *triple)
{
    cv D[W][W], G[W][W], Q[W][W];
#if RD_WIDTH > 2
    if (slice_is_real(rate)) {
        lanes d[W][W], g[W][W], q[W][W];
        r_slice_fill(rate, l, terms, d, g, q);
        KEEP for (int i = 0; i < W; i++)
            KEEP for (int j = 0; j < W; j++) {
                D[i][j] = r_as_complex(d[i][j]);
                G[i][j] = r_as_complex(g[i][j]);
                Q[i][j] = r_as_complex(q[i][j]);
            }
        K_(pack)(D, G, Q, triple);
        return;
    }
#endif
    slice_fill(rate, l, terms, D, G, Q);
    K_(pack)(D, G, Q, triple);
}

/* one of the 2^halvings parts of element e */
static RD_CLONES void K_(make_slice)(const struct rd_chain *chain, const struct sweep_block *b,
                                     size_t e, int halvings, int terms, cv *triple)
{
    struct rate_matrix rate;
    K_(rate)(chain, b, e, &rate);
    K_(slice)(&rate, ldexp(chain->length[e], -halvings), terms, triple);
}

RD_INLINE int K_(is_real)(const cv *x, int count)
{
    lanes im = {0};
    KEEP for (int i = 0; i < count; i++)
        im += l_abs(x[i].im);
    double sum = 0.0;
    for (int k = 0; k < RD_LANES; k++)
        sum += im[k];
    return sum == 0.0;
}

/* a whole span, joined from 2^halvings slices */
static RD_CLONES void K_(make_span)(const struct rate_matrix *rate, double l, int halvings,
                                    int terms, cv *triple)
{
    cv half[FULL + 2 * SYM];
    K_(slice)(rate, ldexp(l, -halvings), terms, triple);
    const int undamped = K_(is_real)(triple, FULL + 2 * SYM);
    for (int k = 0; k < halvings; k++) {
        KEEP for (int i = 0; i < FULL + 2 * SYM; i++)
            half[i] = triple[i];
        if (undamped)
            NAME(real_join, RD_WIDTH)(NULL, NULL, -1, half, half, triple);
        else
            K_(join)(NULL, NULL, -1, half, half, triple);
    }
}

#if RD_WIDTH > 1
/* z with beta, which is the last */
RD_INLINE void K_(whole_bent)(const struct rate_matrix *rate, double l, cv *coef, lanes *radians)
{
    enum { B = W - 1 };
    cv *A = coef, *X = A + SYM, *C = X + FULL;
    const int z = W == 2 ? 0 : rate->z;
    const cv load[2] = {rate->q[z], rate->q[B]};
    const lanes length = l_fill(l);
    struct bent_span span;
    rd_bent_span(&rate->S[B][B], load, &rate->lever, &length, &span);
    A[at(z, z)] = span.A[0];
    A[at(z, B)] = span.A[1];
    A[at(B, B)] = span.A[2];
    X[z * W + z] = span.B[0];
    X[z * W + B] = span.B[1];
    X[B * W + z] = span.B[2];
    X[B * W + B] = span.B[3];
    C[at(z, z)] = span.C[0];
    C[at(z, B)] = span.C[1];
    C[at(B, B)] = span.C[2];
    *radians = span.radians;
}
#endif

/* coefficients of a plain span (span/span.h) of element e's section; radians: of its shortest wave */
static RD_CLONES void K_(make_whole)(const struct rd_chain *chain, const struct sweep_block *b,
                                     size_t e, double length, cv *coef, lanes *radians)
{
    struct rate_matrix rate;
    cv *A = coef, *X = A + SYM, *C = X + FULL;
    K_(rate)(chain, b, e, &rate);
    KEEP for (int i = 0; W > 2 && i < FULL + 2 * SYM; i++)
        coef[i] = c_zero();
    const lanes all = l_fill(length);
    *radians = (lanes){0};
#if RD_WIDTH > 1
    if (rate.z >= 0)
        K_(whole_bent)(&rate, length, coef, radians);
#endif
    KEEP for (int i = 0; i < W; i++) {
        if (rate.z >= 0 && (i == rate.z || i == W - 1))
            continue;
        struct plain_span span;
        rd_rod_span(&rate.S[i][i], rate.q + i, &all, &span);
        A[at(i, i)] = span.A;
        X[i * W + i] = span.B;
        C[at(i, i)] = span.C;
        *radians = l_most(*radians, span.radians);
    }
}

#if RD_WIDTH > 2

/* The coefficients of a whole span whose coordinates are coupled: of three in closed form where that is
   known, else of parts, joined and doubled. */

/* of 2^(joins + doublings) parts that its wave bound and its waves ask for */
static RD_CLONES void K_(span_by_parts)(const struct rate_matrix *rate, double l,
                                        const struct sweep_cut *cut, cv *coef)
{
    enum { SIZE = FULL + 2 * SYM };
    cv one[SIZE], two[SIZE];
    const int all = cut->joins + cut->doublings, undamped = slice_is_real(rate);
    K_(slice)(rate, ldexp(l, -all), cut->terms, one);
    for (int k = 0; k < cut->joins; k++) {
    KEEP for (int i = 0; i < SIZE; i++)
            two[i] = one[i];
        if (undamped)
            NAME(real_join, RD_WIDTH)(NULL, NULL, RD_NO_TERM, two, two, one);
        else
            K_(join)(NULL, NULL, RD_NO_TERM, two, two, one);
    }
    K_(coefficients)(one, coef, 0);
    for (int k = 0; k < cut->doublings; k++) {
        KEEP for (int i = 0; i < SIZE; i++)
            one[i] = coef[i];
        K_(twice)(NULL, NULL, RD_NO_TERM, one, coef);
    }
}

/* of element e; steps: as many as its rounding counts for */
static void K_(make_coupled)(const struct rd_chain *chain, const struct sweep_block *b, size_t e,
                             const struct sweep_cut *cut, cv *coef, lanes *steps)
{
    struct rate_matrix rate;
    const double length = chain->length[e], turned = ldexp(1.0, cut->doublings);
    K_(make_rate)(chain, b, e, &rate);
    *steps = l_fill(turned * turned);
#if RD_WIDTH == 3
    if (rate.z >= 0) {
        const lanes all = l_fill(length);
        struct three_span span;
        rd_three_span(&rate, &all, &span);
        const lane_mask missing = ~span.found;
        if (some(missing))
            K_(span_by_parts)(&rate, length, cut, coef);
        cv *A = coef, *B = A + SYM, *C = B + FULL;
        for (int i = 0; i < SYM; i++) {
            A[i] = c_where(span.found, span.A[i], A[i]);
            C[i] = c_where(span.found, span.C[i], C[i]);
        }
        for (int i = 0; i < FULL; i++)
            B[i] = c_where(span.found, span.B[i], B[i]);
        const lanes radians = 1.0 + span.radians;
        *steps = l_select(span.found, radians * radians, *steps);
        return;
    }
#endif
    K_(span_by_parts)(&rate, length, cut, coef);
}

#endif
