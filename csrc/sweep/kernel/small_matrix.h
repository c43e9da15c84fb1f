/* Products and adjugates of small matrices of numbers (sweep/kernel/number.h).
   Included by sweep/kernel/width.h, once per width and kind of number. */

/* m x = adjugate(m) x det^-1: no pivoting, the same operations for every lane */
RD_INLINE num N_(adjugate)(const num *m, num *x)
{
#if RD_WIDTH == 1
    x[0] = n_(real)(1.0);
    return m[0];
#elif RD_WIDTH == 2
    x[0] = m[3];
    x[1] = n_(neg)(m[1]);
    x[2] = n_(neg)(m[2]);
    x[3] = m[0];
    return n_(sub)(n_(mul)(m[0], m[3]), n_(mul)(m[1], m[2]));
#elif RD_WIDTH == 3
    UNROLL for (int i = 0; i < 3; i++)
        UNROLL for (int j = 0; j < 3; j++) {
            const int r = (j + 1) % 3, s = (j + 2) % 3, c = (i + 1) % 3, d = (i + 2) % 3;
            x[3 * i + j] = n_(sub)(n_(mul)(m[3 * r + c], m[3 * s + d]),
                                 n_(mul)(m[3 * r + d], m[3 * s + c]));
        }
    return n_(add)(n_(mul)(m[0], x[0]), n_(add)(n_(mul)(m[1], x[3]), n_(mul)(m[2], x[6])));
#else
    /* Laplace's expansion by the 2x2 minors of the upper and of the lower two rows */
    num p[6], q[6];
    int k = 0;
    UNROLL for (int i = 0; i < 4; i++)
        for (int j = i + 1; j < 4; j++, k++) {
            p[k] = n_(sub)(n_(mul)(m[i], m[4 + j]), n_(mul)(m[j], m[4 + i]));
            q[k] = n_(sub)(n_(mul)(m[8 + i], m[12 + j]), n_(mul)(m[8 + j], m[12 + i]));
        }
#define MIX(a, b, c, x0, x1, x2) n_(add)(n_(sub)(n_(mul)(a, x0), n_(mul)(b, x1)), n_(mul)(c, x2))
    x[0] = MIX(m[5], m[6], m[7], q[5], q[4], q[3]);
    x[1] = n_(neg)(MIX(m[1], m[2], m[3], q[5], q[4], q[3]));
    x[2] = MIX(m[13], m[14], m[15], p[5], p[4], p[3]);
    x[3] = n_(neg)(MIX(m[9], m[10], m[11], p[5], p[4], p[3]));
    x[4] = n_(neg)(MIX(m[4], m[6], m[7], q[5], q[2], q[1]));
    x[5] = MIX(m[0], m[2], m[3], q[5], q[2], q[1]);
    x[6] = n_(neg)(MIX(m[12], m[14], m[15], p[5], p[2], p[1]));
    x[7] = MIX(m[8], m[10], m[11], p[5], p[2], p[1]);
    x[8] = MIX(m[4], m[5], m[7], q[4], q[2], q[0]);
    x[9] = n_(neg)(MIX(m[0], m[1], m[3], q[4], q[2], q[0]));
    x[10] = MIX(m[12], m[13], m[15], p[4], p[2], p[0]);
    x[11] = n_(neg)(MIX(m[8], m[9], m[11], p[4], p[2], p[0]));
    x[12] = n_(neg)(MIX(m[4], m[5], m[6], q[3], q[1], q[0]));
    x[13] = MIX(m[0], m[1], m[2], q[3], q[1], q[0]);
    x[14] = n_(neg)(MIX(m[12], m[13], m[14], p[3], p[1], p[0]));
    x[15] = MIX(m[8], m[9], m[10], p[3], p[1], p[0]);
#undef MIX
    const num even = n_(add)(n_(add)(n_(mul)(p[0], q[5]), n_(mul)(p[2], q[3])),
                          n_(add)(n_(mul)(p[3], q[2]), n_(mul)(p[5], q[0])));
    return n_(sub)(even, n_(add)(n_(mul)(p[1], q[4]), n_(mul)(p[4], q[1])));
#endif
}

/* x = a s, s packed symmetric */
RD_INLINE void N_(times_sym)(const num *a, const num *s, num *x)
{
    UNROLL for (int i = 0; i < W; i++)
        UNROLL for (int j = 0; j < W; j++) {
            num sum = n_(mul)(a[i * W], s[at(0, j)]);
            UNROLL for (int k = 1; k < W; k++)
                sum = n_(add)(sum, n_(mul)(a[i * W + k], s[at(k, j)]));
            x[i * W + j] = sum;
        }
}

/* x = s t of two packed symmetric matrices, full */
RD_INLINE void N_(sym_times_sym)(const num *s, const num *t, num *x)
{
    UNROLL for (int i = 0; i < W; i++)
        UNROLL for (int j = 0; j < W; j++) {
            num sum = n_(mul)(s[at(i, 0)], t[at(0, j)]);
            UNROLL for (int k = 1; k < W; k++)
                sum = n_(add)(sum, n_(mul)(s[at(i, k)], t[at(k, j)]));
            x[i * W + j] = sum;
        }
}

/* (i, j) of a b, of a b^T and of a^T b */
RD_INLINE num N_(dot_nn)(const num *a, const num *b, int i, int j)
{
    num sum = n_(mul)(a[i * W], b[j]);
    UNROLL for (int k = 1; k < W; k++)
        sum = n_(add)(sum, n_(mul)(a[i * W + k], b[k * W + j]));
    return sum;
}

RD_INLINE num N_(dot_nt)(const num *a, const num *b, int i, int j)
{
    num sum = n_(mul)(a[i * W], b[j * W]);
    UNROLL for (int k = 1; k < W; k++)
        sum = n_(add)(sum, n_(mul)(a[i * W + k], b[j * W + k]));
    return sum;
}

RD_INLINE num N_(dot_tn)(const num *a, const num *b, int i, int j)
{
    num sum = n_(mul)(a[i], b[j]);
    UNROLL for (int k = 1; k < W; k++)
        sum = n_(add)(sum, n_(mul)(a[k * W + i], b[k * W + j]));
    return sum;
}
