/* Two pieces joined into one.
   Included by sweep/kernel/width.h, once per width. */

/* Two pieces and the node term t (negative: none) between them, Q2 <- Q2 + N, M = (I + G1 Q2)^-1:
       D = D1 + D2 + D2 D1 - F2 M G1 Q2 F1,  G = G2 + F2 M G1 F2^T,  Q = Q1 + F1^T Q2 M F1 */
static RD_CLONES void K_(join)(const struct rd_chain *chain, const struct sweep_way *way, int32_t t,
                               const cv *one, const cv *two, cv *joined)
{
    const cv *D1 = one, *G1 = D1 + FULL, *Q1 = G1 + SYM;
    const cv *D2 = two, *G2 = D2 + FULL, *Q2n = G2 + SYM;
    cv N[SYM], Q2[SYM], m[FULL], M[FULL], X[FULL], Y[FULL], F1[FULL], F2[FULL];
    cv F2X[FULL], QF1[FULL], YF1[FULL], D[FULL], G[SYM], Q[SYM];
    UNROLL for (int i = 0; i < SYM; i++)
        N[i] = c_zero();
    if (t >= 0)
        K_(node_term)(chain, way, (size_t)t, N);
    UNROLL for (int i = 0; i < SYM; i++)
        Q2[i] = c_add(Q2n[i], N[i]);
    K_(sym_times_sym)(G1, Q2, m);
    UNROLL for (int i = 0; i < W; i++)
        m[i * W + i].re += 1.0;
    const cv s = c_inverse(K_(adjugate)(m, M));
    UNROLL for (int i = 0; i < FULL; i++) {
        M[i] = c_mul(M[i], s);
        F1[i] = D1[i];
        F2[i] = D2[i];
    }
    UNROLL for (int i = 0; i < W; i++) {
        F1[i * W + i].re += 1.0;
        F2[i * W + i].re += 1.0;
    }
    K_(times_sym)(M, G1, X);
    UNROLL for (int i = 0; i < W; i++)
        UNROLL for (int j = 0; j < W; j++) {
            cv y = c_mul(Q2[at(i, 0)], M[j]), q = c_mul(Q2[at(i, 0)], F1[j]);
            UNROLL for (int k = 1; k < W; k++) {
                y = c_add(y, c_mul(Q2[at(i, k)], M[k * W + j]));
                q = c_add(q, c_mul(Q2[at(i, k)], F1[k * W + j]));
            }
            Y[i * W + j] = y;
            QF1[i * W + j] = q;
        }
    UNROLL for (int i = 0; i < W; i++)
        UNROLL for (int j = 0; j < W; j++) {
            F2X[i * W + j] = K_(dot_nn)(F2, X, i, j);
            YF1[i * W + j] = K_(dot_nn)(Y, F1, i, j);
        }
    UNROLL for (int i = 0; i < W; i++)
        UNROLL for (int j = 0; j < W; j++) {
            const cv straight = c_add(c_add(D1[i * W + j], D2[i * W + j]),
                                      K_(dot_nn)(D2, D1, i, j));
            D[i * W + j] = c_sub(straight, K_(dot_nn)(F2X, QF1, i, j));
        }
    UNROLL for (int i = 0; i < W; i++)
        UNROLL for (int j = i; j < W; j++) {
            G[at(i, j)] = c_add(G2[at(i, j)], K_(dot_nt)(F2X, F2, i, j));
            Q[at(i, j)] = c_add(Q1[at(i, j)], K_(dot_tn)(F1, YF1, i, j));
        }
    UNROLL for (int i = 0; i < FULL; i++)
        joined[i] = D[i];
    UNROLL for (int i = 0; i < SYM; i++) {
        joined[FULL + i] = G[i];
        joined[FULL + SYM + i] = Q[i];
    }
}
