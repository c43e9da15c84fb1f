/* Width 2 without rows: the plane of (u, f) behind the walk, without a division.
   Included by sweep_width.h, once per width. */

/* The minors of the plane:
   u = R f as p = (d, a, b, c, e) = d (1, R_00, R_01, R_11, det R), any common factor d. Steps are
   linear in p: it passes poles of R (d = 0) and zeros of all of R alike. */
struct K_(plane) {
    cv d, a, b, c, e;
};

/* R = -i (I - U)^-1 U */
RD_INLINE struct K_(plane) K_(plane_of)(const cv *U)
{
    const cv dU = c_sub(c_mul(U[0], U[2]), c_mul(U[1], U[1]));
    const cv a = c_sub(U[0], dU), c = c_sub(U[2], dU);
    cv d = c_sub(c_neg(a), U[2]);
    d.re += 1.0;
    return (struct K_(plane)){
        d, {a.im, -a.re}, {U[1].im, -U[1].re}, {c.im, -c.re}, c_neg(dU),
    };
}

/* U = R (R - i I)^-1 = (det R I - i R)/det(R - i I) */
RD_INLINE void K_(scatter)(const struct K_(plane) * p, cv *U)
{
    const cv trace = c_add(p->a, p->c);
    const cv q = {p->e.re - p->d.re + trace.im, p->e.im - p->d.im - trace.re};
    const cv s = c_inverse(q);
    U[0] = c_mul(s, (cv){p->e.re + p->a.im, p->e.im - p->a.re});
    U[1] = c_mul(s, (cv){p->b.im, -p->b.re});
    U[2] = c_mul(s, (cv){p->e.re + p->c.im, p->e.im - p->c.re});
}

/* R^-1 <- R^-1 + diag(n0, n1) */
RD_INLINE void K_(plane_node)(struct K_(plane) * p, cv n0, cv n1)
{
    p->d = c_add(p->d, c_mul(n0, p->a));
    p->c = c_add(p->c, c_mul(n0, p->e));
    p->d = c_add(p->d, c_mul(n1, p->c));
    p->a = c_add(p->a, c_mul(n1, p->e));
}

/* R <- F R F^T + G,  F = I + (x, y) e_1^T */
RD_INLINE void K_(plane_element)(struct K_(plane) * p, const cv *plain)
{
    const cv x = plain[0], y = plain[1], yy = plain[2];
    const cv G0 = plain[3], G1 = plain[4], G2 = plain[5];
    const cv t = c_add(p->b, c_mul(x, p->c));
    const cv a = c_add(p->a, c_mul(x, c_add(p->b, t)));
    const cv b = c_add(t, c_mul(y, t));
    const cv c = c_add(p->c, c_mul(yy, p->c));
    const cv e = c_add(p->e, c_mul(yy, p->e));
    p->a = c_add(a, c_mul(G0, p->d));
    p->b = c_add(b, c_mul(G1, p->d));
    p->c = c_add(c, c_mul(G2, p->d));
    p->e = c_sub(c_add(e, c_add(c_mul(G0, p->c), c_mul(G2, a))), c_mul(G1, c_add(b, p->b)));
}

/* the common factor out, before it overflows */
RD_INLINE void K_(plane_level)(struct K_(plane) * p)
{
    const lanes s =
        1.0 / (c_size(p->d) + c_size(p->a) + c_size(p->b) + c_size(p->c) + c_size(p->e));
    p->d = c_scale_lanes(p->d, s);
    p->a = c_scale_lanes(p->a, s);
    p->b = c_scale_lanes(p->b, s);
    p->c = c_scale_lanes(p->c, s);
    p->e = c_scale_lanes(p->e, s);
}

RD_INLINE void K_(plain)(const struct rd_chain *chain, const struct sweep_block *b, size_t e,
                         cv *plain)
{
    cv triple[FULL + 2 * SYM];
    K_(element)(chain, e, b, triple);
    cv twice = triple[3];
    twice.re += 2.0;
    plain[0] = triple[1];
    plain[1] = triple[3];
    plain[2] = c_mul(triple[3], twice);
    plain[3] = triple[4];
    plain[4] = triple[5];
    plain[5] = triple[6];
    plain[6] = triple[9];
}

static RD_CLONES void K_(make_plain)(const struct rd_chain *chain, const struct sweep_block *b,
                                     size_t e, cv *plain)
{
    K_(plain)(chain, b, e, plain);
}

/* As K_(walk) over the chain's own elements and nodes, while no row is carried. */
static RD_CLONES void K_(walk_plain)(const struct sweep_walk *s, size_t node, size_t count,
                                     struct sweep_state *state)
{
    const struct rd_chain *chain = s->chain;
    const cv spring0 = s->way->spring[0], inertia0 = s->way->inertia[0];
    const cv spring1 = s->way->spring[2], inertia1 = s->way->inertia[2];
    struct K_(plane) p = K_(plane_of)(state->U);
    cv own[RD_PLAIN];
    const cv *plain = own;
    const size_t backward = (size_t)s->way->backward;
    const int apart = backward ? RD_COUPLED : RD_COUPLED | RD_HINGED;
    size_t stretch = state->stretch;
    int32_t made = -1;
    for (size_t k = 0; k < count; k++) {
        const size_t i = backward ? node - k : node + k, t = (size_t)chain->term[stretch];
        stretch -= backward && (size_t)chain->first[stretch] == i;
        const int32_t e = chain->element[stretch];
        stretch += !backward && (size_t)chain->first[stretch + 1] == i + 1;
        if (s->plain) {
            plain = s->plain + (size_t)e * RD_PLAIN;
        } else if (e != made) {
            K_(plain)(chain, s->block, (size_t)e, own);
            made = e;
        }
        cv n0 = c_zero(), n1 = plain[6];
        const int absorbed = k == 0 && state->absorbed;
        if (s->trait[t] & apart) {
            K_(scatter)(&p, state->U);
            K_(leave)(s, t, absorbed, state);
            p = K_(plane_of)(state->U);
        } else if (!absorbed) {
            const double *m = chain->mass + t * FULL;
            n0 = c_scale(inertia0, m[0]);
            n1 = c_add(n1, c_scale(inertia1, m[3]));
            if (s->trait[t] & RD_SPRUNG) {
                const double *c = chain->stiffness + t * FULL;
                n0 = c_add(n0, c_scale(spring0, c[0]));
                n1 = c_add(n1, c_scale(spring1, c[3]));
            }
        }
        K_(plane_node)(&p, n0, n1);
        K_(plane_element)(&p, plain);
        if (k % 4 == 3)
            K_(plane_level)(&p);
        const size_t next = (size_t)chain->term[stretch];
        if (backward && (s->trait[next] & RD_HINGED)) {
            K_(scatter)(&p, state->U);
            K_(open_all)(s, next, state);
            p = K_(plane_of)(state->U);
        }
    }
    state->stretch = stretch;
    K_(scatter)(&p, state->U);
}
