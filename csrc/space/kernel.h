/* Triples of short pieces and their joints for WIDE coordinates and numbers of one type, NUM: included
   by one source file each, which has add, subtract, times, scaled, over, number(double), size(a), how large a number is,
   is_zero, lesser_size, sizes(a), those of its parts, exceeds(a, b, share), whether a part of a does that share
   of b's, and for exchanges of rows EITHER with larger(a, b), any and exchange(a, b, either). */
#include "space/space.h"

#include <math.h>
#include <string.h>

enum {
    TRIPLE = 3 * WIDE * WIDE,
    TERMS = 24, /* of the series of a piece of up to half a radian, for all digits of all entries */
    STATE = 2 * WIDE,
    ENTRIES = STATE * STATE,
    WALK = 2 * STATE, /* no walk through the entries is longer that passes one of them */
    QUIET = 4,        /* terms one after another that change nothing: the last that do */
};

/* of a sum's largest term, what changes no digit; of entries, of the largest order */
static const double NOTHING = 0x1p-60;

struct triple {
    NUM D[WIDE][WIDE], G[WIDE][WIDE], Q[WIDE][WIDE]; /* D = F - I */
};

/* entries of l^(k+1) E_k, E = sum E_k s^k, that are not 0: most do not change along a piece */
struct rates {
    int orders, entries[RD_SPACE_ORDERS];
    unsigned char row[RD_SPACE_ORDERS][ENTRIES], column[RD_SPACE_ORDERS][ENTRIES];
    NUM value[RD_SPACE_ORDERS][ENTRIES];
};

RD_INLINE void multiply(const NUM A[WIDE][WIDE], const NUM B[WIDE][WIDE], NUM C[WIDE][WIDE])
{
    for (int i = 0; i < WIDE; i++) {
        NUM row[WIDE];
        for (int j = 0; j < WIDE; j++)
            row[j] = number(0);
        for (int k = 0; k < WIDE; k++) {
            const NUM a = A[i][k];
            if (is_zero(a))
                continue;
            for (int j = 0; j < WIDE; j++)
                row[j] = add(row[j], times(a, B[k][j]));
        }
        memcpy(C[i], row, sizeof row);
    }
}

RD_INLINE void transpose(const NUM A[WIDE][WIDE], NUM B[WIDE][WIDE])
{
    for (int i = 0; i < WIDE; i++)
        for (int j = 0; j < WIDE; j++)
            B[i][j] = A[j][i];
}

/* A <- A + B */
RD_INLINE void increase(NUM A[WIDE][WIDE], const NUM B[WIDE][WIDE])
{
    for (int i = 0; i < WIDE; i++)
        for (int j = 0; j < WIDE; j++)
            A[i][j] = add(A[i][j], B[i][j]);
}

/* C = A + B, symmetric but for rounding */
RD_INLINE void add_symmetric(const NUM A[WIDE][WIDE], const NUM B[WIDE][WIDE], NUM C[WIDE][WIDE])
{
    for (int i = 0; i < WIDE; i++)
        for (int j = 0; j <= i; j++)
            C[i][j] = C[j][i] = add(A[i][j], scaled(add(B[i][j], B[j][i]), 0.5));
}

/* X (n columns, `wide` apart) <- A^-1 X by Gauss and Jordan with exchanges, A destroyed; the largest entry
   of A^-1 is at most that of X where X begins with the unit matrix */
RD_INLINE void divide(NUM A[WIDE][WIDE], int n, NUM *X)
{
    for (int k = 0; k < WIDE; k++) {
        for (int i = k + 1; i < WIDE; i++) {
            const EITHER swap = larger(A[i][k], A[k][k]);
            if (!any(swap))
                continue;
            for (int j = 0; j < WIDE; j++)
                exchange(&A[k][j], &A[i][j], swap);
            for (int j = 0; j < n; j++)
                exchange(X + k * n + j, X + i * n + j, swap);
        }
        const NUM inverse = over(A[k][k]);
        for (int j = k; j < WIDE; j++)
            A[k][j] = times(A[k][j], inverse);
        for (int j = 0; j < n; j++)
            X[k * n + j] = times(X[k * n + j], inverse);
        for (int i = 0; i < WIDE; i++) {
            const NUM a = A[i][k];
            if (i == k || is_zero(a))
                continue;
            for (int j = k; j < WIDE; j++)
                A[i][j] = subtract(A[i][j], times(a, A[k][j]));
            for (int j = 0; j < n; j++)
                X[i * n + j] = subtract(X[i * n + j], times(a, X[k * n + j]));
        }
    }
}

/* column c of the change of y along the piece, u over f: (k + 1) y_k+1 = sum E_j y_k-j */
RD_INLINE void column(const struct rates *E, int c, NUM *sum)
{
    NUM term[TERMS + 1][STATE];
    int quiet = 0;
    for (int i = 0; i < STATE; i++) {
        sum[i] = number(0);
        term[0][i] = number(i == c);
    }
    for (int m = 1; m <= TERMS && (m <= WALK || quiet < QUIET); m++) {
        NUM *next = term[m];
        for (int i = 0; i < STATE; i++)
            next[i] = number(0);
        for (int k = 0; k < E->orders && k < m; k++)
            for (int e = 0; e < E->entries[k]; e++) {
                NUM *to = next + E->row[k][e];
                *to = add(*to, times(E->value[k][e], term[m - 1 - k][E->column[k][e]]));
            }
        for (int i = 0; i < STATE; i++) {
            next[i] = scaled(next[i], 1.0 / m);
            sum[i] = add(sum[i], next[i]);
        }
        quiet++;
        for (int i = 0; m > WALK - QUIET && quiet > 0 && i < STATE; i++)
            quiet = exceeds(next[i], sum[i], NOTHING) ? 0 : quiet;
    }
}

/* F^T = E22^-1, G = E12 E22^-1 and Q = E22^-1 E21 of what a piece carries, [[E11, E12], [E21, E22]] */
RD_INLINE void first(const struct rates *E, struct triple *t)
{
    enum { ALL = 3 * WIDE };
    NUM A[WIDE][WIDE], X[WIDE][ALL], sum[STATE];
    NUM soft[WIDE][WIDE], inverse[WIDE][WIDE], zero[WIDE][WIDE];
    for (int c = 0; c < WIDE; c++) {
        column(E, c, sum);
        for (int i = 0; i < WIDE; i++)
            X[i][WIDE + c] = sum[WIDE + i];
        column(E, WIDE + c, sum);
        for (int i = 0; i < WIDE; i++) {
            const NUM one = number(i == c);
            zero[i][c] = number(0);
            soft[i][c] = sum[i];
            A[i][c] = add(sum[WIDE + i], one);
            X[i][c] = sum[WIDE + i];
            X[i][2 * WIDE + c] = one;
        }
    }
    divide(A, ALL, &X[0][0]);
    for (int i = 0; i < WIDE; i++)
        for (int j = 0; j < WIDE; j++) {
            t->D[j][i] = scaled(X[i][j], -1);
            t->Q[i][j] = X[i][WIDE + j];
            inverse[i][j] = X[i][2 * WIDE + j];
        }
    multiply(soft, inverse, t->G);
    add_symmetric(zero, t->G, t->G);
    add_symmetric(zero, t->Q, t->Q);
}

/* A <- A + A D */
RD_INLINE void carry(NUM A[WIDE][WIDE], const NUM D[WIDE][WIDE])
{
    NUM AD[WIDE][WIDE];
    multiply(A, D, AD);
    increase(A, AD);
}

/* C = A + (I + D)^T B (I + D) */
RD_INLINE void add_congruent(const NUM A[WIDE][WIDE], const NUM B[WIDE][WIDE],
                             const NUM D[WIDE][WIDE], NUM C[WIDE][WIDE])
{
    NUM BF[WIDE][WIDE], Dt[WIDE][WIDE], DtBF[WIDE][WIDE];
    memcpy(BF, B, sizeof BF);
    carry(BF, D);
    transpose(D, Dt);
    multiply(Dt, BF, DtBF);
    increase(BF, DtBF);
    add_symmetric(A, BF, C);
}

/* Of the inverse (I + G V)^-1 of a joint the largest entry, and the least of the norms by rows and by
   columns of what it is away from I. That is 1 and more once something has resonated: an eigenvalue
   of the inverse is negative there. */
struct nearness {
    SIZE largest, away;
};

RD_INLINE SIZE norm_of(const NUM A[WIDE][WIDE])
{
    SIZE most[2] = {size(number(0)), size(number(0))};
    for (int i = 0; i < WIDE; i++) {
        SIZE row = size(number(0)), column = row;
        for (int j = 0; j < WIDE; j++) {
            row += size(A[i][j]);
            column += size(A[j][i]);
        }
        most[0] = larger_size(most[0], row);
        most[1] = larger_size(most[1], column);
    }
    return lesser_size(most[0], most[1]);
}

/* Two pieces, a node's stiffness N (or NULL) between them, V = Q2 + N, X = (I + G1 V)^-1 G1:

       D = D1 + D2 + D2 D1 - F2 X V F1,  G = G2 + F2 X F2^T,  Q = Q1 + F1^T (V - V X V) F1

   Returns how near a resonance the joint is. */
RD_INLINE struct nearness join(const struct triple *one, const struct triple *two, const NUM *N,
                               struct triple *joined)
{
    enum { ALL = 2 * WIDE };
    NUM V[WIDE][WIDE], A[WIDE][WIDE], X[WIDE][WIDE], both[WIDE][ALL];
    memcpy(V, two->Q, sizeof V);
    for (int i = 0; N && i < WIDE; i++)
        for (int j = 0; j < WIDE; j++)
            V[i][j] = add(V[i][j], N[i * WIDE + j]);
    multiply(one->G, V, A);
    for (int i = 0; i < WIDE; i++)
        for (int j = 0; j < WIDE; j++) {
            both[i][j] = number(i == j);
            A[i][j] = add(A[i][j], both[i][j]);
            both[i][WIDE + j] = one->G[i][j];
        }
    divide(A, ALL, &both[0][0]);
    SIZE largest = size(both[0][0]);
    for (int i = 0; i < WIDE; i++)
        for (int j = 0; j < WIDE; j++) {
            largest = larger_size(largest, size(both[i][j]));
            X[i][j] = scaled(add(both[i][WIDE + j], both[j][WIDE + i]), 0.5);
        }
    NUM XV[WIDE][WIDE], S[WIDE][WIDE], Dt[WIDE][WIDE], T[WIDE][WIDE];
    struct triple found;
    multiply(X, V, XV);
    const struct nearness near = {largest, norm_of(XV)};
    multiply(V, XV, S);
    for (int i = 0; i < WIDE; i++)
        for (int j = 0; j < WIDE; j++)
            S[i][j] = subtract(V[i][j], S[i][j]);
    carry(XV, one->D);
    multiply(two->D, XV, T);
    multiply(two->D, one->D, found.D);
    for (int i = 0; i < WIDE; i++)
        for (int j = 0; j < WIDE; j++)
            found.D[i][j] = subtract(add(found.D[i][j], add(one->D[i][j], two->D[i][j])),
                                     add(XV[i][j], T[i][j]));
    transpose(two->D, Dt);
    add_congruent(two->G, X, Dt, found.G);
    add_congruent(one->Q, S, one->D, found.Q);
    *joined = found;
    return near;
}

/* The entries of a part of the length whose left end has the series (fields, RD_SPACE_ORDERS); (fields,
   3, 6, 6) of E_j. Orders that are nothing beside the others of their entry are none. */
RD_INLINE void rates_fill(size_t fields, const NUM *E, const double *series, double length,
                          struct rates *rates)
{
    rates->orders = 1;
    memset(rates->entries, 0, sizeof rates->entries);
    for (int i = 0; i < ENTRIES; i++) {
        const int row = i / STATE, col = i % STATE, r = row % WIDE, c = col % WIDE;
        /* Phi S / q -Phi^T */
        const int block = row < WIDE ? (col < WIDE ? 0 : 1) : (col < WIDE ? 2 : 0);
        const int turned = row >= WIDE && col >= WIDE;
        const size_t at = (size_t)(block * WIDE * WIDE + (turned ? c * WIDE + r : r * WIDE + c));
        size_t there = 0; /* up to the last field that has one */
        for (size_t j = 0; j < fields; j++)
            there = is_zero(E[j * TRIPLE + at]) ? there : j + 1;
        if (there == 0)
            continue;
        NUM sum[RD_SPACE_ORDERS], all = number(0);
        double power = turned ? -length : length;
        for (int k = 0; k < RD_SPACE_ORDERS; k++, power *= length) {
            sum[k] = number(0);
            for (size_t j = 0; j < there; j++) {
                const double own = series[j * RD_SPACE_ORDERS + (size_t)k];
                if (own != 0)
                    sum[k] = add(sum[k], scaled(E[j * TRIPLE + at], power * own));
            }
            all = add(all, sizes(sum[k]));
        }
        for (int k = 0; k < RD_SPACE_ORDERS; k++) {
            if (!exceeds(sum[k], all, NOTHING))
                continue;
            rates->orders = rates->orders > k ? rates->orders : k + 1;
            const int at_order = rates->entries[k]++;
            rates->value[k][at_order] = sum[k];
            rates->row[k][at_order] = (unsigned char)row;
            rates->column[k][at_order] = (unsigned char)col;
        }
    }
}

/* The parts of a piece, doubled so far as `left` halvings say: all alike, each as it is, or about nodes. */
struct family {
    int left, count;
    int equal; /* parts of the piece in the end */
    int poly;  /* nodes of the polynomial; 0: alike or as they are */
    double node[RD_SPACE_NODES],
        weight[RD_SPACE_NODES]; /* barycentric (Berrut and Trefethen 2004) */
    struct triple *at;          /* (RD_SPACE_NODES) */
};

/* parts of the piece after so many halvings of the equal ones, at most as many as are counted */
static inline int parts_of(int equal, int halvings)
{
    return halvings < 16 ? equal << halvings : 1 << 30;
}

/* the share of the piece that a part is */
static inline double share_of(const struct family *f)
{
    return ldexp(1, -f->left) / f->equal;
}

static inline void family_begin(const struct rd_space_run *run, struct triple *at, struct family *f)
{
    f->left = run->halvings;
    f->count = run->nodes;
    f->equal = run->equal;
    f->poly = run->nodes > 1 && run->nodes < parts_of(run->equal, run->halvings) ? run->nodes : 0;
    f->at = at;
    for (int j = 0; j < f->poly; j++) {
        const double angle = (2 * j + 1) * 1.5707963267948966 / f->poly;
        f->node[j] = cos(angle);
        f->weight[j] = j % 2 ? -sin(angle) : sin(angle);
    }
}

RD_INLINE void interpolate(const struct family *f, double x, struct triple *t)
{
    double weight[RD_SPACE_NODES], sum = 0;
    const int n = f->poly;
    int met = -1;
    for (int j = 0; j < n; j++) {
        const double far = x - f->node[j];
        met = far == 0 ? j : met;
        weight[j] = f->weight[j] / far;
        sum += weight[j];
    }
    if (met >= 0) {
        *t = f->at[met];
        return;
    }
    NUM *to = &t->D[0][0];
    for (int i = 0; i < TRIPLE; i++)
        to[i] = number(0);
    for (int j = 0; j < n; j++) {
        const NUM *from = &f->at[j].D[0][0];
        for (int i = 0; i < TRIPLE; i++)
            to[i] = add(to[i], scaled(from[i], weight[j] / sum));
    }
}

/* how many parts are kept after the next doubling, and whether they are those that lie there */
RD_INLINE int next_count(const struct family *f)
{
    if (!f->poly)
        return f->count == 1 ? 1 : f->count / 2;
    const int all = parts_of(f->equal, f->left - 1);
    return all <= f->poly ? all : f->poly;
}

/* the two that make part i of the next doubling; returns whether they are the same */
RD_INLINE int pair(const struct family *f, int i, struct triple *one, struct triple *two)
{
    if (!f->poly) {
        *one = f->at[f->count == 1 ? 0 : 2 * i];
        *two = f->at[f->count == 1 ? 0 : 2 * i + 1];
        return f->count == 1;
    }
    const double part = share_of(f);
    const int apart = parts_of(f->equal, f->left - 1) <= f->poly;
    const double x = apart ? (2 * i + 1) * 2 * part - 1 : f->node[i] * (1 - 2 * part);
    interpolate(f, (x - part) / (1 - part), one);
    interpolate(f, (x + part) / (1 - part), two);
    return 0;
}

/* parts of which the next doubling consists take the place of those there are */
RD_INLINE void advance(struct family *f, int count, const struct triple *longer)
{
    const int apart = parts_of(f->equal, f->left - 1) <= f->poly;
    memcpy(f->at, longer, (size_t)count * sizeof *longer);
    f->count = count;
    f->left--;
    f->poly = apart ? 0 : f->poly;
}

/* part k of equal 2^left */
RD_INLINE void part_of(const struct family *f, int k, struct triple *t)
{
    const double part = share_of(f);
    if (f->poly)
        interpolate(f, ((2 * k + 1) * part - 1) / (1 - part), t);
    else
        *t = f->at[f->count == 1 ? 0 : k];
}
