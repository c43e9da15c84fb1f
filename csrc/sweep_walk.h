/* Many steps in a row.
   Included by sweep_width.h, once per width. */

/* Count steps from `node` in the direction of the way: over the chain's own elements and nodes,
   or, where a piece is given, over equal pieces with node term t (negative: none) before each. */
static RD_CLONES void K_(walk)(const struct sweep_walk *s, const cv *piece, int32_t t, size_t node,
                               size_t count, struct sweep_state *state)
{
    const struct rd_chain *chain = s->chain;
    const int apart = s->way->backward ? RD_COUPLED : RD_COUPLED | RD_HINGED;
    cv U[SYM], N[SYM], own[FULL + 2 * SYM];
    const cv *coef = piece;
    cv *const E = state->E;
    const size_t rows = state->rows;
    int32_t made = -1;
    UNROLL for (int i = 0; i < SYM; i++) {
        U[i] = state->U[i];
        N[i] = c_zero();
    }
    if (piece && t >= 0)
        K_(node_term)(chain, s->way, (size_t)t, N);
    for (size_t k = 0; k < count; k++) {
        if (!piece) {
            const size_t i = s->way->backward ? node - k : node + k;
            const int32_t e = chain->element_of[s->way->backward ? i - 1 : i];
            if (s->coefficients) {
                coef = s->coefficients + (size_t)e * (FULL + 2 * SYM);
            } else if (e != made) {
                K_(make_single)(chain, s->block, (size_t)e, own);
                coef = own;
                made = e;
            }
            const size_t term = (size_t)chain->term_of[i];
            const int absorbed = k == 0 && state->absorbed;
            if (s->trait[term] & apart) {
                /* rare, so by way of memory */
                UNROLL for (int j = 0; j < SYM; j++)
                    state->U[j] = U[j];
                K_(leave)(s, term, absorbed, state);
                UNROLL for (int j = 0; j < SYM; j++) {
                    U[j] = state->U[j];
                    N[j] = c_zero();
                }
            } else if (!absorbed) {
                K_(node_term)(chain, s->way, term, N);
            }
        }
        K_(step)(coef, N, U, E, rows);
        if (!piece && s->way->backward) {
            const size_t term = (size_t)chain->term_of[node - k - 1];
            if (s->trait[term] & RD_HINGED) {
                UNROLL for (int j = 0; j < SYM; j++)
                    state->U[j] = U[j];
                K_(open_all)(s, term, state);
                UNROLL for (int j = 0; j < SYM; j++)
                    U[j] = state->U[j];
            }
        }
    }
    UNROLL for (int i = 0; i < SYM; i++)
        state->U[i] = U[i];
}
