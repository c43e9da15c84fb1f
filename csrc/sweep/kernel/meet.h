/* Where a response begins and where both parts meet.
   Included by sweep/kernel/width.h, once per width. */

/* A response begins: E <- E + motion U + force V,  V = i (I - U), in the walk's coordinates;
   the force is the one on the part to the left of the node, so its sign turns with the walk.
   Rounding of U moves E by eps of its largest entry in every coordinate, by eps of A where U is little
   of what the last step added, or by eps of the force where it is near I and little is left of I - U:
   its companion says so. */
static RD_CLONES void K_(listen)(const struct sweep_walk *s, const double *motion,
                                 const double *force, const struct sweep_state *state, cv *row)
{
    const cv *U = state->U;
    cv E[W];
    lanes whole = {0}, added = {0};
    KEEP for (int j = 0; j < W; j++)
        E[j] = c_zero();
    KEEP for (int i = 0; i < W; i++) {
        const double d = s->way->sign[i];
        const lanes z = s->block->z[i];
        const double turn = s->way->backward ? -d : d;
        const lanes a = z * (motion ? d * motion[i] : 0.0), b = (force ? turn * force[i] : 0.0) / z;
        whole += l_abs(b);
        KEEP for (int j = 0; j < W; j++)
            added += (l_abs(a) + l_abs(b)) * state->A[at(i, j)];
        KEEP for (int j = 0; j < W; j++) {
            const cv u = U[at(i, j)], v = {u.im, (i == j ? 1.0 : 0.0) - u.re};
            E[j] = c_add(E[j], c_add(c_scale_lanes(u, a), c_scale_lanes(v, b)));
        }
    }
    KEEP for (int j = 0; j < W; j++)
        row[j] = c_add(row[j], E[j]);
    lanes most = sweep_most(E, W);
    most = l_select(whole > most, whole, most);
    sweep_disturb(l_select(added > most, added, most), W, row + W);
}

/* the solution where both parts meet, and the sizes its rounding grows with */
struct K_(meeting) {
    cv UR[SYM], H[FULL];           /* U_R seen forward */
    lanes size[FULL], isize[FULL]; /* |H| term by term, |H^-1| */
    cv bL[W], bR[W];
    lanes cL[W], cR[W];          /* error of b_L, b_R per eps */
};

/* H = U_L + U_R - 2 U_R U_L,  |H| = |U_L| + |U_R| + 2 |U_R| |U_L| and what U_L, U_R are left of */
RD_INLINE void K_(couple)(const struct sweep_walk *s, const cv *UL, const cv *AL, const cv *right,
                          const lanes *AR, struct K_(meeting) *m)
{
    cv prod[FULL], adj[FULL], *H = m->H;
    UNROLL for (int i = 0; i < W; i++)
        UNROLL for (int j = i; j < W; j++)
            m->UR[at(i, j)] = c_scale(right[at(i, j)], s->way->sign[i] * s->way->sign[j]);
    const cv *UR = m->UR;
    K_(sym_times_sym)(UR, UL, prod);
    UNROLL for (int i = 0; i < W; i++)
        UNROLL for (int j = 0; j < W; j++) {
            const cv sum = c_add(UL[at(i, j)], UR[at(i, j)]);
            H[i * W + j] = c_sub(sum, c_scale(prod[i * W + j], 2.0));
            lanes size = c_size(UL[at(i, j)]) + c_size(UR[at(i, j)]);
            size += AL[at(i, j)].re + AR[at(i, j)];
            UNROLL for (int k = 0; k < W; k++)
                size += 2.0 * c_size(UR[at(i, k)]) * c_size(UL[at(k, j)]);
            m->size[i * W + j] = size;
        }
    const cv d = c_inverse(K_(adjugate)(H, adj));
    UNROLL for (int i = 0; i < FULL; i++)
        m->isize[i] = c_size(c_mul(adj[i], d));
}

/* row i of M (W, W + 1) <-> row k where its entry of column k is the larger one */
RD_INLINE void K_(pivot)(cv *M, int i, int k)
{
    cv *a = M + i * (W + 1), *b = M + k * (W + 1);
    const lane_mask larger = c_size(a[k]) > c_size(b[k]);
    UNROLL for (int j = k; j <= W; j++) {
        const cv up = a[j], down = b[j];
        a[j] = (cv){l_select(larger, down.re, up.re), l_select(larger, down.im, up.im)};
        b[j] = (cv){l_select(larger, up.re, down.re), l_select(larger, up.im, down.im)};
    }
}

/* H x = r, of H^T where turned. By elimination: next to a resonance Cramer's rule loses digits in
   all directions, and this only along the mode, which a load at its node does not hear. */
RD_INLINE void K_(solve)(const cv *H, int turned, const cv *r, cv *x)
{
    cv M[W * (W + 1)];
    UNROLL for (int i = 0; i < W; i++) {
        UNROLL for (int j = 0; j < W; j++)
            M[i * (W + 1) + j] = turned ? H[j * W + i] : H[i * W + j];
        M[i * (W + 1) + W] = r[i];
    }
    UNROLL for (int k = 0; k < W; k++) {
        UNROLL for (int i = k + 1; i < W; i++)
            K_(pivot)(M, i, k);
        const cv *row = M + k * (W + 1), per = c_inverse(row[k]);
        UNROLL for (int i = k + 1; i < W; i++) {
            const cv share = c_mul(M[i * (W + 1) + k], per);
            UNROLL for (int j = k + 1; j <= W; j++)
                M[i * (W + 1) + j] = c_sub(M[i * (W + 1) + j], c_mul(share, row[j]));
        }
    }
    UNROLL for (int i = W - 1; i >= 0; i--) {
        cv rest = M[i * (W + 1) + W];
        UNROLL for (int j = i + 1; j < W; j++)
            rest = c_sub(rest, c_mul(M[i * (W + 1) + j], x[j]));
        x[i] = c_mul(rest, c_inverse(M[i * (W + 1) + i]));
    }
}

/* largest diagonal entry of |H^-1| |H| */
RD_INLINE lanes K_(singular)(const struct K_(meeting) *m)
{
    lanes big = {0};
    UNROLL for (int i = 0; i < W; i++) {
        lanes sum = {0};
        UNROLL for (int k = 0; k < W; k++)
            sum += m->isize[i * W + k] * m->size[k * W + i];
        big = l_select(sum <= big, big, sum);
    }
    return big;
}

/* H b_L = U_R (g - i p) - g,  H^T b_R = g - U_L (g + i p) */
RD_INLINE void K_(load)(const struct sweep_walk *s, const double *motion, const double *force,
                        const cv *UL, struct K_(meeting) *m)
{
    cv rL[W], rR[W];
    lanes sL[W], sR[W];
    UNROLL for (int i = 0; i < W; i++) {
        const lanes gi = (force ? force[i] : 0.0) / s->block->z[i];
        rL[i] = (cv){-gi, (lanes){0}};
        rR[i] = (cv){gi, (lanes){0}};
        sL[i] = sR[i] = l_abs(gi);
        UNROLL for (int k = 0; k < W; k++) {
            const lanes z = s->block->z[k];
            const lanes p = z * (motion ? motion[k] : 0.0), g = (force ? force[k] : 0.0) / z;
            rL[i] = c_add(rL[i], c_mul(m->UR[at(i, k)], (cv){g, -p}));
            rR[i] = c_sub(rR[i], c_mul(UL[at(i, k)], (cv){g, p}));
            sL[i] += c_size(m->UR[at(i, k)]) * (l_abs(g) + l_abs(p));
            sR[i] += c_size(UL[at(i, k)]) * (l_abs(g) + l_abs(p));
        }
    }
    K_(solve)(m->H, 0, rL, m->bL);
    K_(solve)(m->H, 1, rR, m->bR);
    UNROLL for (int i = 0; i < W; i++)
        UNROLL for (int k = 0; k < W; k++) {
            sL[i] += m->size[i * W + k] * c_size(m->bL[k]);
            sR[i] += m->size[k * W + i] * c_size(m->bR[k]);
        }
    UNROLL for (int i = 0; i < W; i++) {
        m->cL[i] = c_size(m->bL[i]);
        m->cR[i] = c_size(m->bR[i]);
        UNROLL for (int k = 0; k < W; k++) {
            m->cL[i] += m->isize[i * W + k] * sL[k];
            m->cR[i] += m->isize[k * W + i] * sR[k];
        }
    }
}

/* Left and right part meet at a node that force p and dislocation g (right minus left) load:
       h_r = E_L,r b_L + E_R,r b_R
   and rounding of relative size 1 in U_L, U_R and E changes h_r by at most
       |E| |H^-1| (|H| |b| + |rhs|) + |E| |b| + |companion b|.
   singular: the largest diagonal entry of |H^-1| |H|, which no scaling changes. */
static RD_CLONES void K_(meet)(const struct sweep_walk *s, const double *motion,
                               const double *force, const cv *left, const struct sweep_state *right,
                               size_t rows, cv *value, lanes *error, lanes *singular)
{
    const cv *EL = left + 2 * SYM, *ER = right->E_all;
    struct K_(meeting) m;
    K_(couple)(s, left, left + SYM, right->U, right->A, &m);
    K_(load)(s, motion, force, left, &m);
    *singular = K_(singular)(&m);
    KEEP for (size_t r = 0; r < rows; r++) {
        const cv *left_row = EL + 2 * r * W, *right_row = ER + 2 * r * W;
        cv sum = c_zero(), apart = c_zero();
        lanes size = {0};
        UNROLL for (int i = 0; i < W; i++) {
            const double d = s->way->sign[i];
            const cv l = left_row[i], e = c_scale(right_row[i], d);
            sum = c_add(sum, c_add(c_mul(l, m.bL[i]), c_mul(e, m.bR[i])));
            apart = c_add(apart, c_add(c_mul(left_row[W + i], m.bL[i]),
                                       c_mul(c_scale(right_row[W + i], d), m.bR[i])));
            size += c_size(l) * m.cL[i] + c_size(e) * m.cR[i];
        }
        value[r] = sum;
        error[r] = size + c_size(apart);
    }
}
