/* Real minors (sweep/kernel/plane.h) across what is joined or whole, where nothing is damped.
   Included by sweep/kernel/width.h for the width 2. */

/* R^-1 <- R^-1 + Q, R <- F R F^T + G of a piece's triple, F = I + D */
RD_INLINE void K_(plane_triple)(struct N_(plane) * plane, const lanes *triple)
{
    const lanes *D = triple, *G = D + FULL, *Q = G + SYM;
    N_(load_z)(plane, Q[0], 1);
    N_(load_beta)(plane, Q[2]);
    N_(load_skew)(plane, Q[1]);
    struct N_(minors) *p = &plane->p;
    /* D R + R D^T + D R D^T = Y + Y^T + Y D^T, Y = D R */
    const lanes zz = D[0] * p->a + D[1] * p->b, zb = D[0] * p->b + D[1] * p->c;
    const lanes bz = D[2] * p->a + D[3] * p->b, bb = D[2] * p->b + D[3] * p->c;
    const lanes a = p->a + (zz + zz + (zz * D[0] + zb * D[1]));
    const lanes b = p->b + (zb + bz + (zz * D[2] + zb * D[3]));
    const lanes c = p->c + (bb + bb + (bz * D[2] + bb * D[3]));
    const lanes more = D[0] + D[3] + (D[0] * D[3] - D[1] * D[2]); /* det F - 1 */
    const lanes e = p->e + p->e * (more * (more + 2.0));
    p->a = a + G[0] * p->d;
    p->b = b + G[1] * p->d;
    p->c = c + G[2] * p->d;
    p->e = e + (G[0] * p->c + G[2] * a) - G[1] * (b + p->b);
}

/* the node in front, where no coordinate is held or coupled by more than mass */
static RD_CLONES void K_(walk_node)(const struct sweep_walk *s, size_t term,
                                    struct sweep_state *state)
{
    struct N_(plane) p = N_(plane_in)(state);
    N_(plane_node)(s, term, (lanes){0}, &p);
    N_(plane_out)(&p, state);
}

/* Count equal pieces with node term t (negative: none) before each. */
static RD_CLONES void K_(walk_triples)(const struct sweep_walk *s, const cv *triple, int32_t t,
                                       size_t count, struct sweep_state *state)
{
    struct N_(plane) p = N_(plane_in)(state);
    lanes piece[FULL + 2 * SYM];
    UNROLL for (int i = 0; i < FULL + 2 * SYM; i++)
        piece[i] = triple[i].re;
    for (size_t k = 0; k < count; k++) {
        if (t >= 0)
            N_(plane_node)(s, (size_t)t, (lanes){0}, &p);
        K_(plane_triple)(&p, piece);
        N_(plane_level)(&p);
    }
    N_(plane_out)(&p, state);
}

/* a whole plain span of element e's section */
static RD_CLONES void K_(make_compound)(const struct rd_chain *chain, const struct sweep_block *b,
                                        size_t e, double length, struct bent_compound *x)
{
    const double Sbb = chain->flexibility[9 * e + 3 * RD_BENDING + RD_BENDING];
    const double *p = chain->inertia + e * W;
    const lanes inertia = b->inertia.re, soft = b->soft.re * Sbb;
    /* wavenumbers without the scales, whose rounding would turn the phase */
    const struct bent_numbers numbers = {
        .theta = soft * (b->tension.re * chain->tension[e] + inertia * p[1]),
        .K = -inertia * p[0] * soft,
        .soft = b->flex[SYM - 1].re * Sbb,
        .lever = b->ratio[0],
        .length = l_fill(length),
    };
    bent_compound_fill(&numbers, x);
}

static RD_CLONES void K_(walk_compound)(const struct bent_compound *x, struct sweep_state *state)
{
    const struct N_(plane) from = N_(plane_in)(state);
    struct N_(plane) to = from;
    bent_compound_apply(x, &to.p.d);
    if (x->some_brief) {
        struct N_(plane) near = from;
        K_(plane_triple)(&near, x->triple);
        const lanes *one = &near.p.d;
        lanes *other = &to.p.d;
        KEEP for (int i = 0; i < 5; i++)
            other[i] = l_select(x->brief, one[i], other[i]);
    }
    N_(plane_level)(&to);
    N_(plane_out)(&to, state);
}
