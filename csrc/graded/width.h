/* The family of a block for the width RD_GRADED: included by one source file per width.

   Let P_h(s) be the triple of the piece of length h about s, a smooth function of s. Known at nodes s_i
   of the part of the block where there are such pieces, it is known between them, so that

       P_2h(s) = join(P_h(s - h/2), P_h(s + h/2))

   takes pieces twice as long to as many nodes of the part where those are. */
#include "graded/family.h"
#include "graded/polynomial.h"

#include <math.h>
#include <string.h>

#pragma GCC diagnostic ignored "-Wpsabi"

#define W RD_GRADED
#include "span/slice.h"

#define NAME_(verb, w) rd_##verb##_##w
#define NAME_OF(verb, w) NAME_(verb, w)
#define K_(verb) NAME_OF(verb, RD_GRADED)

enum { FULL = W * W, SYM = W * (W + 1) / 2, ALL = FULL + 2 * SYM };

/* where the block begins: q of beta, or S' of a string, and how they grow along it */
struct near_end {
    const struct rate_matrix *rate;
    cv load, slope;  /* q of a beam, and its slope [1/m] */
    cv soft, growth; /* S' of a string, and the slope of its tension, relative [1/m] */
    int terms;
};

RD_INLINE struct near_end near_end_of(const struct rd_field *field, const struct rd_block *block)
{
    const double far = (block->tension - field->tension) / block->slope;
    const cv tension = {l_fill(block->tension), l_fill(field->more + far * field->steeper)};
    const cv slope = {l_fill(block->slope), l_fill(field->steeper)};
    struct near_end end = {.rate = field->rate, .terms = block->terms};
    if (W == 1) {
        const cv unit = c_scale(field->rate->S[0][0], field->tension), per = c_inverse(tension);
        end.soft = c_mul(unit, per);
        end.growth = c_mul(slope, per);
    } else {
        const cv more = c_sub(tension, c_real(field->tension));
        end.load = c_add(field->rate->q[W - 1], c_mul(field->pull, more));
        end.slope = c_mul(field->pull, slope);
    }
    return end;
}

/* place of (i, j), i <= j, in a packed symmetric matrix */
RD_INLINE int at(int i, int j)
{
    return i * W - i * (i - 1) / 2 + j - i;
}

#if RD_GRADED == 1
/* Columns of the transfer of a string of length l, less I, beginning at s, of (z, f):
   T (1 + g s) z' = f, f' = q z by powers of s, (k + 1) a_k+1 = S' b_k - g k a_k, (k + 1) b_k+1 = q a_k */
RD_INLINE void columns(const struct near_end *end, double s, double l, cv x[2 * W][2 * W])
{
    const cv here = c_scale(c_inverse(c_add(c_real(1), c_scale(end->growth, s))), l);
    const cv soft = c_mul(end->soft, here), g = c_mul(end->growth, here);
    const cv q = c_scale(end->rate->q[0], l);
    enum { MORE = 14 }; /* the tension changes by so little that its powers end with these */
    for (int c = 0; c < 2; c++) {
        cv a = c_real(c == 0), b = c_real(c == 1);
        x[0][c] = x[1][c] = c_zero();
        for (int k = 0; k < end->terms + MORE; k++) {
            const cv next = c_sub(c_mul(soft, b), c_mul(g, c_scale(a, k)));
            b = c_scale(c_mul(q, a), 1.0 / (k + 1));
            a = c_scale(next, 1.0 / (k + 1));
            x[0][c] = c_add(x[0][c], a);
            x[1][c] = c_add(x[1][c], b);
        }
    }
}
#else
/* Columns of the transfer of a beam of length l, less I, beginning at s, of (z, beta, F, M): with
   M' = (q + q' s) beta - r F its powers of s have (k + 1) M_k+1 = q beta_k + q' beta_k-1 - r F_k */
RD_INLINE void columns(const struct near_end *end, double s, double l, cv x[2 * W][2 * W])
{
    const lanes r = end->rate->lever * l;
    const cv soft = c_scale(end->rate->S[W - 1][W - 1], l), q = c_scale(end->rate->q[0], l);
    const cv load = c_scale(c_add(end->load, c_scale(end->slope, s)), l);
    const cv slope = c_scale(end->slope, l * l);
    enum { MORE = 4 };
    for (int c = 0; c < 2 * W; c++) {
        cv y[2 * W], before = c_zero();
        for (int i = 0; i < 2 * W; i++) {
            y[i] = c_real(i == c);
            x[i][c] = c_zero();
        }
        for (int k = 0; k < end->terms + MORE; k++) {
            const double per = 1.0 / (k + 1);
            const cv turn = y[1], moved = c_add(c_mul(load, turn), c_mul(slope, before));
            const cv force = c_scale(c_mul(q, y[0]), per);
            y[0] = c_scale(c_scale_lanes(turn, r), per);
            y[1] = c_scale(c_mul(soft, y[3]), per);
            y[3] = c_scale(c_sub(moved, c_scale_lanes(y[2], r)), per);
            y[2] = force;
            before = turn;
            for (int i = 0; i < 2 * W; i++)
                x[i][c] = c_add(x[i][c], y[i]);
        }
    }
}
#endif

/* the triple of such a piece: with E = [[E11, E12], [E21, E22]] F^T = E22^-1, G = E12 E22^-1 and
   Q = E22^-1 E21 */
RD_INLINE void slice(const struct near_end *end, double s, double l, cv *triple)
{
    cv x[2 * W][2 * W], A[W][W], change[W][W], B[W][W], C[W][W], inverse[W][W];
    columns(end, s, l, x);
    for (int i = 0; i < W; i++)
        for (int j = 0; j < W; j++) {
            change[i][j] = A[i][j] = x[W + i][W + j];
            A[i][j].re += (double)(i == j);
            B[i][j] = x[i][W + j];
            C[i][j] = x[W + i][j];
        }
    c_slice_invert(A, inverse);
    for (int i = 0; i < W; i++)
        for (int j = 0; j < W; j++) {
            triple[j * W + i] = c_neg(c_slice_product(inverse, change, i, j));
            if (j < i)
                continue;
            triple[FULL + at(i, j)] = c_slice_product(B, inverse, i, j);
            triple[FULL + SYM + at(i, j)] = c_slice_product(inverse, C, i, j);
        }
}

RD_INLINE void unpack(const cv *triple, cv F[W][W], cv G[W][W], cv Q[W][W])
{
    for (int i = 0; i < W; i++)
        for (int j = 0; j < W; j++) {
            F[i][j] = triple[i * W + j];
            F[i][j].re += (double)(i == j);
            G[i][j] = triple[FULL + (i <= j ? at(i, j) : at(j, i))];
            Q[i][j] = triple[FULL + SYM + (i <= j ? at(i, j) : at(j, i))];
        }
}

/* sum over k of A_ki B_kj, and of A_ik B_jk */
RD_INLINE cv product_tn(const cv A[W][W], const cv B[W][W], int i, int j)
{
    cv sum = c_mul(A[0][i], B[0][j]);
    for (int k = 1; k < W; k++)
        sum = c_add(sum, c_mul(A[k][i], B[k][j]));
    return sum;
}

RD_INLINE cv product_nt(const cv A[W][W], const cv B[W][W], int i, int j)
{
    cv sum = c_mul(A[i][0], B[j][0]);
    for (int k = 1; k < W; k++)
        sum = c_add(sum, c_mul(A[i][k], B[j][k]));
    return sum;
}

/* joined, which is neither of both: with M = (I + G1 Q2)^-1, X = M G1, Y = Q2 M:
       D = D1 + D2 + D2 D1 - F2 X Q2 F1,  G = G2 + F2 X F2^T,  Q = Q1 + F1^T Y F1 */
RD_INLINE void join(const cv *one, const cv *two, cv *joined)
{
    cv F1[W][W], G1[W][W], Q1[W][W], F2[W][W], G2[W][W], Q2[W][W];
    cv A[W][W], M[W][W], X[W][W], Y[W][W], QF[W][W], YF[W][W], FX[W][W];
    unpack(one, F1, G1, Q1);
    unpack(two, F2, G2, Q2);
    for (int i = 0; i < W; i++)
        for (int j = 0; j < W; j++) {
            A[i][j] = c_slice_product(G1, Q2, i, j);
            A[i][j].re += (double)(i == j);
        }
    c_slice_invert(A, M);
    for (int i = 0; i < W; i++)
        for (int j = 0; j < W; j++) {
            X[i][j] = c_slice_product(M, G1, i, j);
            Y[i][j] = c_slice_product(Q2, M, i, j);
            QF[i][j] = c_slice_product(Q2, F1, i, j);
        }
    for (int i = 0; i < W; i++)
        for (int j = 0; j < W; j++) {
            FX[i][j] = c_slice_product(F2, X, i, j);
            YF[i][j] = c_slice_product(Y, F1, i, j);
        }
    for (int i = 0; i < W; i++)
        for (int j = 0; j < W; j++) {
            cv D = c_add(one[i * W + j], two[i * W + j]);
            for (int k = 0; k < W; k++)
                D = c_add(D, c_mul(two[i * W + k], one[k * W + j]));
            joined[i * W + j] = c_sub(D, c_slice_product(FX, QF, i, j));
            if (j < i)
                continue;
            joined[FULL + at(i, j)] = c_add(G2[i][j], product_nt(FX, F2, i, j));
            joined[FULL + SYM + at(i, j)] = c_add(Q1[i][j], product_tn(F1, YF, i, j));
        }
}

RD_INLINE void interpolate(int nodes, const double *weight, const cv at_nodes[][RD_GRADED_TRIPLE],
                           cv *triple)
{
    for (int i = 0; i < ALL; i++) {
        cv sum = c_scale(at_nodes[0][i], weight[0]);
        for (int j = 1; j < nodes; j++)
            sum = c_add(sum, c_scale(at_nodes[j][i], weight[j]));
        triple[i] = sum;
    }
}

/* Values at the nodes by pairs that lie opposite each other: half their sums and half their differences,
   and the value in the middle where there is one. A polynomial at x and at -x has the same even part, and
   its odd part with the other sign. */
struct opposite {
    int pairs, nodes;
    cv even[RD_NODES_MOST / 2][ALL], odd[RD_NODES_MOST / 2][ALL];
    const cv *middle;
};

RD_INLINE void opposite_fill(int n, const cv at_nodes[][RD_GRADED_TRIPLE], struct opposite *o)
{
    o->pairs = n / 2;
    o->nodes = n;
    o->middle = n % 2 ? at_nodes[n / 2] : NULL;
    for (int j = 0; j < o->pairs; j++)
        for (int i = 0; i < ALL; i++) {
            const cv one = at_nodes[j][i], other = at_nodes[n - 1 - j][i];
            o->even[j][i] = c_scale(c_add(one, other), 0.5);
            o->odd[j][i] = c_scale(c_sub(one, other), 0.5);
        }
}

/* where the nodes count for `weight`, and opposite to there */
RD_INLINE void interpolate_both(const struct opposite *o, const double *weight, cv *there,
                                cv *opposite)
{
    const int n = o->nodes;
    for (int i = 0; i < ALL; i++) {
        cv even = o->middle ? c_scale(o->middle[i], weight[n / 2]) : c_zero(), odd = c_zero();
        for (int j = 0; j < o->pairs; j++) {
            even = c_add(even, c_scale(o->even[j][i], weight[j] + weight[n - 1 - j]));
            odd = c_add(odd, c_scale(o->odd[j][i], weight[j] - weight[n - 1 - j]));
        }
        there[i] = c_add(even, odd);
        opposite[i] = c_sub(even, odd);
    }
}

/* pieces about the nodes of the part of the block where they are whole, in units of half of it; `part`
   of the block is a piece's length. The piece on the right of a node lies opposite to that on the left
   of the opposite node. */
RD_INLINE void family_double(int n, double part, cv from[][RD_GRADED_TRIPLE],
                             cv to[][RD_GRADED_TRIPLE])
{
    double node[RD_NODES_MOST], weight[RD_NODES_MOST];
    cv left[RD_NODES_MOST][ALL], right[RD_NODES_MOST][ALL];
    struct opposite values;
    rd_nodes(n, node);
    opposite_fill(n, (const cv(*)[RD_GRADED_TRIPLE])from, &values);
    for (int i = 0; i < n; i++) {
        rd_nodes_weigh(n, node, (node[i] * (1 - 2 * part) + part) / (1 - part), weight);
        interpolate_both(&values, weight, right[i], left[n - 1 - i]);
    }
    for (int i = 0; i < n; i++)
        join(left[i], right[i], to[i]);
}

/* pieces by their number where they are no more than the nodes, else about these */
static RD_CLONES void first(const struct near_end *end, const struct rd_block *block, bool apart,
                            cv (*P)[RD_GRADED_TRIPLE])
{
    double node[RD_NODES_MOST];
    const double l = ldexp(block->length, -block->halvings);
    const int count = apart ? 1 << block->halvings : block->nodes;
    if (!apart)
        rd_nodes(block->nodes, node);
    for (int i = 0; i < count; i++)
        slice(end, apart ? l * i : 0.5 * (1 + node[i]) * (block->length - l), l, P[i]);
}

static RD_CLONES void level(const struct rd_block *block, int k, cv (*from)[RD_GRADED_TRIPLE],
                            cv (*to)[RD_GRADED_TRIPLE])
{
    family_double(block->nodes, ldexp(1, k - block->halvings), from, to);
}

static RD_CLONES void pair_up(int count, cv (*P)[RD_GRADED_TRIPLE])
{
    for (int i = 0; i < count; i++) {
        cv joined[ALL];
        join(P[2 * i], P[2 * i + 1], joined);
        memcpy(P[i], joined, sizeof joined);
    }
}

/* `part` of the block is a piece */
static RD_CLONES void piece(int n, double part, size_t i, const cv (*P)[RD_GRADED_TRIPLE],
                            cv *triple)
{
    double node[RD_NODES_MOST], weight[RD_NODES_MOST];
    rd_nodes(n, node);
    rd_nodes_weigh(n, node, part < 1 ? (2 * ((double)i + 0.5) * part - 1) / (1 - part) : 0, weight);
    interpolate(n, weight, P, triple);
}

static RD_CLONES void join_two(const cv *one, const cv *two, cv *joined)
{
    cv result[ALL];
    join(one, two, result);
    memcpy(joined, result, sizeof result);
}

/* The part of a string at whose end the tension T' s vanishes, of which it takes no force: with
   c = q/T' z = sum (c s)^k/k!^2 there (Bessel's J0) and f = q sum c^k s^(k+1)/((k+1) k!^2), and its
   motion is that of this end alone, G = 0: F = z(l), Q = F f(l), or backward F = 1/z(l) and
   Q = f(l)/z(l). */
RD_INLINE void vanishing(const struct rd_field *field, const struct rd_block *block, cv *triple)
{
    enum { TERMS = 14 };
    const double l = block->length;
    const cv q = field->rate->q[0], unit = c_scale(field->rate->S[0][0], field->tension);
    const cv slope = {l_fill(block->slope), l_fill(field->steeper)};
    const cv steep = block->slope < 0 ? c_neg(slope) : slope;
    const cv x = c_scale(c_mul(c_mul(q, unit), c_inverse(steep)), l);
    cv term = c_real(1), more = c_zero(), f = c_real(1);
    for (int k = 1; k < TERMS; k++) {
        term = c_scale(c_mul(term, x), 1.0 / (k * k));
        more = c_add(more, term);
        f = c_add(f, c_scale(term, 1.0 / (k + 1)));
    }
    f = c_scale(c_mul(f, q), l);
    const cv z = c_add(more, c_real(1)), back = c_inverse(z);
    const bool behind = block->slope < 0;
    triple[0] = behind ? c_neg(c_mul(more, back)) : more;
    triple[FULL] = c_zero();
    triple[FULL + SYM] = c_mul(f, behind ? back : z);
}

void K_(family_fill)(const struct rd_field *field, const struct rd_block *block,
                     struct rd_family *family)
{
    cv other[RD_NODES_MOST][RD_GRADED_TRIPLE];
    cv(*P)[RD_GRADED_TRIPLE] = family->at, (*Q)[RD_GRADED_TRIPLE] = other;
    family->apart = 1;
    if (W == 1 && block->vanishes) {
        vanishing(field, block, P[0]);
        return;
    }
    const struct near_end end = near_end_of(field, block);
    int count = block->halvings < 30 ? 1 << block->halvings : RD_NODES_MOST + 1;
    family->apart = count <= block->nodes;
    first(&end, block, family->apart, P);
    for (int k = 0; k < block->doublings; k++) {
        const int left = block->halvings - k;
        if (!family->apart && left < 30 && 1 << left <= block->nodes) {
            count = 1 << left;
            for (int i = 0; i < count; i++)
                piece(block->nodes, ldexp(1, -left), (size_t)i, (const cv(*)[RD_GRADED_TRIPLE])P,
                      Q[i]);
            memcpy(P, Q, sizeof other);
            family->apart = 1;
        }
        if (family->apart) {
            pair_up(count /= 2, P);
            continue;
        }
        level(block, k, P, Q);
        memcpy(P, Q, sizeof other);
    }
}

void K_(family_piece)(const struct rd_family *family, size_t i, cv *triple)
{
    const struct rd_block *block = family->block;
    if (family->apart)
        memcpy(triple, family->at[i], ALL * sizeof *triple);
    else
        piece(block->nodes, ldexp(1, block->doublings - block->halvings), i,
              (const cv(*)[RD_GRADED_TRIPLE])family->at, triple);
}

void K_(family_join)(const cv *next, cv *triple)
{
    join_two(triple, next, triple);
}
