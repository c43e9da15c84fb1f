/* One step of the walk: across an element and the node before it.
   Included by sweep/kernel/width.h, once per width. */

/* m = W U + i I, its adjugate and 1/det */
RD_INLINE cv K_(resolve)(const cv *w, const cv *U, cv *adj)
{
    cv m[FULL];
    K_(sym_times_sym)(w, U, m);
    UNROLL for (int i = 0; i < W; i++)
        m[i * W + i].im += 1.0;
    return c_inverse(K_(adjugate)(m, adj));
}

/* X = U (W U + i I)^-1, symmetric */
RD_INLINE void K_(inner)(const cv *w, const cv *U, cv *X)
{
#if RD_WIDTH == 2
    /* U adj(W U + i I) = det U adj W + i U,  det(W U + i I) = det W det U + i tr(W U) - 1 */
    const cv dU = c_sub(c_mul(U[0], U[2]), c_mul(U[1], U[1]));
    const cv dW = c_sub(c_mul(w[0], w[2]), c_mul(w[1], w[1]));
    const cv cross = c_mul(w[1], U[1]);
    const cv trace = c_add(c_add(c_mul(w[0], U[0]), c_mul(w[2], U[2])), c_add(cross, cross));
    cv det = c_add(c_mul(dW, dU), c_times_i(trace));
    det.re -= 1.0;
    const cv s = c_inverse(det), t = c_mul(s, dU), is = c_times_i(s);
    X[0] = c_add(c_mul(t, w[2]), c_mul(is, U[0]));
    X[1] = c_sub(c_mul(is, U[1]), c_mul(t, w[1]));
    X[2] = c_add(c_mul(t, w[0]), c_mul(is, U[2]));
#else
    cv adj[FULL];
    const cv s = K_(resolve)(w, U, adj);
    UNROLL for (int i = 0; i < W; i++)
        UNROLL for (int j = i; j < W; j++) {
            cv sum = c_mul(U[at(i, 0)], adj[j]);
            UNROLL for (int k = 1; k < W; k++)
                sum = c_add(sum, c_mul(U[at(i, k)], adj[k * W + j]));
            X[at(i, j)] = c_mul(sum, s);
        }
#endif
}

/* sum of sizes */
RD_INLINE lanes K_(total)(const cv *x, int count)
{
    lanes sum = c_size(x[0]);
    UNROLL for (int i = 1; i < count; i++)
        sum += c_size(x[i]);
    return sum;
}

/* m where it is more than a row's own rounding, else 0 */
RD_INLINE lanes K_(beyond)(lanes m, const cv *row)
{
    return (lanes)((lane_mask)m & (m > 4.0 * K_(total)(row, W)));
}

/* Rows E <- v B^T, v = E (W U + i I)^-1. Rounding of U and B moves them by v W dU (W U + i I)^-1 B^T
   and by v dB^T, which a heavy node and an element that hardly transmits do not reduce: where that
   is more than rounding of the rows themselves, their companions hear of it. */
static RD_CLONES void K_(carry)(const cv *w, const cv *U, const cv *B, cv *E, size_t rows)
{
    cv adj[FULL];
    const cv s = K_(resolve)(w, U, adj);
    const lanes before = K_(total)(w, SYM) * K_(total)(U, SYM), after = K_(total)(B, FULL);
    lanes passed = {0};
    for (size_t r = 0; r < rows; r++) {
        cv *row = E + r * W, v[W];
        UNROLL for (int j = 0; j < W; j++) {
            cv sum = c_mul(row[0], adj[j]);
            UNROLL for (int k = 1; k < W; k++)
                sum = c_add(sum, c_mul(row[k], adj[k * W + j]));
            v[j] = c_mul(sum, s);
        }
        const lanes size = K_(total)(v, W);
        if (r % 2 == 0)
            sweep_disturb(K_(beyond)(size * before, row), W, row + W);
        UNROLL for (int j = 0; j < W; j++) {
            cv sum = c_mul(v[0], B[j * W]);
            UNROLL for (int k = 1; k < W; k++)
                sum = c_add(sum, c_mul(v[k], B[j * W + k]));
            row[j] = sum;
        }
        if (r % 2 == 0)
            passed = K_(beyond)(size * after, row);
        else
            sweep_disturb(passed, W, row);
    }
}

/* U <- A - i B [U (W U + i I)^-1] B^T and the rows;  N is added to W */
RD_INLINE void K_(step)(const cv *coef, const cv *N, cv *U, cv *E, size_t rows)
{
    const cv *A = coef, *B = coef + SYM, *C = B + FULL;
    cv w[SYM], X[SYM], y[FULL];
    UNROLL for (int i = 0; i < SYM; i++)
        w[i] = c_add(C[i], N[i]);
    if (rows) {
        /* copies: the loop's own U and w stay out of memory that others may change */
        cv w_now[SYM], U_now[SYM];
        UNROLL for (int i = 0; i < SYM; i++) {
            w_now[i] = w[i];
            U_now[i] = U[i];
        }
        K_(carry)(w_now, U_now, B, E, rows);
    }
    K_(inner)(w, U, X);
    K_(times_sym)(B, X, y);
    UNROLL for (int i = 0; i < W; i++)
        UNROLL for (int j = i; j < W; j++) {
            const cv sum = K_(dot_nt)(y, B, i, j);
            U[at(i, j)] = (cv){A[at(i, j)].re + sum.im, A[at(i, j)].im - sum.re};
        }
}

#if RD_WIDTH > 2

/* Two equal pieces and the node term t (negative: none) between them, as coefficients, W <- W + N,
   R = (W A + i I)^-1:

       A - i B A R B^T,  B R^T B,  W - i B^T R W B

   the first as of a step: no frequency is without it. */
static RD_CLONES void K_(twice)(const struct rd_chain *chain, const struct sweep_way *way, int32_t t,
                                const cv *half, cv *whole)
{
    const cv *A = half, *B = half + SYM, *C = B + FULL;
    cv w[SYM], N[SYM], R[FULL], BX[FULL], X[SYM], Z[SYM], ZB[FULL], BR[FULL];
    KEEP for (int i = 0; i < SYM; i++)
        N[i] = c_zero();
    if (t >= 0)
        K_(node_term)(chain, way, (size_t)t, N);
    KEEP for (int i = 0; i < SYM; i++)
        w[i] = c_add(C[i], N[i]);
    const cv s = K_(resolve)(w, A, R);
    UNROLL for (int i = 0; i < FULL; i++)
        R[i] = c_mul(R[i], s);
    UNROLL for (int i = 0; i < W; i++)
        UNROLL for (int j = i; j < W; j++) {
            cv x = c_mul(A[at(i, 0)], R[j]), z = c_mul(R[i * W], w[at(0, j)]);
            UNROLL for (int k = 1; k < W; k++) {
                x = c_add(x, c_mul(A[at(i, k)], R[k * W + j]));
                z = c_add(z, c_mul(R[i * W + k], w[at(k, j)]));
            }
            X[at(i, j)] = x;
            Z[at(i, j)] = z;
        }
    K_(times_sym)(B, X, BX);
    UNROLL for (int i = 0; i < W; i++)
        UNROLL for (int j = 0; j < W; j++) {
            cv sum = c_mul(Z[at(i, 0)], B[j]);
            UNROLL for (int k = 1; k < W; k++)
                sum = c_add(sum, c_mul(Z[at(i, k)], B[k * W + j]));
            ZB[i * W + j] = sum;
            BR[i * W + j] = K_(dot_nt)(B, R, i, j);
        }
    UNROLL for (int i = 0; i < W; i++)
        UNROLL for (int j = 0; j < W; j++) {
            whole[SYM + i * W + j] = K_(dot_nn)(BR, B, i, j);
            if (j < i)
                continue;
            const cv a = K_(dot_nt)(BX, B, i, j), c = K_(dot_tn)(B, ZB, i, j);
            const int p = at(i, j);
            whole[p] = (cv){A[p].re + a.im, A[p].im - a.re};
            whole[SYM + FULL + p] = (cv){C[p].re + c.im, C[p].im - c.re};
        }
}

#endif
