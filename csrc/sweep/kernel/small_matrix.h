/* Products and adjugates of small complex matrices.
   Included by sweep/kernel/width.h, once per width. */

/* m x = adjugate(m) x det^-1: no pivoting, the same operations for every lane */
RD_INLINE cv K_(adjugate)(const cv *m, cv *x)
{
#if RD_WIDTH == 1
    x[0] = c_real(1.0);
    return m[0];
#elif RD_WIDTH == 2
    x[0] = m[3];
    x[1] = c_neg(m[1]);
    x[2] = c_neg(m[2]);
    x[3] = m[0];
    return c_sub(c_mul(m[0], m[3]), c_mul(m[1], m[2]));
#elif RD_WIDTH == 3
    UNROLL for (int i = 0; i < 3; i++)
        UNROLL for (int j = 0; j < 3; j++) {
            const int r = (j + 1) % 3, s = (j + 2) % 3, c = (i + 1) % 3, d = (i + 2) % 3;
            x[3 * i + j] = c_sub(c_mul(m[3 * r + c], m[3 * s + d]),
                                 c_mul(m[3 * r + d], m[3 * s + c]));
        }
    return c_add(c_mul(m[0], x[0]), c_add(c_mul(m[1], x[3]), c_mul(m[2], x[6])));
#else
    /* Laplace's expansion by the 2x2 minors of the upper and of the lower two rows */
    cv p[6], q[6];
    int k = 0;
    UNROLL for (int i = 0; i < 4; i++)
        for (int j = i + 1; j < 4; j++, k++) {
            p[k] = c_sub(c_mul(m[i], m[4 + j]), c_mul(m[j], m[4 + i]));
            q[k] = c_sub(c_mul(m[8 + i], m[12 + j]), c_mul(m[8 + j], m[12 + i]));
        }
#define MIX(a, b, c, x0, x1, x2) c_add(c_sub(c_mul(a, x0), c_mul(b, x1)), c_mul(c, x2))
    x[0] = MIX(m[5], m[6], m[7], q[5], q[4], q[3]);
    x[1] = c_neg(MIX(m[1], m[2], m[3], q[5], q[4], q[3]));
    x[2] = MIX(m[13], m[14], m[15], p[5], p[4], p[3]);
    x[3] = c_neg(MIX(m[9], m[10], m[11], p[5], p[4], p[3]));
    x[4] = c_neg(MIX(m[4], m[6], m[7], q[5], q[2], q[1]));
    x[5] = MIX(m[0], m[2], m[3], q[5], q[2], q[1]);
    x[6] = c_neg(MIX(m[12], m[14], m[15], p[5], p[2], p[1]));
    x[7] = MIX(m[8], m[10], m[11], p[5], p[2], p[1]);
    x[8] = MIX(m[4], m[5], m[7], q[4], q[2], q[0]);
    x[9] = c_neg(MIX(m[0], m[1], m[3], q[4], q[2], q[0]));
    x[10] = MIX(m[12], m[13], m[15], p[4], p[2], p[0]);
    x[11] = c_neg(MIX(m[8], m[9], m[11], p[4], p[2], p[0]));
    x[12] = c_neg(MIX(m[4], m[5], m[6], q[3], q[1], q[0]));
    x[13] = MIX(m[0], m[1], m[2], q[3], q[1], q[0]);
    x[14] = c_neg(MIX(m[12], m[13], m[14], p[3], p[1], p[0]));
    x[15] = MIX(m[8], m[9], m[10], p[3], p[1], p[0]);
#undef MIX
    const cv even = c_add(c_add(c_mul(p[0], q[5]), c_mul(p[2], q[3])),
                          c_add(c_mul(p[3], q[2]), c_mul(p[5], q[0])));
    return c_sub(even, c_add(c_mul(p[1], q[4]), c_mul(p[4], q[1])));
#endif
}

/* x = a s, s packed symmetric */
RD_INLINE void K_(times_sym)(const cv *a, const cv *s, cv *x)
{
    UNROLL for (int i = 0; i < W; i++)
        UNROLL for (int j = 0; j < W; j++) {
            cv sum = c_mul(a[i * W], s[at(0, j)]);
            UNROLL for (int k = 1; k < W; k++)
                sum = c_add(sum, c_mul(a[i * W + k], s[at(k, j)]));
            x[i * W + j] = sum;
        }
}

/* x = s t of two packed symmetric matrices, full */
RD_INLINE void K_(sym_times_sym)(const cv *s, const cv *t, cv *x)
{
    UNROLL for (int i = 0; i < W; i++)
        UNROLL for (int j = 0; j < W; j++) {
            cv sum = c_mul(s[at(i, 0)], t[at(0, j)]);
            UNROLL for (int k = 1; k < W; k++)
                sum = c_add(sum, c_mul(s[at(i, k)], t[at(k, j)]));
            x[i * W + j] = sum;
        }
}

/* (i, j) of a b, of a b^T and of a^T b */
RD_INLINE cv K_(dot_nn)(const cv *a, const cv *b, int i, int j)
{
    cv sum = c_mul(a[i * W], b[j]);
    UNROLL for (int k = 1; k < W; k++)
        sum = c_add(sum, c_mul(a[i * W + k], b[k * W + j]));
    return sum;
}

RD_INLINE cv K_(dot_nt)(const cv *a, const cv *b, int i, int j)
{
    cv sum = c_mul(a[i * W], b[j * W]);
    UNROLL for (int k = 1; k < W; k++)
        sum = c_add(sum, c_mul(a[i * W + k], b[j * W + k]));
    return sum;
}

RD_INLINE cv K_(dot_tn)(const cv *a, const cv *b, int i, int j)
{
    cv sum = c_mul(a[i], b[j]);
    UNROLL for (int k = 1; k < W; k++)
        sum = c_add(sum, c_mul(a[k * W + i], b[k * W + j]));
    return sum;
}
