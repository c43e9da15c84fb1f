/* Width 2, and width 3 with bending, without rows: the plane of (u, f) behind the walk, without a
   division. Included by sweep/kernel/width.h, once per width and kind of number. */

/* The minors of the plane u = R f of two coordinates (z, beta):
       (d, a, b, c, e) = d (1, R_00, R_01, R_11, det R), any common factor d.
   Steps are linear in them: they pass poles of R (d = 0) and zeros of all of R alike. */
struct N_(minors) {
    num d, a, b, c, e;
};

/* A third coordinate o (twist or stretch), R = [[Z, q], [q^T, r]] with Z of (z, beta):
       p  those of Z;  o  d (r, r Z - q q^T, det R), those with row and column o;
       u, f  d q and d adj(Z) q, those with row o alone. */
struct N_(plane) {
    struct N_(minors) p;
#if RD_WIDTH == 3
    struct N_(minors) o;
    num u[2], f[2];
#endif
};

/* x += a y; real: a is */
RD_INLINE void N_(more)(num *x, num a, num y, int real)
{
    if (real)
        *x = n_(add)(*x, n_(scale_lanes)(y, n_(lanes)(a)));
    else
        *x = n_(add)(*x, n_(mul)(a, y));
}

/* R^-1 <- R^-1 + n E of (z, beta), with E = diag(1, 0), diag(0, 1) and [[0, 1], [1, 0]] */
RD_INLINE void N_(load_z)(struct N_(plane) * p, num n, int real)
{
    N_(more)(&p->p.d, n, p->p.a, real);
    N_(more)(&p->p.c, n, p->p.e, real);
#if RD_WIDTH == 3
    N_(more)(&p->o.d, n, p->o.a, real);
    N_(more)(&p->o.c, n, p->o.e, real);
    N_(more)(&p->u[1], n, p->f[1], real);
#endif
}
RD_INLINE void N_(load_beta)(struct N_(plane) * p, num n)
{
    N_(more)(&p->p.d, n, p->p.c, 0);
    N_(more)(&p->p.a, n, p->p.e, 0);
#if RD_WIDTH == 3
    N_(more)(&p->o.d, n, p->o.c, 0);
    N_(more)(&p->o.a, n, p->o.e, 0);
    N_(more)(&p->u[0], n, p->f[0], 0);
#endif
}
RD_INLINE void N_(load_skew_minors)(struct N_(minors) * p, num n)
{
    const num b = n_(sub)(p->b, n_(mul)(n, p->e));
    N_(more)(&p->d, n, n_(add)(p->b, b), 0);
    p->b = b;
}
RD_INLINE void N_(load_skew)(struct N_(plane) * p, num n)
{
    N_(load_skew_minors)(&p->p, n);
#if RD_WIDTH == 3
    N_(load_skew_minors)(&p->o, n);
    N_(more)(&p->u[0], n_(neg)(n), p->f[1], 0);
    N_(more)(&p->u[1], n_(neg)(n), p->f[0], 0);
#endif
}

/* R <- F R F^T + G of the minors of (z, beta),  F = I + (x, y) e_1^T, yy = y^2 + 2 y */
RD_INLINE void N_(bend)(struct N_(minors) * p, const cv *plain)
{
    const num x = n_(of)(plain[0]), y = n_(of)(plain[1]), yy = n_(of)(plain[2]);
    const num G0 = n_(of)(plain[3]), G1 = n_(of)(plain[4]), G2 = n_(of)(plain[5]);
    const num t = n_(add)(p->b, n_(mul)(x, p->c));
    const num a = n_(add)(p->a, n_(mul)(x, n_(add)(p->b, t)));
    const num b = n_(add)(t, n_(mul)(y, t));
    const num c = n_(add)(p->c, n_(mul)(yy, p->c));
    const num e = n_(add)(p->e, n_(mul)(yy, p->e));
    p->a = n_(add)(a, n_(mul)(G0, p->d));
    p->b = n_(add)(b, n_(mul)(G1, p->d));
    p->c = n_(add)(c, n_(mul)(G2, p->d));
    p->e = n_(sub)(n_(add)(e, n_(add)(n_(mul)(G0, p->c), n_(mul)(G2, a))),
                   n_(mul)(G1, n_(add)(b, p->b)));
}

/* x <- x s */
RD_INLINE void N_(scale_minors)(struct N_(minors) * p, lanes s)
{
    p->d = n_(scale_lanes)(p->d, s);
    p->a = n_(scale_lanes)(p->a, s);
    p->b = n_(scale_lanes)(p->b, s);
    p->c = n_(scale_lanes)(p->c, s);
    p->e = n_(scale_lanes)(p->e, s);
}
RD_INLINE lanes N_(size_of_minors)(const struct N_(minors) * p)
{
    return n_(size)(p->d) + n_(size)(p->a) + n_(size)(p->b) + n_(size)(p->c) + n_(size)(p->e);
}

#if RD_WIDTH == 2

RD_INLINE void N_(plane_element)(struct N_(plane) * p, const cv *plain)
{
    N_(bend)(&p->p, plain);
}

#else

/* R^-1 <- R^-1 + n e_o e_o^T */
RD_INLINE void N_(load_other)(struct N_(plane) * p, num n, int real)
{
    N_(more)(&p->p.d, n, p->o.d, real);
    N_(more)(&p->p.a, n, p->o.a, real);
    N_(more)(&p->p.b, n, p->o.b, real);
    N_(more)(&p->p.c, n, p->o.c, real);
    N_(more)(&p->p.e, n, p->o.e, real);
}
/* u_o <- u_o + r u_beta:  q <- q + r Z_beta, adj(Z) q <- adj(Z) q + r det Z e_beta */
RD_INLINE void N_(shear)(struct N_(plane) * p, num r)
{
    const num u = p->u[1], f = p->f[1];
    N_(more)(&p->u[0], r, p->p.b, 1);
    N_(more)(&p->u[1], r, p->p.c, 1);
    N_(more)(&p->f[1], r, p->p.e, 1);
    N_(more)(&p->o.d, r, n_(add)(u, p->u[1]), 1);
    N_(more)(&p->o.a, r, n_(add)(f, p->f[1]), 1);
    N_(more)(&p->o.b, n_(neg)(r), p->f[0], 1);
}

/* The other channel follows bending by r u_beta, and beyond that it is a rod of its own: so the
   element is that of (z, beta), q <- F q, adj(Z) q <- det F^2 F^-T adj(Z) q with adj(Z) made anew
   by G, and the flexibility g of o. */
RD_INLINE void N_(plane_element)(struct N_(plane) * p, const cv *plain)
{
    const num x = n_(of)(plain[0]), y = n_(of)(plain[1]), yy = n_(of)(plain[2]);
    const num G0 = n_(of)(plain[3]), G1 = n_(of)(plain[4]), G2 = n_(of)(plain[5]),
              g = n_(of)(plain[7]);
    const num r = n_(of)(plain[8]);
    N_(shear)(p, n_(neg)(r));
    N_(more)(&p->u[0], x, p->u[1], 0);
    N_(more)(&p->u[1], y, p->u[1], 0);
    const num turned = n_(sub)(p->f[1], n_(mul)(x, p->f[0]));
    p->f[0] = n_(add)(p->f[0], n_(mul)(yy, p->f[0]));
    p->f[1] = n_(add)(turned, n_(mul)(y, turned));
    p->f[0] = n_(add)(p->f[0], n_(sub)(n_(mul)(G2, p->u[0]), n_(mul)(G1, p->u[1])));
    p->f[1] = n_(add)(p->f[1], n_(sub)(n_(mul)(G0, p->u[1]), n_(mul)(G1, p->u[0])));
    N_(bend)(&p->p, plain);
    N_(bend)(&p->o, plain);
    N_(more)(&p->o.d, g, p->p.d, 0);
    N_(more)(&p->o.a, g, p->p.a, 0);
    N_(more)(&p->o.b, g, p->p.b, 0);
    N_(more)(&p->o.c, g, p->p.c, 0);
    N_(more)(&p->o.e, g, p->p.e, 0);
    N_(shear)(p, r);
}

#endif

/* the common factor out, before it overflows */
RD_INLINE void N_(plane_level)(struct N_(plane) * p)
{
#if RD_WIDTH == 2
    N_(scale_minors)(&p->p, 1.0 / N_(size_of_minors)(&p->p));
#else
    const lanes rows =
        n_(size)(p->u[0]) + n_(size)(p->u[1]) + n_(size)(p->f[0]) + n_(size)(p->f[1]);
    const lanes s = 1.0 / (N_(size_of_minors)(&p->p) + N_(size_of_minors)(&p->o) + rows);
    N_(scale_minors)(&p->p, s);
    N_(scale_minors)(&p->o, s);
    KEEP for (int i = 0; i < 2; i++) {
        p->u[i] = n_(scale_lanes)(p->u[i], s);
        p->f[i] = n_(scale_lanes)(p->f[i], s);
    }
#endif
}

/* from and to what is scattered, and the elements that it passes */

#if !RD_REAL
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

#else

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

#else /* RD_REAL */

/* the largest of some numbers and what was the largest before */
RD_INLINE void K_(keep_largest)(cv a, cv *largest, lanes *most)
{
    const lanes size = c_size(a);
    const lane_mask more = size > *most;
    *most = l_select(more, size, *most);
    *largest = (cv){l_select(more, a.re, largest->re), l_select(more, a.im, largest->im)};
}

/* Undamped, all minors have one phase, which the common factor takes: that of the largest. */
RD_INLINE struct N_(plane) N_(plane_of)(const struct sweep_block *block, const cv *U)
{
    const struct K_(plane) from = K_(plane_of)(block, U);
    const cv *part = (const cv *)&from;
    struct N_(plane) to;
    lanes *into = (lanes *)&to, most = {0};
    cv largest = c_real(1.0);
    KEEP for (size_t i = 0; i < sizeof from / sizeof *part; i++)
        K_(keep_largest)(part[i], &largest, &most);
    const lanes per = 1.0 / (largest.re * largest.re + largest.im * largest.im);
    const lanes re = largest.re * per, im = largest.im * per;
    KEEP for (size_t i = 0; i < sizeof from / sizeof *part; i++)
        into[i] = part[i].re * re + part[i].im * im;
    return to;
}

RD_INLINE void N_(scatter)(const struct sweep_block *block, const struct N_(plane) * plane, cv *U)
{
    struct K_(plane) to;
    const lanes *part = (const lanes *)plane;
    cv *into = (cv *)&to;
    KEEP for (size_t i = 0; i < sizeof to / sizeof *into; i++)
        into[i] = (cv){part[i], (lanes){0}};
    K_(scatter)(block, &to, U);
}

#endif

/* x, y, yy, G_zz, G_zbeta, G_betabeta, Q_betabeta, g, r of an element: see sweep/kernel/element.h
   for the triple. g and r take the other channel o apart:
       G_oo = g + r^2 G_betabeta,  G_zo = r G_zbeta,  G_obeta = r G_betabeta,  D_obeta = r y */
static RD_CLONES void N_(make_plain)(const struct rd_chain *chain, const struct sweep_block *b,
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
    const num tau = n_(of)(p.tau), P1 = n_(of)(p.P1);
    const num y = n_(mul)(n_(scale)(n_(of)(b->series.phi), -s), P1);
    const num all[7] = {
        n_(scale_lanes)(tau, l * b->ratio[z]),
        y,
        n_(mul)(y, n_(plus)(y, 2.0)),
        n_(mul)(n_(of)(b->flex[at(z, z)]), n_(scale)(n_(of)(p.P2), Sbb * l * l * l)),
        n_(mul)(n_(of)(b->flex[at(z, W - 1)]), n_(scale)(P1, Sbb * l * l)),
        n_(mul)(n_(of)(b->flex[at(W - 1, W - 1)]), n_(scale)(n_(of)(p.P0), Sbb * l)),
        n_(mul)(n_(of)(b->pull), n_(scale)(tau, T * l)),
    };
    UNROLL for (int i = 0; i < 7; i++)
        plain[i] = n_(as_complex)(all[i]);
}

/* inertia, springs and dashpots of a node, and the element's own stiffness on beta */
RD_INLINE void N_(plane_node)(const struct sweep_walk *s, size_t t, num own, struct N_(plane) * p)
{
    const struct sweep_way *way = s->way;
    const double *m = s->chain->mass + t * FULL, *k = s->chain->stiffness + t * FULL;
    const int trait = s->trait[t], real = s->block->real && !(trait & RD_DASHED);
    const int z = W == 2 || s->block->arm[0] ? 0 : 1;
    num n[W];
    UNROLL for (int i = 0; i < W; i++) {
        n[i] = n_(scale)(n_(of)(way->inertia[at(i, i)]), m[i * (W + 1)]);
        if (trait & RD_SPRUNG)
            n[i] = n_(add)(n[i], n_(scale)(n_(of)(way->spring[at(i, i)]), k[i * (W + 1)]));
        if (trait & RD_DASHED)
            n[i] = n_(add)(n[i], n_(scale)(n_(of)(way->dashpot[at(i, i)]),
                                           s->chain->damping[t * FULL + (size_t)(i * (W + 1))]));
    }
#if RD_WIDTH == 3
    N_(load_other)(p, n[1 - z], real);
#endif
    N_(load_z)(p, n[z], real);
    N_(load_beta)(p, n_(add)(own, n[W - 1]));
    if (trait & RD_SKEW)
        N_(load_skew)(p, n_(scale)(n_(of)(way->inertia[at(z, W - 1)]), m[z * W + W - 1]));
}

RD_INLINE struct N_(plane) N_(plane_in)(const struct sweep_state *state)
{
    struct N_(plane) p;
    __builtin_memcpy(&p, state->minors, sizeof p);
    return p;
}
RD_INLINE void N_(plane_out)(const struct N_(plane) * p, struct sweep_state *state)
{
    __builtin_memcpy(state->minors, p, sizeof *p);
}

static RD_CLONES void N_(flatten)(const struct sweep_block *block, struct sweep_state *state)
{
    const struct N_(plane) p = N_(plane_of)(block, state->U);
    N_(plane_out)(&p, state);
}

static RD_CLONES void N_(unflatten)(const struct sweep_block *block, struct sweep_state *state)
{
    const struct N_(plane) p = N_(plane_in)(state);
    N_(scatter)(block, &p, state->U);
    KEEP for (int i = 0; i < SYM; i++)
        state->A[i] = (lanes){0};
}

/* As K_(walk) over the chain's own elements and nodes, while no row is carried. */
static RD_CLONES void N_(walk_plain)(const struct sweep_walk *s, size_t node, size_t count,
                                     struct sweep_state *state)
{
    const struct rd_chain *chain = s->chain;
    struct N_(plane) p = N_(plane_in)(state);
    cv own[RD_PLAIN];
    cv *plain = own;
    const size_t backward = (size_t)s->way->backward;
    const int apart = backward ? RD_COUPLED : RD_COUPLED | RD_HINGED;
    size_t stretch = state->stretch;
    int32_t made = -1;
    for (size_t k = 0; k < count; k++) {
        const size_t i = backward ? node - k : node + k, t = (size_t)chain->term[stretch];
        stretch -= backward && (size_t)chain->first[stretch] == i;
        const int32_t e = chain->element[stretch];
        stretch += !backward && (size_t)chain->first[stretch + 1] == i + 1;
        if (e != made) {
            plain = s->plain ? s->plain + (size_t)e * RD_PLAIN : own;
            if (!s->plain || sweep_is_first(&s->made->plain, e))
                N_(make_plain)(chain, s->block, (size_t)e, plain);
            made = e;
        }
        const int absorbed = k == 0 && state->absorbed;
        if (s->trait[t] & apart) {
            N_(scatter)(s->block, &p, state->U);
            K_(leave)(s, t, absorbed, state);
            p = N_(plane_of)(s->block, state->U);
            N_(load_beta)(&p, n_(of)(plain[6]));
        } else if (absorbed) {
            N_(load_beta)(&p, n_(of)(plain[6]));
        } else {
            N_(plane_node)(s, t, n_(of)(plain[6]), &p);
        }
        N_(plane_element)(&p, plain);
        if (k % 4 == 3)
            N_(plane_level)(&p);
        const size_t next = (size_t)chain->term[stretch];
        if (backward && (s->trait[next] & RD_HINGED)) {
            N_(scatter)(s->block, &p, state->U);
            K_(open_all)(s, next, state);
            p = N_(plane_of)(s->block, state->U);
        }
    }
    state->stretch = stretch;
    N_(plane_level)(&p);
    N_(plane_out)(&p, state);
}

#if RD_REAL && RD_WIDTH == 2

/* across joined pieces and whole spans, where nothing is damped */

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

#endif
