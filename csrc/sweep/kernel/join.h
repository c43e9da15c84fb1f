/* Two pieces joined into one.
   Included by sweep/kernel/width.h, once per width and kind of number. */

/* N = spring stiffness + inertia mass + dashpot damping, scaled, seen in the direction of the walk */
RD_INLINE void N_(node_term)(const struct rd_chain *chain, const struct sweep_way *way, size_t t,
                             num *N)
{
    const double *k = chain->stiffness + t * FULL, *m = chain->mass + t * FULL;
    UNROLL for (int i = 0; i < W; i++)
        UNROLL for (int j = i; j < W; j++)
            N[at(i, j)] = n_(add)(n_(scale)(n_(of)(way->spring[at(i, j)]), k[i * W + j]),
                                n_(scale)(n_(of)(way->inertia[at(i, j)]), m[i * W + j]));
    const double *d = chain->damping ? chain->damping + t * FULL : NULL;
    if (d)
        KEEP for (int i = 0; i < W; i++)
            KEEP for (int j = i; j < W; j++)
                N[at(i, j)] = n_(add)(N[at(i, j)], n_(scale)(n_(of)(way->dashpot[at(i, j)]), d[i * W + j]));
}

/* Two pieces and the node term t (negative: none) between them, Q2 <- Q2 + N, M = (I + G1 Q2)^-1:
       D = D1 + D2 + D2 D1 - F2 M G1 Q2 F1,  G = G2 + F2 M G1 F2^T,  Q = Q1 + F1^T Q2 M F1 */
static RD_CLONES void N_(join)(const struct rd_chain *chain, const struct sweep_way *way, int32_t t,
                               const cv *one, const cv *two, cv *joined)
{
    num first[FULL + 2 * SYM], second[FULL + 2 * SYM];
    UNROLL for (int i = 0; i < FULL + 2 * SYM; i++) {
        first[i] = n_(of)(one[i]);
        second[i] = n_(of)(two[i]);
    }
    const num *D1 = first, *G1 = D1 + FULL, *Q1 = G1 + SYM;
    const num *D2 = second, *G2 = D2 + FULL, *Q2n = G2 + SYM;
    num N[SYM], Q2[SYM], m[FULL], M[FULL], X[FULL], Y[FULL], F1[FULL], F2[FULL];
    num F2X[FULL], QF1[FULL], YF1[FULL], D[FULL], G[SYM], Q[SYM];
    UNROLL for (int i = 0; i < SYM; i++)
        N[i] = n_(zero)();
    if (t >= 0)
        N_(node_term)(chain, way, (size_t)t, N);
    UNROLL for (int i = 0; i < SYM; i++)
        Q2[i] = n_(add)(Q2n[i], N[i]);
    N_(sym_times_sym)(G1, Q2, m);
    UNROLL for (int i = 0; i < W; i++)
        m[i * W + i] = n_(plus)(m[i * W + i], 1.0);
    const num s = n_(inverse)(N_(adjugate)(m, M));
    UNROLL for (int i = 0; i < FULL; i++) {
        M[i] = n_(mul)(M[i], s);
        F1[i] = D1[i];
        F2[i] = D2[i];
    }
    UNROLL for (int i = 0; i < W; i++) {
        F1[i * W + i] = n_(plus)(F1[i * W + i], 1.0);
        F2[i * W + i] = n_(plus)(F2[i * W + i], 1.0);
    }
    N_(times_sym)(M, G1, X);
    UNROLL for (int i = 0; i < W; i++)
        UNROLL for (int j = 0; j < W; j++) {
            num y = n_(mul)(Q2[at(i, 0)], M[j]), q = n_(mul)(Q2[at(i, 0)], F1[j]);
            UNROLL for (int k = 1; k < W; k++) {
                y = n_(add)(y, n_(mul)(Q2[at(i, k)], M[k * W + j]));
                q = n_(add)(q, n_(mul)(Q2[at(i, k)], F1[k * W + j]));
            }
            Y[i * W + j] = y;
            QF1[i * W + j] = q;
        }
    UNROLL for (int i = 0; i < W; i++)
        UNROLL for (int j = 0; j < W; j++) {
            F2X[i * W + j] = N_(dot_nn)(F2, X, i, j);
            YF1[i * W + j] = N_(dot_nn)(Y, F1, i, j);
        }
    UNROLL for (int i = 0; i < W; i++)
        UNROLL for (int j = 0; j < W; j++) {
            const num straight = n_(add)(n_(add)(D1[i * W + j], D2[i * W + j]),
                                      N_(dot_nn)(D2, D1, i, j));
            D[i * W + j] = n_(sub)(straight, N_(dot_nn)(F2X, QF1, i, j));
        }
    UNROLL for (int i = 0; i < W; i++)
        UNROLL for (int j = i; j < W; j++) {
            G[at(i, j)] = n_(add)(G2[at(i, j)], N_(dot_nt)(F2X, F2, i, j));
            Q[at(i, j)] = n_(add)(Q1[at(i, j)], N_(dot_tn)(F1, YF1, i, j));
        }
    UNROLL for (int i = 0; i < FULL; i++)
        joined[i] = n_(as_complex)(D[i]);
    UNROLL for (int i = 0; i < SYM; i++) {
        joined[FULL + i] = n_(as_complex)(G[i]);
        joined[FULL + SYM + i] = n_(as_complex)(Q[i]);
    }
}
