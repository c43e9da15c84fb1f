/* The scaled triple of one element and its scattering coefficients.
   Included by sweep/kernel/width.h, once per width. */

/* G of an element that bends, scaled, with the shape functions p (see element/triple.h):
       G_ij = flex_ij (S_bb rho_i rho_j l^(1+k) P_k),  k the number of z among i, j
   with rho_c = S_cb/S_bb for the channels c that bending drives and 1 for z and beta. */
RD_INLINE void K_(flexibility)(const struct rd_chain *chain, size_t e, const struct sweep_block *b,
                               const struct shape_lanes *p, cv *G)
{
    const double l = chain->length[e];
    const double *S = chain->flexibility + 9 * e;
    const double Sbb = S[3 * RD_BENDING + RD_BENDING];
    const cv bent[3] = {c_scale(p->P0, Sbb * l), c_scale(p->P1, Sbb * l * l),
                        c_scale(p->P2, Sbb * l * l * l)};
    UNROLL for (int i = 0; i < W; i++)
        UNROLL for (int j = i; j < W; j++) {
            const int c = b->channel[i], d = b->channel[j];
            const double ri = c == RD_BENDING ? 1.0 : S[3 * c + RD_BENDING] / Sbb;
            const double rj = d == RD_BENDING ? 1.0 : S[3 * d + RD_BENDING] / Sbb;
            const cv flex = b->flex[at(i, j)];
            if (c != RD_BENDING && d != RD_BENDING) {
                const cv stiffened = c_scale(p->less, ri * rj * Sbb * l);
                G[at(i, j)] = c_mul(flex, c_add(c_real(S[3 * c + d] * l), stiffened));
            } else {
                const cv g = c_mul(flex, bent[b->arm[i] + b->arm[j]]);
                G[at(i, j)] = c == d ? g : c_scale(g, ri * rj);
            }
        }
}

#if RD_WIDTH > 1
/* adds w/T times the area under z to x, see element/triple.h; x and z are the first two coordinates */
static void K_(hang)(const struct rd_chain *chain, size_t e, const struct sweep_block *b, cv *D,
                     cv *G)
{
    const double *S = chain->flexibility + 9 * e;
    const double l = chain->length[e], T = chain->tension[e], sag = chain->sag[e];
    const double Sbb = S[3 * RD_BENDING + RD_BENDING], soft = sag * Sbb * l * l * l;
    const lanes across = b->z[1] / b->z[0];
    D[1] = (cv){sag * l * across, (lanes){0}};
    if (!b->bends) {
        G[1] = c_scale_lanes(b->slack, across * (0.5 * sag * l * l / T));
        G[0] = c_add(G[0], c_scale_lanes(b->slack, across * across * (sag * sag * l * l * l / T / 3)));
        return;
    }
    const struct area_lanes a = rd_area_lanes_at(chain->kind, c_scale(b->series.phi, T * Sbb * l * l));
    KEEP for (int j = 0; j < W; j++) {
        const int c = b->channel[j];
        const double r = c == RD_BENDING ? 1.0 : S[3 * c + RD_BENDING] / Sbb;
        const cv g = b->arm[j] ? c_scale(a.P[1], soft * l) : c_scale(a.P[0], soft * r);
        G[at(0, j)] = c_add(G[at(0, j)], c_mul(b->flex[at(0, j)], j == 0 ? c_add(g, g) : g));
    }
    G[0] = c_add(G[0], c_mul(b->flex[0], c_scale(a.P[2], soft * sag * l * l)));
    D[W - 1] = c_add(D[W - 1], c_scale_lanes(a.lean, sag * l * l * b->ratio[0]));
}
#endif

/* The triple of one element, scaled: D = F - I, G, Q.
       D_z,beta = l tau,  D_c,beta = -rho_c theta P_1,  Q_beta,beta = T l tau */
RD_INLINE void K_(straight)(const struct rd_chain *chain, size_t e, const struct sweep_block *b,
                            cv *triple)
{
    cv *D = triple, *G = triple + FULL, *Q = G + SYM;
    const double l = chain->length[e], T = chain->tension[e];
    const double *S = chain->flexibility + 9 * e;
    UNROLL for (int i = 0; i < FULL; i++)
        D[i] = c_zero();
    UNROLL for (int i = 0; i < SYM; i++)
        Q[i] = c_zero();
    if (!b->bends) {
        UNROLL for (int i = 0; i < W; i++)
            UNROLL for (int j = i; j < W; j++) {
                const int c = b->channel[i], d = b->channel[j];
                cv g = c_zero();
                if (c != RD_BENDING && d != RD_BENDING)
                    g = c_scale(b->flex[at(i, j)], S[3 * c + d] * l);
                else if (i == j)
                    g = c_scale(b->slack, l / T);
                G[at(i, j)] = g;
            }
        return;
    }
    const double Sbb = S[3 * RD_BENDING + RD_BENDING];
    const double s = T * Sbb * l * l;
    const cv theta = c_scale(b->series.phi, s);
    struct shape_lanes p;
    shape_functions(chain->kind, &b->series, s, &p);
    K_(flexibility)(chain, e, b, &p, G);
    const cv turn = c_neg(c_mul(theta, p.P1));
    UNROLL for (int i = 0; i < W; i++) {
        const int c = b->channel[i];
        cv d;
        if (b->arm[i])
            d = c_scale(p.tau, l);
        else
            d = c == RD_BENDING ? turn : c_scale(turn, S[3 * c + RD_BENDING] / Sbb);
        D[i * W + W - 1] = c_scale_lanes(d, b->ratio[i]);
    }
    Q[SYM - 1] = c_scale(c_mul(b->pull, p.tau), T * l);
}

RD_INLINE void K_(element)(const struct rd_chain *chain, size_t e, const struct sweep_block *b,
                           cv *triple)
{
    K_(straight)(chain, e, b, triple);
#if RD_WIDTH > 1
    if (chain->sag)
        K_(hang)(chain, e, b, triple, triple + FULL);
#endif
}

/* K = (G - i I)^-1,  A = K G,  B = K F,  W = -i I + Q + F^T B
   plain: a single straight element, whose D has its last column only */
RD_INLINE void K_(coefficients)(const cv *triple, cv *coef, const int plain)
{
    const cv *D = triple, *G = triple + FULL, *Q = G + SYM;
    cv *A = coef, *B = coef + SYM, *C = B + FULL;
    cv m[FULL], K[FULL];
    UNROLL for (int i = 0; i < W; i++)
        UNROLL for (int j = 0; j < W; j++) {
            m[i * W + j] = G[at(i, j)];
            if (i == j)
                m[i * W + j].im -= 1.0;
        }
    const cv s = c_inverse(K_(adjugate)(m, K));
    UNROLL for (int i = 0; i < FULL; i++)
        K[i] = c_mul(K[i], s);
    UNROLL for (int i = 0; i < W; i++)
        UNROLL for (int j = i; j < W; j++) {
            cv sum = c_mul(K[i * W], G[at(0, j)]);
            UNROLL for (int k = 1; k < W; k++)
                sum = c_add(sum, c_mul(K[i * W + k], G[at(k, j)]));
            A[at(i, j)] = sum;
        }
    UNROLL for (int i = 0; i < W; i++)
        UNROLL for (int j = 0; j < W; j++)
            B[i * W + j] = plain && j < W - 1 ? K[i * W + j]
                                              : c_add(K[i * W + j], K_(dot_nn)(K, D, i, j));
    UNROLL for (int i = 0; i < W; i++)
        UNROLL for (int j = i; j < W; j++) {
            cv sum = B[i * W + j];
            if (!plain || i == W - 1)
                sum = c_add(Q[at(i, j)], c_add(sum, K_(dot_tn)(D, B, i, j)));
            if (i == j)
                sum.im -= 1.0;
            C[at(i, j)] = sum;
        }
}

/* A rigid strut's triple has a pole where the chain has none: there the string is taken beside the
   element without it. With k = T/l, the element's u_b = A s - i B u_a and a = A e_z, the string
   pulls by k (z_b - z_a) = kappa (a^T s - i v^T u_a):

       A <- A + i kappa a a^T,  B <- B + kappa a v^T,  W <- W + kappa v v^T
       kappa = k/(1 - i k A_zz),  v = (I + i B)^T e_z = a + i K_zz D^T e_z */
RD_INLINE void K_(strut)(const struct rd_chain *chain, const struct sweep_block *b, size_t e,
                         cv *coef)
{
    cv triple[FULL + 2 * SYM], *D = triple, *G = D + FULL, *A = coef, *B = A + SYM, *C = B + FULL;
    const double l = chain->length[e];
    const struct shape_lanes untensed = {c_real(1.0), c_real(0.5), c_real(1.0 / 3.0), c_zero(),
                                         c_zero()};
    const int z = b->arm[0] ? 0 : 1;
    KEEP for (int i = 0; i < FULL + 2 * SYM; i++)
        triple[i] = c_zero();
    K_(flexibility)(chain, e, b, &untensed, G);
    const cv lever = {l * b->ratio[z], (lanes){0}};
    D[z * W + W - 1] = lever;
    K_(coefficients)(triple, coef, 1);
    const lanes zz = 1.0 / (b->ratio[z] * b->ratio[z]);
    const cv k = c_scale(c_scale_lanes(b->pull, zz), chain->tension[e] / l);
    cv a[W], v[W];
    KEEP for (int i = 0; i < W; i++)
        v[i] = a[i] = A[at(z, i)];
    v[W - 1] = c_add(v[W - 1], c_times_i(c_mul(B[z * W + z], lever)));
    cv d = c_neg(c_times_i(c_mul(k, a[z])));
    d.re += 1.0;
    const cv kappa = c_mul(k, c_inverse(d));
    KEEP for (int i = 0; i < W; i++)
        KEEP for (int j = 0; j < W; j++) {
            const cv av = c_mul(kappa, c_mul(a[i], v[j]));
            B[i * W + j] = c_add(B[i * W + j], av);
            if (j < i)
                continue;
            A[at(i, j)] = c_add(A[at(i, j)], c_times_i(c_mul(kappa, c_mul(a[i], a[j]))));
            C[at(i, j)] = c_add(C[at(i, j)], c_mul(kappa, c_mul(v[i], v[j])));
        }
}

static RD_CLONES void K_(make_element)(const struct rd_chain *chain, const struct sweep_block *b,
                                       size_t e, cv *triple)
{
    K_(element)(chain, e, b, triple);
}

static RD_CLONES void K_(make_coefficients)(const cv *triple, cv *coef)
{
    K_(coefficients)(triple, coef, 0);
}

/* the coefficients of one element; its triple stays behind */
static RD_CLONES void K_(make_single)(const struct rd_chain *chain, const struct sweep_block *b,
                                      size_t e, cv *coef)
{
    if (sweep_is_strut(chain, e)) {
        K_(strut)(chain, b, e, coef);
        return;
    }
    cv triple[FULL + 2 * SYM];
    K_(element)(chain, e, b, triple);
    if (chain->sag)
        K_(make_coefficients)(triple, coef);
    else
        K_(coefficients)(triple, coef, 1);
}
