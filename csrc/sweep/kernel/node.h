/* Nodes taken into the part behind the walk: holds, node terms, hinges.
   Included by sweep/kernel/width.h, once per width. */

/* Where a node term N turns a row E into E' = E (I - i N U)^-1, rounding of U moves it by
   i E' N dU (I - i N U)^-1: its companion hears of |E' N| max|U| before. However much a heavy node
   reduces the row, E' N remains. */

/* A coordinate e that cannot move: U <- U - U_e U_e^T/U_ee,  E <- E (I - e U_e^T/U_ee).
   U_ee = 0 only where all of U_e is. */
RD_INLINE void K_(hold)(int e, cv *U, cv *E, size_t rows)
{
    cv Ue[W], d = U[at(e, e)];
    const lane_mask none = (d.re == 0.0) & (d.im == 0.0);
    d.re = l_select(none, (lanes){0} + 1.0, d.re);
    const cv s = c_inverse(d);
    const lanes most = sweep_most(U, SYM);
    KEEP for (int i = 0; i < W; i++)
        Ue[i] = c_mul(U[at(i, e)], s);
    KEEP for (size_t r = 0; r < rows; r++) {
        cv *row = E + r * W;
        const cv Ee = row[e];
        if (r % 2 == 0)
            sweep_disturb(c_size(c_mul(Ee, s)) * most, W, row + W);
        KEEP for (int i = 0; i < W; i++)
            row[i] = i == e ? c_zero() : c_sub(row[i], c_mul(Ee, Ue[i]));
    }
    KEEP for (int i = 0; i < W; i++)
        KEEP for (int j = i; j < W; j++)
            if (i != e && j != e)
                U[at(i, j)] = c_sub(U[at(i, j)], c_mul(Ue[i], U[at(e, j)]));
    KEEP for (int i = 0; i < W; i++)
        U[at(i, e)] = c_zero();
}

static RD_CLONES void K_(hold_all)(const struct rd_chain *chain, size_t t,
                                   struct sweep_state *state)
{
    const uint8_t *held = chain->held + t * W;
    KEEP for (int e = 0; e < W; e++)
        if (held[e]) {
            K_(hold)(e, state->U, state->E, state->rows);
            KEEP for (int i = 0; i < W; i++)
                state->A[at(i, e)] = (lanes){0};
        }
}

/* U <- U + s y y^T of y = U v. Where v has the one coordinate `own`, its row is U_own left, without
   the difference that a heavy mass would leave of it. */
RD_INLINE void K_(add_square)(const cv *y, int own, cv left, cv s, cv *U, lanes *A)
{
    cv kept[W];
    KEEP for (int j = 0; own >= 0 && j < W; j++)
        kept[j] = c_mul(U[at(own, j)], left);
    UNROLL for (int i = 0; i < W; i++) {
        const cv sy = c_mul(s, y[i]);
        UNROLL for (int j = i; j < W; j++)
            U[at(i, j)] = c_add(U[at(i, j)], c_mul(sy, y[j]));
    }
    KEEP for (int j = 0; own >= 0 && j < W; j++)
        U[at(own, j)] = kept[j];
    /* what is left of its rounding */
    KEEP for (int j = 0; own >= 0 && j < W; j++)
        A[at(own, j)] *= c_size(j == own ? c_mul(left, left) : left);
}

/* The same of row r of E, which becomes E + Ev y^T; most: of its rounding per size of Ev. */
RD_INLINE void K_(add_to_row)(const cv *y, int own, cv left, cv Ev, lanes most, size_t r, cv *E)
{
    cv *row = E + r * W;
    const cv kept = own < 0 ? c_zero() : c_mul(row[own], left);
    if (r % 2 == 0)
        sweep_disturb(c_size(Ev) * most, W, row + W);
    UNROLL for (int i = 0; i < W; i++)
        row[i] = c_add(row[i], c_mul(Ev, y[i]));
    if (own >= 0)
        row[own] = kept;
}

/* A rank-one node term c v v^T: U <- U + U v (i c/(1 - i c v^T U v)) v^T U, E likewise. Stable
   for any c: it tends to holding v^T u. */
RD_INLINE void K_(absorb_one)(const lanes *v, int own, cv c, cv *U, lanes *A, cv *E, size_t rows)
{
    cv Uv[W], q = c_zero();
    lanes most = {0};
    UNROLL for (int i = 0; i < W; i++) {
        most += l_abs(v[i]);
        Uv[i] = c_zero();
        UNROLL for (int j = 0; j < W; j++)
            Uv[i] = c_add(Uv[i], c_scale_lanes(U[at(i, j)], v[j]));
        q = c_add(q, c_scale_lanes(Uv[i], v[i]));
    }
    const cv ic = c_times_i(c);
    cv d = c_neg(c_mul(ic, q));
    d.re += 1.0;
    const cv left = c_inverse(d);
    const cv s = c_mul(ic, left);
    most *= sweep_most(U, SYM);
    KEEP for (size_t r = 0; r < rows; r++) {
        cv Ev = c_zero();
        UNROLL for (int i = 0; i < W; i++)
            Ev = c_add(Ev, c_scale_lanes(E[r * W + (size_t)i], v[i]));
        K_(add_to_row)(Uv, own, left, c_mul(Ev, s), most, r, E);
    }
    K_(add_square)(Uv, own, left, s, U, A);
}

/* the only coordinate of a row, or -1 */
static int K_(only)(const double *row)
{
    int own = -1;
    KEEP for (int i = 0; i < W; i++)
        if (row[i] != 0.0)
            own = own == -1 ? i : -2;
    return own < 0 ? -1 : own;
}

/* a d - b c to the last digits (Kahan): an eccentric mass leaves nothing else */
static inline double determinant(double a, double b, double c, double d)
{
    const double w = b * c, lost = fma(-b, c, w);
    return fma(a, d, -w) + lost;
}

/* The next rank-one part d row row^T of m, which is taken from m: pivots of its L D L^T, largest
   first; where all are zero, m_ab (e_a e_b^T + e_b e_a^T) = d (e_a + e_b)(e_a + e_b)^T - ...,
   d = m_ab/2, and the rest has diagonals again. 0: nothing is left. */
static double K_(take_part)(double *m, double *row)
{
    int p = 0, b = -1;
    KEEP for (int i = 1; i < W; i++)
        p = fabs(m[i * W + i]) > fabs(m[p * W + p]) ? i : p;
    double d = m[p * W + p];
    if (d == 0.0)
        KEEP for (int i = 0; i < W; i++)
            KEEP for (int j = i + 1; j < W; j++)
                if (b < 0 && m[i * W + j] != 0.0) {
                    p = i;
                    b = j;
                    d = 0.5 * m[i * W + j];
                }
    KEEP for (int i = 0; d != 0.0 && i < W; i++)
        row[i] = b < 0 ? m[p * W + i] / d : (double)(i == p || i == b);
    KEEP for (int i = 0; d != 0.0 && i < W; i++)
        KEEP for (int j = 0; j < W; j++)
            if (b >= 0)
                m[i * W + j] -= d * row[i] * row[j];
            else if (i != p && j != p)
                m[i * W + j] = determinant(d, m[p * W + i], m[p * W + j], m[i * W + j]) / d;
    KEEP for (int i = 0; b < 0 && i < W; i++) {
        m[p * W + i] = 0.0;
        m[i * W + p] = 0.0;
    }
    return d;
}

/* N = c m at once, U <- U (I - i N U)^-1, E likewise: for indefinite m, whose rank-one parts would
   undo each other. */
static RD_CLONES void K_(absorb_whole)(const struct sweep_walk *s, const double *m, cv c,
                                       struct sweep_state *state)
{
    cv N[SYM], x[FULL], inverse[FULL], U[SYM];
    KEEP for (int i = 0; i < W; i++)
        KEEP for (int j = i; j < W; j++) {
            const double own = m[i * W + j] * s->way->sign[i] * s->way->sign[j];
            N[at(i, j)] = c_scale_lanes(c_scale(c, own), s->block->z[i] * s->block->z[j]);
        }
    K_(sym_times_sym)(N, state->U, x);
    KEEP for (int i = 0; i < FULL; i++)
        x[i] = (cv){x[i].im, -x[i].re};
    KEEP for (int i = 0; i < W; i++)
        x[i * W + i].re += 1.0;
    const cv d = c_inverse(K_(adjugate)(x, inverse));
    const lanes most = sweep_most(state->U, SYM);
    KEEP for (int i = 0; i < FULL; i++)
        inverse[i] = c_mul(inverse[i], d);
    KEEP for (int i = 0; i < W; i++)
        KEEP for (int j = i; j < W; j++) {
            cv sum = c_zero();
            KEEP for (int k = 0; k < W; k++)
                sum = c_add(sum, c_mul(state->U[at(i, k)], inverse[k * W + j]));
            U[at(i, j)] = sum;
        }
    KEEP for (int i = 0; i < SYM; i++) {
        state->U[i] = U[i];
        state->A[i] = (lanes){0};
    }
    KEEP for (size_t r = 0; r < state->rows; r++) {
        cv *row = state->E + r * W, old[W];
        KEEP for (int i = 0; i < W; i++)
            old[i] = row[i];
        KEEP for (int j = 0; j < W; j++) {
            row[j] = c_zero();
            KEEP for (int k = 0; k < W; k++)
                row[j] = c_add(row[j], c_mul(old[k], inverse[k * W + j]));
        }
        lanes force = {0};
        KEEP for (int j = 0; j < W; j++) {
            cv sum = c_zero();
            KEEP for (int k = 0; k < W; k++)
                sum = c_add(sum, c_mul(row[k], N[at(k, j)]));
            force += c_size(sum);
        }
        if (r % 2 == 0)
            sweep_disturb(force * most, W, row + W);
    }
}

/* A structure's -(w/e) v v^T as K_(absorb_one) takes c v v^T, without the quotient: where e = 0 it
   holds v^T u, and the row of a coordinate of its own is U_own e/(e + i w v^T U v), to the last digit
   however small e is. */
static RD_CLONES void K_(absorb_foot)(const struct sweep_walk *s, const struct sweep_foot *foot,
                                      struct sweep_state *state)
{
    cv v[W], Uv[W], h = c_zero();
    lanes most = {0};
    int own = -1;
    KEEP for (int i = 0; i < W; i++) {
        v[i] = c_scale_lanes(foot->lever[i], s->block->z[i] * s->way->sign[i]);
        if (foot->moves[i])
            own = own == -1 ? i : -2;
        most += c_size(v[i]);
    }
    KEEP for (int i = 0; i < W; i++) {
        Uv[i] = c_zero();
        KEEP for (int j = 0; j < W; j++)
            Uv[i] = c_add(Uv[i], c_mul(state->U[at(i, j)], v[j]));
        h = c_add(h, c_mul(Uv[i], v[i]));
    }
    const cv iw = c_times_i(foot->weight);
    const cv d = c_inverse(c_add(foot->gap, c_mul(iw, h)));
    const cv left = c_mul(foot->gap, d), t = c_neg(c_mul(iw, d));
    most *= sweep_most(state->U, SYM);
    KEEP for (size_t r = 0; r < state->rows; r++) {
        cv Ev = c_zero();
        KEEP for (int i = 0; i < W; i++)
            Ev = c_add(Ev, c_mul(state->E[r * W + (size_t)i], v[i]));
        K_(add_to_row)(Uv, own, left, c_mul(Ev, t), most, r, state->E);
    }
    K_(add_square)(Uv, own, left, t, state->U, state->A);
}

/* the structures that node term t carries: what is regular of them, then their poles */
static void K_(absorb_feet)(const struct sweep_walk *s, size_t t, struct sweep_state *state)
{
    const struct rd_chain *chain = s->chain;
    for (size_t k = rd_attached_first(chain, t); rd_attached_is_of(chain, k, (int32_t)t); k++) {
        const struct sweep_foot *foot = s->foot + k;
        KEEP for (size_t part = 0; part < 2; part++) {
            const double *row = chain->attached_row + (2 * k + part) * W;
            lanes v[W];
            if (!foot->rests[part])
                continue;
            KEEP for (int i = 0; i < W; i++)
                v[i] = s->block->z[i] * (s->way->sign[i] * row[i]);
            K_(absorb_one)(v, K_(only)(row), foot->rest[part], state->U, state->A, state->E,
                           state->rows);
        }
        K_(absorb_foot)(s, foot, state);
    }
}

/* The rank-one parts d row row^T of m, which is destroyed: how many, at most W pivots and as many
   splits, and whether they have both signs. */
static int K_(split)(double *m, double *d, double (*row)[RD_WIDTH_MAX], int *indefinite)
{
    int parts = 0;
    *indefinite = 0;
    KEEP for (; parts < 2 * W; parts++) {
        d[parts] = K_(take_part)(m, row[parts]);
        if (d[parts] == 0.0)
            break;
        *indefinite |= d[parts] * d[0] < 0.0;
    }
    return parts;
}

/* m without the coordinates that are held, which nothing moves */
static void K_(free_part)(const struct sweep_walk *s, size_t t, const double *given, double *m)
{
    const uint8_t *held = s->chain->held + t * W;
    KEEP for (int i = 0; i < W; i++)
        KEEP for (int j = 0; j < W; j++)
            m[i * W + j] = held[i] || held[j] ? 0.0 : given[i * W + j];
}

/* c m of a diagonal m */
static RD_CLONES void K_(absorb_diagonal)(const struct sweep_walk *s, const double *m, cv c,
                                struct sweep_state *state)
{
    KEEP for (int i = 0; i < W; i++) {
        lanes v[W] = {{0}};
        if (m[i * (W + 1)] == 0.0)
            continue;
        v[i] = s->block->z[i];
        K_(absorb_one)(v, i, c_scale(c, m[i * (W + 1)]), state->U, state->A, state->E,
                       state->rows);
    }
}

/* Nothing moves, and no row listens there. */
static void K_(hold_still)(struct sweep_state *state)
{
    KEEP for (int i = 0; i < SYM; i++) {
        state->U[i] = c_zero();
        state->A[i] = (lanes){0};
    }
    state->absorbed = 1;
}

/* Take the node into the part behind it: heavy and eccentric masses by rank-one parts. */
static RD_CLONES void K_(absorb)(const struct sweep_walk *s, size_t t, struct sweep_state *state)
{
    if (s->trait[t] & RD_FIXED && state->rows == 0) {
        K_(hold_still)(state);
        return;
    }
    if (s->trait[t] & RD_COUPLED)
        K_(hold_all)(s->chain, t, state);
    const double *const all[] = {s->chain->stiffness, s->chain->mass, s->chain->damping};
    const cv factors[] = {s->block->spring, s->block->inertia, s->block->dashpot};
    const int traits[] = {RD_SPRUNG, RD_MASSIVE, RD_DASHED};
    KEEP for (int part = 0; part < 3; part++) {
        if (!(s->trait[t] & traits[part]))
            continue;
        const double *given = all[part] + t * FULL;
        const cv factor = factors[part];
        if (!(s->trait[t] & (RD_COUPLED | RD_SKEW))) {
            K_(absorb_diagonal)(s, given, factor, state);
            continue;
        }
        double m[FULL], d[2 * W], row[2 * W][RD_WIDTH_MAX];
        int indefinite;
        K_(free_part)(s, t, given, m);
        const int parts = K_(split)(m, d, row, &indefinite);
        if (indefinite) {
            K_(free_part)(s, t, given, m);
            K_(absorb_whole)(s, m, factor, state);
            continue;
        }
        KEEP for (int k = 0; k < parts; k++) {
            lanes v[W];
            KEEP for (int i = 0; i < W; i++)
                v[i] = s->block->z[i] * (s->way->sign[i] * row[k][i]);
            K_(absorb_one)(v, K_(only)(row[k]), c_scale(factor, d[k]), state->U, state->A,
                           state->E, state->rows);
        }
    }
    if (s->trait[t] & RD_CARRIES)
        K_(absorb_feet)(s, t, state);
    state->absorbed = 1;
}

/* A hinge of complex compliance h in coordinate e: with V = I - U, k = i h/(1 + i h V_ee),
       U <- U + k V_e V_e^T,  E <- E (I - k e V_e^T)
   and k = 1/V_ee for a free hinge. V_ee = 0 only where all of V_e is. */
RD_INLINE void K_(open)(int e, cv h, int free, cv *U, cv *E, size_t rows)
{
    cv V[W], k;
    const lanes most = sweep_most(U, SYM);
    KEEP for (int i = 0; i < W; i++)
        V[i] = c_neg(U[at(i, e)]);
    V[e].re += 1.0;
    if (free) {
        cv d = V[e];
        const lane_mask none = (d.re == 0.0) & (d.im == 0.0);
        d.re = l_select(none, (lanes){0} + 1.0, d.re);
        k = c_inverse(d);
    } else {
        cv d = c_times_i(c_mul(V[e], h));
        d.re += 1.0;
        k = c_times_i(c_mul(c_inverse(d), h));
    }
    KEEP for (size_t r = 0; r < rows; r++) {
        cv *row = E + r * W;
        const cv Ek = c_mul(row[e], k);
        if (r % 2 == 0)
            sweep_disturb(c_size(Ek) * most, W, row + W);
        KEEP for (int i = 0; i < W; i++)
            row[i] = c_sub(row[i], c_mul(Ek, V[i]));
    }
    KEEP for (int i = 0; i < W; i++)
        KEEP for (int j = i; j < W; j++)
            U[at(i, j)] = c_add(U[at(i, j)], c_mul(c_mul(V[i], V[j]), k));
}

/* all hinges on the right of a node; each is a spring, and damped as one */
static RD_CLONES void K_(open_all)(const struct sweep_walk *s, size_t t, struct sweep_state *state)
{
    const double *hinge = s->chain->hinge + t * W;
    const cv soft = c_inverse(s->block->spring);
    KEEP for (int e = 0; e < W; e++)
        if (hinge[e] != 0.0) {
            const lanes z = s->block->z[e];
            const int free = isinf(hinge[e]);
            const cv h = c_scale_lanes(soft, free ? (lanes){0} : hinge[e] / (z * z));
            K_(open)(e, h, free, state->U, state->E, state->rows);
        }
}

/* The node a step leaves: its term, unless it is part of U already, and forward its hinge too. */
static void K_(leave)(const struct sweep_walk *s, size_t t, int absorbed, struct sweep_state *state)
{
    if (!absorbed)
        K_(absorb)(s, t, state);
    if (!s->way->backward && (s->trait[t] & RD_HINGED))
        K_(open_all)(s, t, state);
}
