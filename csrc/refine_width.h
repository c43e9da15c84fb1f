/* Inverse iteration of one width: included once for each RD_WAVE_WIDTH.

   Going right, u = U s + g and f = -i Y s + i g describe the left part (wave.h). Loads: p at the
   node, d between the ends of the piece, u_b = F u_a + G f_b + d. With K = (G + i I)^-1, B = K F,
   Wt = i I + Q + N + F^T B, E = (Wt U - i I)^-1, h = p - B^T d - Wt g:
       s_a = E (B^T s_b + h)
       U <- K G + i B U E B^T,  g <- i B (U E h + g) + i K d

   Structures (attached.h) have an unknown y each and, where e y = v^T u + load, the node feels
   -w v y: with h = v^T U v, x = U v,

       U <- U + x x^T i w/(e - i w h),  g <- g + x i w (load + v^T g)/(e - i w h)
       y = (load + v^T (U s + g))/(e - i w h) with the old U, g and the new s;  s_old = s + i w v y */
#include "piece.h"
#include "refine.h"
#include "wave.h"

#include <complex.h>
#include <string.h>

/* a step in scaled coordinates with its change d/dlambda; V = Q + N */
struct rate {
    lanes D[W][W], G[W][W], V[W][W], dD[W][W], dG[W][W], dV[W][W];
};

RD_INLINE void rate_node(const struct rd_refine *r, int32_t term, int32_t before, lanes lambda,
                         struct rate *rate)
{
    const double *mass = rd_walk_mass(r->walk, term);
    lanes N[W][W], rest[W][W], dN[W][W];
    term_load(r->walk, term, before, lambda, N);
    for (int i = 0; i < W; i++)
        for (int j = 0; j < W; j++)
            dN[i][j] = rest[i][j] = l_fill(0);
    foot_rest(r->walk->chain, term, lambda, rest, dN);
    for (int i = 0; i < W; i++)
        for (int j = 0; j < W; j++) {
            const double zz = r->z[i] * r->z[j];
            rate->V[i][j] = N[i][j] * zz;
            rate->dV[i][j] = (dN[i][j] - mass[i * W + j]) * zz;
        }
}

RD_INLINE void rate_load(const struct rd_refine *r, const struct rd_step *step, lanes lambda,
                         struct rate *rate)
{
    struct piece piece;
    const struct piece *value = &piece, *change = NULL;
    if (step->piece >= 0) {
        value = (const struct piece *)(r->piece + (size_t)step->piece * 6 * W * W);
        change = value + 1;
    } else
        piece_load(r->walk, step->element, &piece);
    rate_node(r, step->term, step->before, lambda, rate);
    for (int i = 0; i < W; i++)
        for (int j = 0; j < W; j++) {
            const double zz = r->z[i] * r->z[j];
            const double ratio = r->z[j] / r->z[i];
            rate->D[i][j] = value->D[i][j] * ratio;
            rate->G[i][j] = value->G[i][j] / zz;
            rate->V[i][j] += value->Q[i][j] * zz;
            rate->dD[i][j] = change ? change->D[i][j] * ratio : l_fill(0);
            rate->dG[i][j] = change ? change->G[i][j] / zz : l_fill(0);
            rate->dV[i][j] += change ? change->Q[i][j] * zz : l_fill(0);
        }
}

/* whether a step has the rates of another */
RD_INLINE _Bool is_alike(const struct rd_step *made, const struct rd_step *step)
{
    return made && made->piece == step->piece && made->element == step->element &&
           made->term == step->term && made->before == step->before;
}

/* K = (G + i I)^-1, B = K F, Wt = i I + V + F^T B */
struct kernel {
    cv K[W][W], B[W][W], Wt[W][W];
};

RD_INLINE void kernel_fill(const struct rate *rate, struct kernel *k)
{
    cv Z[W][W];
    for (int i = 0; i < W; i++)
        for (int j = 0; j < W; j++) {
            k->K[i][j] = c_make(l_fill(i == j), l_fill(0));
            Z[i][j] = c_make(rate->G[i][j], l_fill(i == j));
        }
    divide(k->K, Z);
    for (int i = 0; i < W; i++)
        for (int j = 0; j < W; j++) {
            k->B[i][j] = k->K[i][j];
            for (int m = 0; m < W; m++)
                k->B[i][j] = c_add(k->B[i][j], c_scale_lanes(k->K[i][m], rate->D[m][j]));
        }
    for (int i = 0; i < W; i++)
        for (int j = 0; j < W; j++) {
            cv sum = k->B[i][j];
            for (int m = 0; m < W; m++)
                sum = c_add(sum, c_scale_lanes(k->B[m][j], rate->D[m][i]));
            k->Wt[i][j] = c_make(sum.re + rate->V[i][j], sum.im + l_fill(i == j));
        }
}

/* the left part at a node */
struct left {
    cv U[W][W], g[W];
};

enum { LEFT = W * (W + 3) };

RD_INLINE void left_store(const struct left *left, lanes *at)
{
    for (int i = 0; i < W; i++) {
        for (int j = 0; j <= i; j++) {
            *at++ = left->U[i][j].re;
            *at++ = left->U[i][j].im;
        }
        *at++ = left->g[i].re;
        *at++ = left->g[i].im;
    }
}

RD_INLINE void left_load(const lanes *at, struct left *left)
{
    for (int i = 0; i < W; i++) {
        for (int j = 0; j <= i; j++, at += 2)
            left->U[i][j] = left->U[j][i] = c_make(at[0], at[1]);
        left->g[i] = c_make(at[0], at[1]);
        at += 2;
    }
}

/* U -= U_j U_j^T/U_jj, g -= U_j g_j/U_jj */
RD_INLINE void left_hold(struct left *left, int j)
{
    cv y[W];
    const cv inverse = c_invert(left->U[j][j]);
    const cv gj = c_mul(left->g[j], inverse);
    for (int i = 0; i < W; i++)
        y[i] = left->U[i][j];
    for (int i = 0; i < W; i++) {
        const cv yi = c_mul(y[i], inverse);
        for (int k = 0; k < W; k++)
            left->U[i][k] = i == j || k == j ? c_make(l_fill(0), l_fill(0))
                                             : c_sub(left->U[i][k], c_mul(yi, y[k]));
        left->g[i] = i == j ? c_make(l_fill(0), l_fill(0)) : c_sub(left->g[i], c_mul(y[i], gj));
    }
}

RD_INLINE const uint8_t *held_at(const struct rd_refine *r, int32_t term)
{
    return rd_walk_held(r->walk, term);
}

/* A load that no mode is free of, the same for every run: the hash of splitmix64 (Steele, Lea, Flood
   2014), since what repeats from lane to lane could not tell a cluster's modes apart. */
RD_INLINE lanes fixed_load(size_t m, int i)
{
    lanes p = {0};
    for (int k = 0; k < RD_LANES; k++) {
        uint64_t x = ((uint64_t)m * W + (uint64_t)i) * RD_LANES + (uint64_t)k + 1;
        x *= 0x9E3779B97F4A7C15u;
        x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9u;
        x = (x ^ (x >> 27)) * 0x94D049BB133111EBu;
        x ^= x >> 31;
        p[k] = (double)(x >> 11) * 0x1p-52 - 1;
    }
    return p;
}

RD_INLINE lane_mask lanes_of(unsigned bits)
{
    lane_mask mask = {0};
    for (int k = 0; k < RD_LANES; k++)
        mask[k] = -(long long)(bits >> k & 1);
    return mask;
}

/* the loads of the next iteration, b = -A' x: p = -(dV u_a - dF^T f_b), d = dF u_a + dG f_b */
RD_INLINE void load(const struct rd_refine *r, size_t m, const struct rate *rate, unsigned begin,
                    lanes *p, lanes *d)
{
    const lanes *u = r->u + m * W, *f = r->f + m * W;
    for (int i = 0; i < W; i++) {
        p[i] = d[i] = l_fill(0);
        for (int j = 0; begin != RD_ALL_LANES && j < W; j++) {
            p[i] -= rate->dV[i][j] * u[j] - rate->dD[j][i] * f[j];
            d[i] += rate->dD[i][j] * u[j] + rate->dG[i][j] * f[j];
        }
        if (begin) {
            p[i] = l_select(lanes_of(begin), fixed_load(m, i), p[i]);
            d[i] = l_select(lanes_of(begin), l_fill(0), d[i]);
        }
    }
}

/* E B^T and E h */
RD_INLINE void solve(const struct kernel *k, const struct left *left, const lanes *p,
                     const lanes *d, cv EBt[W][W], cv *Eh)
{
    cv Z[W][W], X[W][W], h[W];
    for (int i = 0; i < W; i++) {
        h[i] = c_make(p[i], l_fill(0));
        for (int j = 0; j < W; j++) {
            h[i] = c_sub(h[i], c_scale_lanes(k->B[j][i], d[j]));
            h[i] = c_sub(h[i], c_mul(k->Wt[i][j], left->g[j]));
            Z[i][j] = c_make(l_fill(0), l_fill(-(i == j)));
            for (int m = 0; m < W; m++)
                Z[i][j] = c_add(Z[i][j], c_mul(k->Wt[i][m], left->U[m][j]));
            X[i][j] = c_make(l_fill(i == j), l_fill(0));
        }
    }
    divide(X, Z);
    for (int i = 0; i < W; i++) {
        Eh[i] = c_make(l_fill(0), l_fill(0));
        for (int j = 0; j < W; j++) {
            Eh[i] = c_add(Eh[i], c_mul(X[i][j], h[j]));
            EBt[i][j] = c_make(l_fill(0), l_fill(0));
            for (int m = 0; m < W; m++)
                EBt[i][j] = c_add(EBt[i][j], c_mul(X[i][m], k->B[j][m]));
        }
    }
}

RD_INLINE void left_advance(struct left *left, const struct rate *rate, const struct kernel *k,
                            const lanes *p, const lanes *d)
{
    cv EBt[W][W], Eh[W], UE[W][W], t[W];
    solve(k, left, p, d, EBt, Eh);
    for (int i = 0; i < W; i++) {
        t[i] = left->g[i];
        for (int j = 0; j < W; j++) {
            t[i] = c_add(t[i], c_mul(left->U[i][j], Eh[j]));
            UE[i][j] = c_make(l_fill(0), l_fill(0));
            for (int m = 0; m < W; m++)
                UE[i][j] = c_add(UE[i][j], c_mul(left->U[i][m], EBt[m][j]));
        }
    }
    for (int i = 0; i < W; i++) {
        cv g = c_make(l_fill(0), l_fill(0));
        for (int j = 0; j < W; j++) {
            g = c_add(g, c_mul(k->B[i][j], t[j]));
            g = c_add(g, c_scale_lanes(k->K[i][j], d[j]));
        }
        left->g[i] = c_turn(g, l_fill(1));
        for (int j = 0; j <= i; j++) {
            cv A = c_make(l_fill(0), l_fill(0)), BU = A;
            for (int m = 0; m < W; m++) {
                A = c_add(A, c_scale_lanes(k->K[i][m], rate->G[m][j]));
                BU = c_add(BU, c_mul(k->B[i][m], UE[m][j]));
            }
            left->U[i][j] = left->U[j][i] = c_add(A, c_turn(BU, l_fill(1)));
        }
    }
}

static double _Complex lane_of(const cv *x, int k)
{
    return CMPLX(x->re[k], x->im[k]);
}

/* a/b by the textbook's formula: the same bits with every compiler */
static double _Complex quotient(double _Complex a, double _Complex b)
{
    return a * conj(b) / (creal(b) * creal(b) + cimag(b) * cimag(b));
}

/* x <- A[:, :W]^-1 A[:, W] by elimination with pivoting; A is destroyed. True where A is singular: x
   is then what A takes to 0, very large. */
static _Bool eliminate(double _Complex A[W][W + 1], double _Complex *x)
{
    _Bool singular = 0;
    for (int c = 0; c < W; c++) {
        int best = c;
        for (int i = c + 1; i < W; i++)
            if (cabs(A[i][c]) > cabs(A[best][c]))
                best = i;
        double _Complex row[W + 1];
        memcpy(row, A[c], sizeof row);
        memmove(A[c], A[best], sizeof row);
        memcpy(A[best], row, sizeof row);
        if (cabs(A[c][c]) < 1e-40) {
            A[c][c] = 1e-40;
            singular = 1;
        }
        for (int i = 0; i < W; i++) {
            if (i == c)
                continue;
            const double _Complex share = quotient(A[i][c], A[c][c]);
            for (int j = c; j <= W; j++)
                A[i][j] -= share * A[c][j];
        }
    }
    for (int c = 0; c < W; c++)
        x[c] = quotient(A[c][W], A[c][c]);
    return singular;
}

/* s of a motion that nothing drives is free by a phase: that which makes u = U s and
   f = -i (s - u) real, by the largest of both */
static void make_real(const struct left *left, int lane, double _Complex *s)
{
    double _Complex largest = 0;
    for (int i = 0; i < W; i++) {
        double _Complex u = 0;
        for (int j = 0; j < W; j++)
            u += lane_of(&left->U[i][j], lane) * s[j];
        const double _Complex f = CMPLX(0, -1) * (s[i] - u);
        largest = cabs(u) > cabs(largest) ? u : largest;
        largest = cabs(f) > cabs(largest) ? f : largest;
    }
    const double size = cabs(largest);
    for (int i = 0; i < W && size > 0; i++)
        s[i] *= conj(largest / size);
}

/* The right end: f + N u = p where free, u = 0 where held: row i of (N U - i Y) s = p - N g - i g
   or of U s = -g; one lane after another. */
static void end_solve(const struct left *left, const struct rate *rate, const uint8_t *held,
                      const lanes *p, cv *s)
{
    for (int k = 0; k < RD_LANES; k++) {
        double _Complex A[W][W + 1], x[W];
        for (int i = 0; i < W; i++) {
            for (int j = 0; j < W; j++) {
                const double _Complex U = lane_of(&left->U[i][j], k);
                A[i][j] = held[i] ? U : CMPLX(-cimag(U), creal(U) - (i == j));
            }
            const double _Complex g = lane_of(left->g + i, k);
            A[i][W] = held[i] ? -g : CMPLX(p[i][k] + cimag(g), -creal(g));
            for (int m = 0; m < W && !held[i]; m++) {
                const double N = rate->V[i][m][k];
                for (int j = 0; j < W; j++)
                    A[i][j] += N * lane_of(&left->U[m][j], k);
                A[i][W] -= N * lane_of(left->g + m, k);
            }
        }
        if (eliminate(A, x))
            make_real(left, k, x);
        for (int c = 0; c < W; c++) {
            s[c].re[k] = creal(x[c]);
            s[c].im[k] = cimag(x[c]);
        }
    }
}

/* u = Re (U s + g), f = Re (-i Y s + i g) = Re -i (s - u) */
RD_INLINE void state(const struct left *left, const cv *s, lanes *u, lanes *f)
{
    for (int i = 0; i < W; i++) {
        cv x = left->g[i];
        for (int j = 0; j < W; j++)
            x = c_add(x, c_mul(left->U[i][j], s[j]));
        u[i] = x.re;
        if (f)
            f[i] = s[i].im - x.im;
    }
}

RD_INLINE lanes lanes_load(const double *x)
{
    lanes y;
    for (int k = 0; k < RD_LANES; k++)
        y[k] = x[k];
    return y;
}

/* all pieces with their d/dlambda */
RD_INLINE void pieces_change(const struct rd_refine *r, lanes lambda)
{
    int32_t done = -1;
    for (size_t m = 0; m < r->steps; m++) {
        /* the first step of a leg is its largest piece, the last of its levels */
        const struct rd_step *step = r->step + m;
        if (step->piece <= done)
            continue;
        done = step->piece;
        const struct rd_leg *leg = r->walk->leg + step->leg;
        lanes N[W][W], dN[W][W];
        term_load(r->walk, leg->term, step->element, lambda, N);
        for (int i = 0; i < W; i++)
            for (int j = 0; j < W; j++)
                dN[i][j] = l_fill(-rd_walk_mass(r->walk, leg->term)[i * W + j]);
        struct piece *level =
            (struct piece *)(r->piece + (size_t)(step->piece - step->level) * 6 * W * W);
        first_piece(r->walk, leg, step->halvings, lambda, level, level + 1);
        for (int32_t k = 0; k < step->level; k++, level += 2) {
            piece_double(level, N, level + 2);
            piece_double_change(level, level + 1, N, dN, level + 3);
        }
    }
}

/* --- structures --------------------------------------------------------------------------------- */

/* the first structure of a node, or of a later one */
RD_INLINE size_t foot_first(const struct rd_refine *r, int32_t term)
{
    const struct rd_chain *chain = r->walk->chain;
    return chain->attached == 0 || term == RD_NO_TERM ? chain->attached
                                                      : rd_attached_first(chain, (size_t)term);
}

RD_INLINE void foot_make(const struct rd_refine *r, size_t k, lanes lambda, struct foot *foot)
{
    lanes z[W];
    for (int i = 0; i < W; i++)
        z[i] = l_fill(r->z[i]);
    foot_load(r->walk->chain, k, lambda, foot);
    foot_scale(foot, z);
}

/* Its load in the next iteration over w: what remains of -A' x where e y = v^T u. */
RD_INLINE lanes foot_pull(const struct rd_refine *r, size_t k, const struct foot *foot,
                          const lanes *u, unsigned begin)
{
    enum { FAR = 1 << 30 }; /* loads beyond those of nodes */
    lanes load = l_fill(0);
    if (begin != RD_ALL_LANES)
        load = foot_dot(foot->dv, u) - foot->de * r->y[k];
    return begin ? l_select(lanes_of(begin), fixed_load(FAR + k, 0), load) : load;
}

/* x = U v and 1/(e - i w v^T x) */
RD_INLINE cv foot_reach(const struct left *left, const struct foot *foot, cv *x)
{
    cv h = c_make(l_fill(0), l_fill(0));
    for (int i = 0; i < W; i++) {
        x[i] = c_make(l_fill(0), l_fill(0));
        for (int j = 0; j < W; j++)
            x[i] = c_add(x[i], c_scale_lanes(left->U[i][j], foot->v[j]));
        h = c_add(h, c_scale_lanes(x[i], foot->v[i]));
    }
    const cv d = c_make(foot->e + foot->w * h.im, -foot->w * h.re);
    const lanes size = 1 / c_size(d);
    return c_scale_lanes(c_invert(c_scale_lanes(d, size)), size);
}

RD_INLINE cv foot_along(const struct foot *foot, const cv *g)
{
    cv sum = c_scale_lanes(g[0], foot->v[0]);
    for (int i = 1; i < W; i++)
        sum = c_add(sum, c_scale_lanes(g[i], foot->v[i]));
    return sum;
}

RD_INLINE void foot_take(struct left *left, const struct foot *foot, lanes load)
{
    cv x[W];
    const cv d = c_turn(foot_reach(left, foot, x), foot->w);
    cv t = foot_along(foot, left->g);
    t.re += load;
    t = c_mul(t, d);
    for (int i = 0; i < W; i++) {
        const cv xd = c_mul(x[i], d);
        left->g[i] = c_add(left->g[i], c_mul(x[i], t));
        for (int j = 0; j <= i; j++)
            left->U[i][j] = left->U[j][i] = c_add(left->U[i][j], c_mul(xd, x[j]));
    }
}

/* the structures of a node into the left part, u the motion that loads them; those before `end` */
RD_INLINE void feet_take(const struct rd_refine *r, int32_t term, size_t end, lanes lambda,
                         const lanes *u, unsigned begin, struct left *left)
{
    for (size_t k = foot_first(r, term); k < end && rd_attached_is_of(r->walk->chain, k, term);
         k++) {
        struct foot foot;
        foot_make(r, k, lambda, &foot);
        foot_take(left, &foot, foot_pull(r, k, &foot, u, begin));
    }
}

/* y of each, last first, and s before them; left is the part before, u the motion that loaded them */
RD_INLINE void feet_leave(struct rd_refine *r, int32_t term, lanes lambda, const lanes *u,
                          unsigned begin, const struct left *left, cv *s)
{
    const size_t first = foot_first(r, term);
    size_t end = first;
    while (rd_attached_is_of(r->walk->chain, end, term))
        end++;
    for (size_t k = end; k-- > first;) {
        struct left before = *left;
        struct foot foot;
        cv x[W];
        feet_take(r, term, k, lambda, u, begin, &before);
        foot_make(r, k, lambda, &foot);
        const cv inverse = foot_reach(&before, &foot, x);
        cv y = foot_along(&foot, before.g);
        y.re += foot_pull(r, k, &foot, u, begin);
        for (int i = 0; i < W; i++)
            y = c_add(y, c_mul(x[i], s[i]));
        y = c_mul(y, inverse);
        for (int i = 0; i < W; i++)
            s[i] = c_add(s[i], c_turn(y, foot.w * foot.v[i]));
        r->next[k] = y.re;
    }
}

/* rates and kernel of the step m, made anew where they are not those of the last one */
struct made {
    const struct rd_step *step;
    struct rate rate;
    struct kernel kernel;
};

RD_INLINE void make(const struct rd_refine *r, const struct rd_step *step, lanes lambda,
                    struct made *made)
{
    if (is_alike(made->step, step))
        return;
    rate_load(r, step, lambda, &made->rate);
    kernel_fill(&made->rate, &made->kernel);
    made->step = step;
}

/* the coordinates that a node holds, but for the first, where the left part begins with them held */
RD_INLINE void hold_all(const struct rd_refine *r, size_t m, struct left *left)
{
    const uint8_t *held = held_at(r, r->step[m].term);
    for (int i = 0; m > 0 && i < W; i++)
        if (held[i])
            left_hold(left, i);
}

/* to the right: the left part at every node, in r->receptance, and at the right end */
RD_INLINE void sweep_right(struct rd_refine *r, lanes lambda, unsigned begin, struct left *left)
{
    struct made made = {.step = NULL};
    lanes p[W], d[W];
    const uint8_t *held = held_at(r, r->step[0].term);
    memset(left, 0, sizeof *left);
    for (int i = 0; i < W; i++)
        left->U[i][i].re += !held[i];
    for (size_t m = 0; m < r->steps; m++) {
        make(r, r->step + m, lambda, &made);
        load(r, m, &made.rate, begin, p, d);
        left_store(left, r->receptance + m * LEFT);
        hold_all(r, m, left);
        feet_take(r, r->step[m].term, SIZE_MAX, lambda, r->u + m * W, begin, left);
        left_advance(left, &made.rate, &made.kernel, p, d);
    }
}

/* s, u and f at the right end */
RD_INLINE void turn_round(struct rd_refine *r, lanes lambda, unsigned begin,
                          const struct left *left, cv *s, lanes *f)
{
    const size_t n = r->steps;
    const int32_t last = r->walk->last;
    struct rate rate;
    lanes p[W];
    memset(&rate, 0, sizeof rate);
    rate_node(r, last, r->walk->behind, lambda, &rate);
    for (int i = 0; i < W; i++) {
        p[i] = l_fill(0);
        for (int j = 0; begin != RD_ALL_LANES && j < W; j++)
            p[i] -= rate.dV[i][j] * r->u[n * W + (size_t)j];
        if (begin)
            p[i] = l_select(lanes_of(begin), fixed_load(n, i), p[i]);
    }
    struct left inner = *left;
    feet_take(r, last, SIZE_MAX, lambda, r->u + n * W, begin, &inner);
    end_solve(&inner, &rate, held_at(r, last), p, s);
    feet_leave(r, last, lambda, r->u + n * W, begin, left, s);
    state(left, s, r->u + n * W, f);
}

/* Undoes the holds of a node, last first: s_j -= (U s + g)_j/U_jj with U, g before each. */
RD_INLINE void release_all(const struct left *left, const uint8_t *held, cv *s)
{
    for (int i = W - 1; i >= 0; i--) {
        if (!held[i])
            continue;
        struct left before = *left;
        for (int j = 0; j < i; j++)
            if (held[j])
                left_hold(&before, j);
        cv x = before.g[i];
        for (int j = 0; j < W; j++)
            x = c_add(x, c_mul(before.U[i][j], s[j]));
        s[i] = c_sub(s[i], c_mul(x, c_invert(before.U[i][i])));
    }
}

/* back to the left: u and f of every node and step from s and f at the right end */
RD_INLINE void sweep_left(struct rd_refine *r, lanes lambda, unsigned begin, cv *s, lanes *f)
{
    struct made made = {.step = NULL};
    struct left left;
    lanes p[W], d[W];
    cv EBt[W][W], Eh[W], sa[W];
    for (size_t m = r->steps; m-- > 0;) {
        make(r, r->step + m, lambda, &made);
        load(r, m, &made.rate, begin, p, d);
        memcpy(r->f + m * W, f, W * sizeof *f);
        left_load(r->receptance + m * LEFT, &left);
        struct left inner = left;
        hold_all(r, m, &inner);
        feet_take(r, r->step[m].term, SIZE_MAX, lambda, r->u + m * W, begin, &inner);
        solve(&made.kernel, &inner, p, d, EBt, Eh);
        for (int i = 0; i < W; i++) {
            sa[i] = Eh[i];
            for (int j = 0; j < W; j++)
                sa[i] = c_add(sa[i], c_mul(EBt[i][j], s[j]));
        }
        if (rd_attached_is_of(r->walk->chain, foot_first(r, r->step[m].term), r->step[m].term)) {
            inner = left;
            hold_all(r, m, &inner);
            feet_leave(r, r->step[m].term, lambda, r->u + m * W, begin, &inner, sa);
        }
        if (m > 0)
            release_all(&left, held_at(r, r->step[m].term), sa);
        memcpy(s, sa, sizeof sa);
        state(&left, s, r->u + m * W, f);
    }
}

/* held coordinates exactly 0, the largest of u 1 */
RD_INLINE void normalise_lanes(struct rd_refine *r)
{
    const struct rd_chain *chain = r->walk->chain;
    const size_t n = r->steps, lateral = rd_coordinate_find(W, chain->coordinate, RD_Z) % W;
    for (size_t m = 0; m <= n; m++) {
        const uint8_t *held = held_at(r, m < n ? r->step[m].term : r->walk->last);
        for (int i = 0; i < W; i++)
            if (held[i])
                r->u[m * W + (size_t)i] = l_fill(0);
    }
    lanes most = l_fill(1e-300);
    for (size_t i = 0; i < (n + 1) * W; i++)
        most = l_select(l_abs(r->u[i]) > most, l_abs(r->u[i]), most);
    const size_t attached = chain->attached;
    for (size_t k = 0; k < attached; k++) {
        const lanes size = l_abs(r->next[k]) / r->z[lateral];
        most = l_select(size > most, size, most);
    }
    most = 1 / most;
    for (size_t k = 0; k < attached; k++)
        r->y[k] = r->next[k] * most;
    for (size_t i = 0; i < (n + 1) * W; i++)
        r->u[i] *= most;
    for (size_t i = 0; i < n * W; i++)
        r->f[i] *= most;
}

static RD_CLONES void iterate_lanes(struct rd_refine *r, const double *lambdas, unsigned begin)
{
    const lanes lambda = lanes_load(lambdas);
    struct left left;
    cv s[W];
    lanes f[W];
    memset(r->next, 0, r->walk->chain->attached * sizeof *r->next);
    pieces_change(r, lambda);
    sweep_right(r, lambda, begin, &left);
    turn_round(r, lambda, begin, &left, s, f);
    sweep_left(r, lambda, begin, s, f);
    normalise_lanes(r);
}

/* Residual of structure k at x, and M x = -A' x; what it adds to those of its node. With y fixed, A'
   would know lambda = 0 as an eigenvalue too, where w = 0: fixed is sqrt(w) y, which makes of

       w e y^2 - 2 w y v^T u  by lambda:  w e' y^2 - w' y v^T u - 2 w y v'^T u */
RD_INLINE lanes foot_residual(const struct rd_refine *r, size_t k, const struct foot *foot,
                              const lanes *u, lanes *node, lanes *mass_node, lanes *mass)
{
    const lanes y = r->y[k], along = foot_dot(foot->v, u), change = foot_dot(foot->dv, u);
    for (int i = 0; i < W; i++) {
        node[i] -= foot->w * foot->v[i] * y;
        mass_node[i] += (0.5 * foot->dw * foot->v[i] + foot->w * foot->dv[i]) * y;
    }
    *mass = 0.5 * foot->dw * along + foot->w * (change - foot->de * y);
    return foot->w * (foot->e * y - along);
}

/* residuals of a step at x: node a (W) and piece (W), and M x of both */
RD_INLINE void residual(const struct rd_refine *r, size_t m, const struct rate *rate, lanes *node,
                        lanes *piece, lanes *mass_node, lanes *mass_piece)
{
    const _Bool end = m == r->steps;
    const lanes *u = r->u + m * W, *f = r->f + m * W;
    for (int i = 0; i < W; i++) {
        node[i] = m > 0 ? f[i - W] : l_fill(0);
        node[i] -= end ? l_fill(0) : f[i];
        piece[i] = end ? l_fill(0) : u[W + i] - u[i];
        mass_node[i] = mass_piece[i] = l_fill(0);
        for (int j = 0; j < W; j++) {
            node[i] += rate->V[i][j] * u[j];
            mass_node[i] -= rate->dV[i][j] * u[j];
            if (end)
                continue;
            node[i] -= rate->D[j][i] * f[j];
            piece[i] -= rate->D[i][j] * u[j] + rate->G[i][j] * f[j];
            mass_node[i] += rate->dD[j][i] * f[j];
            mass_piece[i] += rate->dD[i][j] * u[j] + rate->dG[i][j] * f[j];
        }
    }
}

/* node term at the first node of step m, or at the last node */
RD_INLINE int32_t term_at(const struct rd_refine *r, size_t m)
{
    return m < r->steps ? r->step[m].term : r->walk->last;
}

RD_INLINE void rate_at(const struct rd_refine *r, size_t m, lanes lambda, struct rate *rate)
{
    if (m < r->steps)
        rate_load(r, r->step + m, lambda, rate);
    else {
        memset(rate, 0, sizeof *rate);
        rate_node(r, r->walk->last, r->walk->behind, lambda, rate);
    }
}

static RD_CLONES void quotient_lanes(struct rd_refine *r, const double *lambdas,
                                     struct rd_quotient *quotient)
{
    const lanes lambda = lanes_load(lambdas);
    lanes xAx = l_fill(0), xMx = l_fill(0), noise = l_fill(0), energy = l_fill(0);
    struct rate rate;
    for (size_t m = 0; m <= r->steps; m++) {
        lanes node[W], piece[W], mn[W], mp[W];
        const lanes *u = r->u + m * W, *f = r->f + m * W;
        const int32_t level = m < r->steps ? r->step[m].level : 0;
        rate_at(r, m, lambda, &rate);
        residual(r, m, &rate, node, piece, mn, mp);
        const int32_t term = term_at(r, m);
        for (size_t k = foot_first(r, term); rd_attached_is_of(r->walk->chain, k, term); k++) {
            struct foot foot;
            lanes mass;
            foot_make(r, k, lambda, &foot);
            xAx += r->y[k] * foot_residual(r, k, &foot, u, node, mn, &mass);
            xMx += r->y[k] * mass;
            const lanes work = l_abs(foot.w * foot.e * r->y[k] * r->y[k]) +
                               2 * l_abs(foot.w * r->y[k] * foot_dot(foot.v, u));
            noise += work * work;
            energy += work;
        }
        for (int i = 0; i < W; i++) {
            lanes size = l_fill(0), work = l_fill(0);
            xAx += u[i] * node[i];
            xMx += u[i] * mn[i];
            for (int j = 0; j < W; j++)
                work += l_abs(u[i] * rate.V[i][j] * u[j]);
            if (m < r->steps) {
                xAx += f[i] * piece[i];
                xMx += f[i] * mp[i];
                size = l_abs(f[i]) * (l_abs(u[i]) + l_abs(u[W + i]));
                for (int j = 0; j < W; j++)
                    work +=
                        l_abs(f[i] * rate.G[i][j] * f[j]) + 2 * l_abs(f[i] * rate.D[i][j] * u[j]);
            }
            noise += size * size + work * work;
            energy += work * (1 + level);
        }
    }
    for (int k = 0; k < RD_LANES; k++) {
        const double eps = 16 * 2.3e-16;
        quotient->residual[k] = xAx[k] / xMx[k];
        quotient->lambda[k] = lambdas[k] + quotient->residual[k];
        quotient->error[k] =
            eps * ((sqrt(noise[k]) + energy[k]) / fabs(xMx[k]) + fabs(quotient->lambda[k]));
    }
}

void WIDTH(iterate)(struct rd_refine *r, const double *lambdas, unsigned begin)
{
    iterate_lanes(r, lambdas, begin);
}

void WIDTH(quotient)(struct rd_refine *r, const double *lambdas, struct rd_quotient *quotient)
{
    quotient_lanes(r, lambdas, quotient);
}

/* A_kj += x_k y_j */
RD_INLINE void gram_add(lanes x, lanes y, double *A)
{
    for (int k = 0; k < RD_LANES; k++)
        for (int j = 0; j < RD_LANES; j++)
            A[k * RD_LANES + j] += x[k] * y[j];
}

void WIDTH(gram)(struct rd_refine *r, const double *lambdas, double *A, double *M)
{
    const lanes lambda = lanes_load(lambdas);
    struct rate rate;
    memset(A, 0, RD_LANES * RD_LANES * sizeof *A);
    memset(M, 0, RD_LANES * RD_LANES * sizeof *M);
    for (size_t m = 0; m <= r->steps; m++) {
        lanes node[W], piece[W], mn[W], mp[W];
        rate_at(r, m, lambda, &rate);
        residual(r, m, &rate, node, piece, mn, mp);
        const int32_t term = term_at(r, m);
        for (size_t k = foot_first(r, term); rd_attached_is_of(r->walk->chain, k, term); k++) {
            struct foot foot;
            lanes mass;
            foot_make(r, k, lambda, &foot);
            const lanes rest = foot_residual(r, k, &foot, r->u + m * W, node, mn, &mass);
            gram_add(r->y[k], rest, A);
            gram_add(r->y[k], mass, M);
        }
        for (int i = 0; i < W; i++)
            for (int k = 0; k < RD_LANES; k++)
                for (int j = 0; j < RD_LANES; j++) {
                    const double u = r->u[m * W + (size_t)i][k];
                    const double f = m < r->steps ? r->f[m * W + (size_t)i][k] : 0;
                    A[k * RD_LANES + j] += u * node[i][j] + f * piece[i][j];
                    M[k * RD_LANES + j] += u * mn[i][j] + f * mp[i][j];
                }
    }
}

/* What a joint of two equal halves needs to be taken apart again, for one lane. */
struct joint {
    double D[W][W], V[W][W], X[W][W], XV[W][W];
};

static void joint_fill(const struct rd_refine *r, const struct rd_step *step, lanes lambda,
                       int lane, struct joint *joint)
{
    lanes N[W][W];
    term_load(r->walk, r->walk->leg[step->leg].term, step->element, lambda, N);
    const struct piece *half =
        (const struct piece *)(r->piece + (size_t)(step->piece - step->level) * 6 * W * W);
    for (int32_t k = 0; k < step->level; k++, half += 2, joint++) {
        struct middle middle;
        middle_fill(half, N, &middle);
        for (int i = 0; i < W; i++)
            for (int j = 0; j < W; j++) {
                joint->D[i][j] = half->D[i][j][lane];
                joint->V[i][j] = middle.V[i][j][lane];
                joint->X[i][j] = middle.X[i][j][lane];
                joint->XV[i][j] = middle.XV[i][j][lane];
            }
    }
}

/* Back down the doubling to the nodes, 2^halvings first pieces apart: in the middle of two halves u_m = M F1 u_a + X F2^T f_b with
   M = I - X V, f_m = F2^T f_b - V u_m. joint[k] is that of two halves of level k. */
static void descend(const struct joint *joint, int32_t halvings, int32_t level, size_t at,
                    const double *ua, const double *fb, double *u)
{
    if (level <= halvings) {
        if ((at & (((size_t)1 << halvings) - 1)) == 0)
            memcpy(u + (at >> halvings) * W, ua, W * sizeof *u);
        return;
    }
    const struct joint *half = joint + level - 1;
    double um[W], fm[W], Fu[W], Ff[W];
    for (int i = 0; i < W; i++) {
        Fu[i] = ua[i];
        Ff[i] = fb[i];
        for (int j = 0; j < W; j++) {
            Fu[i] += half->D[i][j] * ua[j];
            Ff[i] += half->D[j][i] * fb[j];
        }
    }
    for (int i = 0; i < W; i++) {
        um[i] = Fu[i];
        for (int j = 0; j < W; j++)
            um[i] += half->X[i][j] * Ff[j] - half->XV[i][j] * Fu[j];
    }
    for (int i = 0; i < W; i++) {
        fm[i] = Ff[i];
        for (int j = 0; j < W; j++)
            fm[i] -= half->V[i][j] * um[j];
    }
    descend(joint, halvings, level - 1, at, ua, fm, u);
    descend(joint, halvings, level - 1, at + ((size_t)1 << (level - 1)), um, fb, u);
}

void WIDTH(shape)(struct rd_refine *r, const double *lambdas, int lane, double *u)
{
    const struct rd_chain *chain = r->walk->chain;
    const lanes lambda = lanes_load(lambdas);
    struct joint joint[LEVELS];
    int32_t leg = -1;
    for (size_t m = 0; m <= r->steps; m++) {
        double ua[W], fb[W];
        for (int i = 0; i < W; i++) {
            ua[i] = r->u[m * W + (size_t)i][lane] * r->z[i];
            fb[i] = m < r->steps ? r->f[m * W + (size_t)i][lane] / r->z[i] : 0;
        }
        if (m == r->steps) {
            memcpy(u + (chain->nodes - 1) * W, ua, sizeof ua);
            return;
        }
        /* the first step of a leg is its largest piece, the last of its levels */
        const struct rd_step *step = r->step + m;
        if (step->leg != leg && step->piece >= 0)
            joint_fill(r, step, lambda, lane, joint);
        leg = step->leg;
        /* a node's own motion is that on the left of its hinge */
        if (step->at > 0 || step->term != RD_NO_TERM)
            descend(joint, step->halvings, step->level, step->at, ua, fb,
                    u + r->walk->leg[leg].node * W);
    }
}

static _Bool are_equal(const struct rd_leg *a, const struct rd_leg *b)
{
    return a->element == b->element && a->count == b->count && a->term == b->term;
}

/* Steps of a leg: single elements where it is short, pieces of 2^k otherwise. Equal spans side by
   side share their pieces. */
static enum rd_status plan_leg(struct rd_refine *r, int32_t index, lanes lambda, int32_t *pieces)
{
    const struct rd_leg *leg = r->walk->leg + index;
    const _Bool joined = leg->count >= 4 || leg_is_continuous(r->walk, leg);
    struct piece level[LEVELS];
    const int halvings = leg_halvings(r->walk, leg, lambda);
    const int top = joined ? pieces_fill(r->walk, leg, halvings, lambda, level) : 0;
    if (is_endless(r->walk, leg, halvings, top))
        return RD_SHORT_WAVES;
    const _Bool kept = top > 0 || leg_is_continuous(r->walk, leg);
    const struct rd_step *last = r->steps > 0 ? r->step + r->steps - 1 : NULL;
    const _Bool shared = last && last->piece >= 0 && index > 0 && are_equal(leg - 1, leg);
    const int32_t base = shared ? last->piece - last->level : *pieces;
    if (kept && !shared && (size_t)(base + top + 1) > r->pieces)
        return RD_NO_MEMORY;
    size_t left = leg->count << halvings, at = 0;
    for (int k = top; k >= 0; k--)
        for (; left >> k > 0; left -= (size_t)1 << k, at += (size_t)1 << k) {
            if (r->steps == r->capacity)
                return RD_NO_MEMORY;
            r->step[r->steps++] = (struct rd_step){
                .at = at,
                .halvings = halvings,
                .piece = kept ? base + k : -1,
                .element = leg->element,
                .term = at == 0 ? leg->first : leg->term,
                .before = at == 0 ? leg->before : leg->element,
                .level = k,
                .leg = index,
            };
        }
    *pieces += kept && !shared ? top + 1 : 0;
    return RD_OK;
}

enum rd_status WIDTH(plan)(struct rd_refine *r, const double *lambdas)
{
    const lanes lambda = lanes_load(lambdas);
    double most = 0;
    int32_t pieces = 0;
    for (int k = 0; k < RD_LANES; k++)
        most = fmax(most, fabs(lambdas[k]));
    rd_walk_scale(r->walk, most, r->z);
    r->steps = 0;
    enum rd_status status = RD_OK;
    for (size_t i = 0; i < r->walk->legs && status == RD_OK; i++)
        status = plan_leg(r, (int32_t)i, lambda, &pieces);
    return status;
}
