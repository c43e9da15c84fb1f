/* The coefficients of a whole span whose coordinates are coupled: of three in closed form where that is known,
   else of parts, joined and doubled. Included by sweep/kernel/width.h, once per width from 3 on. */
#include "span/three_waves.h"

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
