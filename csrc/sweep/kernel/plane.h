/* Width 2, and width 3 with bending, without rows: the plane of (u, f) behind the walk, without a
   division. Included by sweep/kernel/width.h, once per width. */

/* The minors of the plane u = R f of two coordinates (z, beta):
       (d, a, b, c, e) = d (1, R_00, R_01, R_11, det R), any common factor d.
   Steps are linear in them: they pass poles of R (d = 0) and zeros of all of R alike. */
struct K_(minors) {
    cv d, a, b, c, e;
};

/* A third coordinate o (twist or stretch), R = [[Z, q], [q^T, r]] with Z of (z, beta):
       p  those of Z;  o  d (r, r Z - q q^T, det R), those with row and column o;
       u, f  d q and d adj(Z) q, those with row o alone. */
struct K_(plane) {
    struct K_(minors) p;
#if RD_WIDTH == 3
    struct K_(minors) o;
    cv u[2], f[2];
#endif
};

/* x += a y; real: a is */
RD_INLINE void K_(more)(cv *x, cv a, cv y, int real)
{
    if (real)
        *x = c_add(*x, c_scale_lanes(y, a.re));
    else
        *x = c_add(*x, c_mul(a, y));
}

/* R^-1 <- R^-1 + n E of (z, beta), with E = diag(1, 0), diag(0, 1) and [[0, 1], [1, 0]] */
RD_INLINE void K_(load_z)(struct K_(plane) * p, cv n, int real)
{
    K_(more)(&p->p.d, n, p->p.a, real);
    K_(more)(&p->p.c, n, p->p.e, real);
#if RD_WIDTH == 3
    K_(more)(&p->o.d, n, p->o.a, real);
    K_(more)(&p->o.c, n, p->o.e, real);
    K_(more)(&p->u[1], n, p->f[1], real);
#endif
}
RD_INLINE void K_(load_beta)(struct K_(plane) * p, cv n)
{
    K_(more)(&p->p.d, n, p->p.c, 0);
    K_(more)(&p->p.a, n, p->p.e, 0);
#if RD_WIDTH == 3
    K_(more)(&p->o.d, n, p->o.c, 0);
    K_(more)(&p->o.a, n, p->o.e, 0);
    K_(more)(&p->u[0], n, p->f[0], 0);
#endif
}
RD_INLINE void K_(load_skew_minors)(struct K_(minors) * p, cv n)
{
    const cv b = c_sub(p->b, c_mul(n, p->e));
    K_(more)(&p->d, n, c_add(p->b, b), 0);
    p->b = b;
}
RD_INLINE void K_(load_skew)(struct K_(plane) * p, cv n)
{
    K_(load_skew_minors)(&p->p, n);
#if RD_WIDTH == 3
    K_(load_skew_minors)(&p->o, n);
    K_(more)(&p->u[0], c_neg(n), p->f[1], 0);
    K_(more)(&p->u[1], c_neg(n), p->f[0], 0);
#endif
}

/* R <- F R F^T + G of the minors of (z, beta),  F = I + (x, y) e_1^T, yy = y^2 + 2 y */
RD_INLINE void K_(bend)(struct K_(minors) * p, const cv *plain)
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

/* x <- x s */
RD_INLINE void K_(scale_minors)(struct K_(minors) * p, lanes s)
{
    p->d = c_scale_lanes(p->d, s);
    p->a = c_scale_lanes(p->a, s);
    p->b = c_scale_lanes(p->b, s);
    p->c = c_scale_lanes(p->c, s);
    p->e = c_scale_lanes(p->e, s);
}
RD_INLINE lanes K_(size_of_minors)(const struct K_(minors) * p)
{
    return c_size(p->d) + c_size(p->a) + c_size(p->b) + c_size(p->c) + c_size(p->e);
}

#if RD_WIDTH == 2

/* R = -i (I - U)^-1 U */
RD_INLINE struct K_(plane) K_(plane_of)(const struct sweep_block *block, const cv *U)
{
    (void)block;
    const cv dU = c_sub(c_mul(U[0], U[2]), c_mul(U[1], U[1]));
    const cv a = c_sub(U[0], dU), c = c_sub(U[2], dU);
    cv d = c_sub(c_neg(a), U[2]);
    d.re += 1.0;
    return (struct K_(plane)){{
        d,
        {a.im, -a.re},
        {U[1].im, -U[1].re},
        {c.im, -c.re},
        c_neg(dU),
    }};
}

/* U = R (R - i I)^-1 = (det R I - i R)/det(R - i I) */
RD_INLINE void K_(scatter)(const struct sweep_block *block, const struct K_(plane) * plane, cv *U)
{
    (void)block;
    const struct K_(minors) *p = &plane->p;
    const cv trace = c_add(p->a, p->c);
    const cv q = {p->e.re - p->d.re + trace.im, p->e.im - p->d.im - trace.re};
    const cv s = c_inverse(q);
    U[0] = c_mul(s, (cv){p->e.re + p->a.im, p->e.im - p->a.re});
    U[1] = c_mul(s, (cv){p->b.im, -p->b.re});
    U[2] = c_mul(s, (cv){p->e.re + p->c.im, p->e.im - p->c.re});
}

RD_INLINE void K_(plane_element)(struct K_(plane) * p, const cv *plain)
{
    K_(bend)(&p->p, plain);
}

#else

/* R^-1 <- R^-1 + n e_o e_o^T */
RD_INLINE void K_(load_other)(struct K_(plane) * p, cv n, int real)
{
    K_(more)(&p->p.d, n, p->o.d, real);
    K_(more)(&p->p.a, n, p->o.a, real);
    K_(more)(&p->p.b, n, p->o.b, real);
    K_(more)(&p->p.c, n, p->o.c, real);
    K_(more)(&p->p.e, n, p->o.e, real);
}
/* u_o <- u_o + r u_beta:  q <- q + r Z_beta, adj(Z) q <- adj(Z) q + r det Z e_beta */
RD_INLINE void K_(shear)(struct K_(plane) * p, cv r)
{
    const cv u = p->u[1], f = p->f[1];
    K_(more)(&p->u[0], r, p->p.b, 1);
    K_(more)(&p->u[1], r, p->p.c, 1);
    K_(more)(&p->f[1], r, p->p.e, 1);
    K_(more)(&p->o.d, r, c_add(u, p->u[1]), 1);
    K_(more)(&p->o.a, r, c_add(f, p->f[1]), 1);
    K_(more)(&p->o.b, c_neg(r), p->f[0], 1);
}

/* The other channel follows bending by r u_beta, and beyond that it is a rod of its own: so the
   element is that of (z, beta), q <- F q, adj(Z) q <- det F^2 F^-T adj(Z) q with adj(Z) made anew
   by G, and the flexibility g of o. */
RD_INLINE void K_(plane_element)(struct K_(plane) * p, const cv *plain)
{
    const cv x = plain[0], y = plain[1], yy = plain[2];
    const cv G0 = plain[3], G1 = plain[4], G2 = plain[5], g = plain[7];
    const cv r = plain[8];
    K_(shear)(p, c_neg(r));
    K_(more)(&p->u[0], x, p->u[1], 0);
    K_(more)(&p->u[1], y, p->u[1], 0);
    const cv turned = c_sub(p->f[1], c_mul(x, p->f[0]));
    p->f[0] = c_add(p->f[0], c_mul(yy, p->f[0]));
    p->f[1] = c_add(turned, c_mul(y, turned));
    p->f[0] = c_add(p->f[0], c_sub(c_mul(G2, p->u[0]), c_mul(G1, p->u[1])));
    p->f[1] = c_add(p->f[1], c_sub(c_mul(G0, p->u[1]), c_mul(G1, p->u[0])));
    K_(bend)(&p->p, plain);
    K_(bend)(&p->o, plain);
    K_(more)(&p->o.d, g, p->p.d, 0);
    K_(more)(&p->o.a, g, p->p.a, 0);
    K_(more)(&p->o.b, g, p->p.b, 0);
    K_(more)(&p->o.c, g, p->p.c, 0);
    K_(more)(&p->o.e, g, p->p.e, 0);
    K_(shear)(p, r);
}

/* With V = I - U:  d R = -i adj(V) U,  d adj(R) = -adj(U) V,  d = det V,  d det R = i det U */
static struct K_(plane) K_(plane_of)(const struct sweep_block *block, const cv *U)
{
    const int z = block->arm[0] ? 0 : 1, o = 1 - z, beta = 2;
    cv full[FULL], V[FULL], adjU[FULL], adjV[FULL], R[FULL], A[FULL];
    KEEP for (int i = 0; i < W; i++)
        KEEP for (int j = 0; j < W; j++) {
            full[i * W + j] = U[at(i, j)];
            V[i * W + j] = c_neg(U[at(i, j)]);
            V[i * W + j].re += i == j ? 1.0 : 0.0;
        }
    const cv dU = K_(adjugate)(full, adjU), d = K_(adjugate)(V, adjV);
    KEEP for (int i = 0; i < W; i++)
        KEEP for (int j = 0; j < W; j++) {
            R[i * W + j] = c_neg(c_times_i(K_(dot_nn)(adjV, full, i, j)));
            A[i * W + j] = c_neg(K_(dot_nn)(adjU, V, i, j));
        }
    return (struct K_(plane)){
        .p = {d, R[z * W + z], R[z * W + beta], R[beta * W + beta], A[o * W + o]},
        .o = {R[o * W + o], A[beta * W + beta], c_neg(A[z * W + beta]), A[z * W + z],
              c_times_i(dU)},
        .u = {R[z * W + o], R[beta * W + o]},
        .f = {c_neg(A[z * W + o]), c_neg(A[beta * W + o])},
    };
}

/* U det(R - i I) = (det R - i tr adj(R)) I + i adj(R) - R,
   det(R - i I) = det R - i tr adj(R) - tr R + i */
static void K_(scatter)(const struct sweep_block *block, const struct K_(plane) * p, cv *U)
{
    const int z = block->arm[0] ? 0 : 1, o = 1 - z, beta = 2;
    const cv rods = c_add(c_add(p->p.a, p->p.c), p->o.d);
    const cv both = c_add(c_add(p->o.a, p->o.c), p->p.e);
    const cv whole = c_sub(p->o.e, c_times_i(both));
    const cv s = c_inverse(c_add(c_sub(whole, rods), c_times_i(p->p.d)));
    U[at(z, z)] = c_mul(s, c_sub(c_add(whole, c_times_i(p->o.c)), p->p.a));
    U[at(beta, beta)] = c_mul(s, c_sub(c_add(whole, c_times_i(p->o.a)), p->p.c));
    U[at(o, o)] = c_mul(s, c_sub(c_add(whole, c_times_i(p->p.e)), p->o.d));
    U[at(z, beta)] = c_neg(c_mul(s, c_add(c_times_i(p->o.b), p->p.b)));
    U[at(z, o)] = c_neg(c_mul(s, c_add(c_times_i(p->f[0]), p->u[0])));
    U[at(beta, o)] = c_neg(c_mul(s, c_add(c_times_i(p->f[1]), p->u[1])));
}

#endif

/* the common factor out, before it overflows */
RD_INLINE void K_(plane_level)(struct K_(plane) * p)
{
#if RD_WIDTH == 2
    K_(scale_minors)(&p->p, 1.0 / K_(size_of_minors)(&p->p));
#else
    const lanes rows = c_size(p->u[0]) + c_size(p->u[1]) + c_size(p->f[0]) + c_size(p->f[1]);
    const lanes s = 1.0 / (K_(size_of_minors)(&p->p) + K_(size_of_minors)(&p->o) + rows);
    K_(scale_minors)(&p->p, s);
    K_(scale_minors)(&p->o, s);
    KEEP for (int i = 0; i < 2; i++) {
        p->u[i] = c_scale_lanes(p->u[i], s);
        p->f[i] = c_scale_lanes(p->f[i], s);
    }
#endif
}

/* x, y, yy, G_zz, G_zbeta, G_betabeta, Q_betabeta, g, r of an element: see sweep/kernel/element.h
   for the triple. g and r take the other channel o apart:
       G_oo = g + r^2 G_betabeta,  G_zo = r G_zbeta,  G_obeta = r G_betabeta,  D_obeta = r y */
static RD_CLONES void K_(make_plain)(const struct rd_chain *chain, const struct sweep_block *b,
                                     size_t e, cv *plain)
{
    const double l = chain->length[e], T = chain->tension[e];
    const double *S = chain->flexibility + 9 * e;
    const double Sbb = S[3 * RD_BENDING + RD_BENDING], s = T * Sbb * l * l;
#if RD_WIDTH == 2
    const int z = 0;
    if (!b->bends) {
        cv triple[FULL + 2 * SYM];
        K_(element)(chain, e, b, triple);
        for (int i = 0; i < RD_PLAIN; i++)
            plain[i] = i < 3 || i > 5 ? c_zero() : triple[i + 1];
        return;
    }
#else
    const int z = b->arm[0] ? 0 : 1, o = 1 - z, c = b->channel[o];
    const double rho = S[3 * c + RD_BENDING] / Sbb;
    plain[7] = c_scale(b->flex[at(o, o)], l * (S[4 * c] - rho * rho * Sbb));
    plain[8] = (cv){rho * b->ratio[o], (lanes){0}};
#endif
    struct shape_lanes p;
    shape_functions(chain->kind, &b->series, s, &p);
    const cv y = c_mul(c_scale(b->series.phi, -s), p.P1);
    cv twice = y;
    twice.re += 2.0;
    plain[0] = c_scale_lanes(p.tau, l * b->ratio[z]);
    plain[1] = y;
    plain[2] = c_mul(y, twice);
    plain[3] = c_mul(b->flex[at(z, z)], c_scale(p.P2, Sbb * l * l * l));
    plain[4] = c_mul(b->flex[at(z, W - 1)], c_scale(p.P1, Sbb * l * l));
    plain[5] = c_mul(b->flex[at(W - 1, W - 1)], c_scale(p.P0, Sbb * l));
    plain[6] = c_mul(b->pull, c_scale(p.tau, T * l));
}

/* inertia and springs of a node, and the element's own stiffness on beta */
RD_INLINE void K_(plane_node)(const struct sweep_walk *s, size_t t, cv own, struct K_(plane) * p)
{
    const struct sweep_way *way = s->way;
    const double *m = s->chain->mass + t * FULL, *k = s->chain->stiffness + t * FULL;
    const int trait = s->trait[t], real = s->block->real;
    const int z = W == 2 || s->block->arm[0] ? 0 : 1;
    cv n[W];
    UNROLL for (int i = 0; i < W; i++) {
        n[i] = c_scale(way->inertia[at(i, i)], m[i * (W + 1)]);
        if (trait & RD_SPRUNG)
            n[i] = c_add(n[i], c_scale(way->spring[at(i, i)], k[i * (W + 1)]));
    }
#if RD_WIDTH == 3
    K_(load_other)(p, n[1 - z], real);
#endif
    K_(load_z)(p, n[z], real);
    K_(load_beta)(p, c_add(own, n[W - 1]));
    if (trait & RD_SKEW)
        K_(load_skew)(p, c_scale(way->inertia[at(z, W - 1)], m[z * W + W - 1]));
}

/* As K_(walk) over the chain's own elements and nodes, while no row is carried. */
static RD_CLONES void K_(walk_plain)(const struct sweep_walk *s, size_t node, size_t count,
                                     struct sweep_state *state)
{
    const struct rd_chain *chain = s->chain;
    struct K_(plane) p = K_(plane_of)(s->block, state->U);
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
            K_(make_plain)(chain, s->block, (size_t)e, own);
            made = e;
        }
        const int absorbed = k == 0 && state->absorbed;
        if (s->trait[t] & apart) {
            K_(scatter)(s->block, &p, state->U);
            K_(leave)(s, t, absorbed, state);
            p = K_(plane_of)(s->block, state->U);
            K_(load_beta)(&p, plain[6]);
        } else if (absorbed) {
            K_(load_beta)(&p, plain[6]);
        } else {
            K_(plane_node)(s, t, plain[6], &p);
        }
        K_(plane_element)(&p, plain);
        if (k % 4 == 3)
            K_(plane_level)(&p);
        const size_t next = (size_t)chain->term[stretch];
        if (backward && (s->trait[next] & RD_HINGED)) {
            K_(scatter)(s->block, &p, state->U);
            K_(open_all)(s, next, state);
            p = K_(plane_of)(s->block, state->U);
        }
    }
    state->stretch = stretch;
    K_(scatter)(s->block, &p, state->U);
    KEEP for (int i = 0; count > 0 && i < SYM; i++)
        state->A[i] = (lanes){0};
}
