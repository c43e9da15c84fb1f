/* The plane of plane.h from and to what is scattered, and the elements that it passes.
   Included by sweep/kernel/plane.h. */

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
