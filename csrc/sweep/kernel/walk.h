/* Many steps in a row.
   Included by sweep/kernel/width.h, once per width. */

/* Count steps over equal pieces with node term t (negative: none) before each. */
static RD_CLONES void K_(walk_pieces)(const struct sweep_walk *s, const cv *piece, int32_t t,
                                      size_t count, struct sweep_state *state)
{
    cv U[SYM], N[SYM];
    UNROLL for (int i = 0; i < SYM; i++) {
        U[i] = state->U[i];
        N[i] = c_zero();
    }
    if (t >= 0)
        K_(node_term)(s->chain, s->way, (size_t)t, N);
    for (size_t k = 0; k < count; k++)
        K_(step)(piece, N, U, state->E, state->rows);
    UNROLL for (int i = 0; i < SYM; i++)
        state->U[i] = U[i];
    KEEP for (int i = 0; count > 0 && i < SYM; i++)
        state->A[i] = c_size(piece[i]);
}

/* Count steps from `node` in the direction of the way, over the chain's own elements and nodes. */
static RD_CLONES void K_(walk)(const struct sweep_walk *s, size_t node, size_t count,
                               struct sweep_state *state)
{
    const struct rd_chain *chain = s->chain;
    const size_t backward = (size_t)s->way->backward;
    const int apart = backward ? RD_COUPLED : RD_COUPLED | RD_HINGED;
    cv U[SYM], N[SYM], own[FULL + 2 * SYM];
    cv *coef = own;
    size_t stretch = state->stretch;
    int32_t made = -1;
    UNROLL for (int i = 0; i < SYM; i++) {
        U[i] = state->U[i];
        N[i] = c_zero();
    }
    for (size_t k = 0; k < count; k++) {
        const size_t i = backward ? node - k : node + k, term = (size_t)chain->term[stretch];
        stretch -= backward && (size_t)chain->first[stretch] == i;
        const int32_t e = chain->element[stretch];
        stretch += !backward && (size_t)chain->first[stretch + 1] == i + 1;
        if (e != made) {
            coef = s->coefficients ? s->coefficients + (size_t)e * (FULL + 2 * SYM) : own;
            if (!s->coefficients || sweep_is_first(&s->made->coefficients, e))
                K_(make_single)(chain, s->block, (size_t)e, coef);
            made = e;
        }
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
        K_(step)(coef, N, U, state->E, state->rows);
        const size_t next = (size_t)chain->term[stretch];
        if (backward && (s->trait[next] & RD_HINGED)) {
            UNROLL for (int j = 0; j < SYM; j++)
                state->U[j] = U[j];
            K_(open_all)(s, next, state);
            UNROLL for (int j = 0; j < SYM; j++)
                U[j] = state->U[j];
        }
    }
    state->stretch = stretch;
    UNROLL for (int i = 0; i < SYM; i++)
        state->U[i] = U[i];
    KEEP for (int i = 0; count > 0 && i < SYM; i++)
        state->A[i] = c_size(coef[i]);
}
