/* Eigenvalues below lambda of a rope in space, of WIDE coordinates: included by one source file each.

   Wittrick and Williams (1971): they are those of its parts, each held at its left end, and the negative
   pivots of what joins the parts. With motion u_i at the left of part i and force f_i at its right, the
   left ends' balance and the parts' own law are

       | Q_i + N_i   -F_i^T |  u_i, f_i, 1 between f_i and u_i+1,
       |   -F_i       -G_i  |

   a symmetric matrix that has as many negative pivots as the stiffness of the nodes has, and WIDE more a
   part; it exists where G is singular. Two parts of which only what is right of their joint is to
   move are joined by [[-G_1, 1], [1, Q_2 + N]]. */
#include "base/fast.h"
#include "base/lapack.h"
#include "space/width.h"

#include <assert.h>
#include <math.h>

#define NUM double
#define SIZE double
#define EITHER int

RD_INLINE double number(double a)
{
    return a;
}
RD_INLINE double add(double a, double b)
{
    return a + b;
}
RD_INLINE double subtract(double a, double b)
{
    return a - b;
}
RD_INLINE double times(double a, double b)
{
    return a * b;
}
RD_INLINE double scaled(double a, double s)
{
    return a * s;
}
RD_INLINE double over(double a)
{
    return 1 / a;
}
RD_INLINE double size(double a)
{
    return fabs(a);
}
/* NAN where one is */
RD_INLINE double larger_size(double a, double b)
{
    return a > b || isnan(a) ? a : b;
}
RD_INLINE double lesser_size(double a, double b)
{
    return a < b ? a : b;
}
RD_INLINE double sizes(double a)
{
    return fabs(a);
}
RD_INLINE int exceeds(double a, double b, double share)
{
    return fabs(a) > share * fabs(b);
}
RD_INLINE int is_zero(double a)
{
    return a == 0;
}
RD_INLINE int larger(double a, double b)
{
    return fabs(a) > fabs(b);
}
RD_INLINE int any(int either)
{
    return either;
}
RD_INLINE void exchange(double *a, double *b, int either)
{
    const double x = *a;
    *a = either ? *b : *a;
    *b = either ? x : *b;
}

#include "space/kernel.h"

enum {
    PARTS = 32,                   /* that are counted together */
    ALL = (2 * PARTS + 1) * WIDE, /* their unknowns */
    PAIR = 2 * WIDE,              /* unknowns of a joint */
    WORK = 64 * ALL,              /* of LAPACK */
    ODD = 9,                      /* first divisions of a piece that are tried, 1, 3 .. */
    HALVED = 12,                  /* times at most a piece that changes is left */
    TRIED = 2,                    /* divisions of a piece: the best and the next */
    INNER = -1,                   /* a node that nothing stands at */
    MOST_HALVINGS = 60,
};

/* of the first part that is summed as a series */
static const double RADIANS = 0.5;

/* Of joints of parts that are not counted: by 1 and more once something has resonated. */
static const double GENTLE = 0.9;

/* of what no force stretches, so that its force is not left open */
static const double COMPLIANT = 0x1p-50;

struct counting {
    const struct rd_space *rope;
    const double *z;
    double lambda, gentle;
    size_t parts;        /* so far, the last of which grows */
    double below;        /* eigenvalues of each part, its left end held */
    struct triple *part; /* (PARTS) */
    struct triple one[TRIED];
    double *E;           /* (fields, 3, 6, 6) of the piece, scaled */
    struct triple *kept; /* (pieces, RD_LANES, RD_SPACE_NODES) of pieces that change */
    int *left;           /* (pieces) halvings of these */
    size_t lane;         /* whose they are */
    lanes *many;         /* (fields, 3, 6, 6), E of all lanes */
    lanes *room;         /* of their doublings */
    int node[PARTS];     /* on the left of each */
    double *A;           /* (ALL, ALL) */
    double *work;        /* (WORK) */
    lapack_int pivot[ALL];
};

/* negative pivots of the lower triangle of A (n, n), by columns; one of 0 is not negative */
static int negative(struct counting *c, int n)
{
    int found = 0;
    LAPACKE_dsytrf_work(LAPACK_COL_MAJOR, 'L', n, c->A, n, c->pivot, c->work, WORK);
    for (int k = 0; k < n; k++) {
        const int two = c->pivot[k] < 0; /* one of either sign */
        found += two || c->A[k * n + k] < 0;
        k += two;
    }
    return found;
}

/* N of a node: stiffness - lambda mass */
static void node_fill(const struct counting *c, int node, double *N)
{
    const size_t at = (size_t)node * WIDE * WIDE;
    for (size_t i = 0; i < WIDE * WIDE; i++)
        N[i] = node == INNER ? 0
                             : c->z[i / WIDE] * c->z[i % WIDE] *
                                   (c->rope->stiffness[at + i] - c->lambda * c->rope->mass[at + i]);
}

/* Phi, S and q - lambda inertia of a piece, scaled */
static void rates_of(const struct counting *c, size_t p, double *E)
{
    const struct rd_space *rope = c->rope;
    const double *z = c->z, *from = rope->rates + p * rope->fields * TRIPLE;
    for (size_t j = 0; j < rope->fields; j++)
        for (size_t i = 0; i < WIDE; i++)
            for (size_t k = 0; k < WIDE; k++) {
                const size_t at = i * WIDE + k, all = WIDE * WIDE;
                const double mass = j == 0 ? rope->inertia[p * all + at] : 0;
                const double *one = from + j * TRIPLE + at;
                double *to = E + j * TRIPLE + at;
                to[0] = one[0] * z[k] / z[i];
                to[all] = one[all] / (z[i] * z[k]);
                to[2 * all] = (one[2 * all] - c->lambda * mass) * z[i] * z[k];
            }
}

/* whether G V < 1, so that no pivot of the joint 1 + G V is negative */
static int is_small(const struct triple *one, const struct triple *two, const double *N)
{
    double most = 0, row[WIDE] = {0};
    for (int i = 0; i < WIDE; i++)
        for (int j = 0; j < WIDE; j++)
            row[i] += fabs(two->Q[i][j] + N[i * WIDE + j]);
    for (int i = 0; i < WIDE; i++) {
        double sum = 0;
        for (int j = 0; j < WIDE; j++)
            sum += fabs(one->G[i][j]) * row[j];
        most = fmax(most, sum);
    }
    return most < 1;
}

/* what the joint of two parts adds to the counts of both */
static int joint(struct counting *c, const struct triple *one, const struct triple *two,
                 const double *N)
{
    if (is_small(one, two, N))
        return 0;
    memset(c->A, 0, PAIR * PAIR * sizeof *c->A);
    for (int j = 0; j < WIDE; j++) {
        c->A[j * PAIR + WIDE + j] = 1;
        for (int i = 0; i < WIDE; i++) {
            c->A[j * PAIR + i] = -one->G[i][j];
            c->A[(WIDE + j) * PAIR + WIDE + i] = two->Q[i][j] + N[i * WIDE + j];
        }
    }
    return negative(c, PAIR) - WIDE;
}

/* F <- F R, Q <- R^T Q R: what begins with a kink */
static void turn(const struct counting *c, struct triple *t, const double *R)
{
    double by[WIDE][WIDE], DR[WIDE][WIDE], none[WIDE][WIDE] = {{0}};
    for (int i = 0; i < WIDE; i++)
        for (int j = 0; j < WIDE; j++)
            by[i][j] = R[i * WIDE + j] * c->z[j] / c->z[i] - (i == j);
    memcpy(DR, t->D, sizeof DR);
    carry(DR, by); /* D R */
    memcpy(t->D, by, sizeof by);
    increase(t->D, DR);
    add_congruent(none, t->Q, by, t->Q);
}

/* a part of so many eigenvalues behind those there are; false where they are too many */
static int part_add(struct counting *c, const struct triple *next, double below, int node,
                    int apart)
{
    struct triple joined;
    double N[WIDE * WIDE];
    node_fill(c, node, N);
    c->below += below;
    if (!apart && join(c->part + c->parts - 1, next, N, &joined).largest <= c->gentle) {
        c->below += joint(c, c->part + c->parts - 1, next, N);
        c->part[c->parts - 1] = joined;
        return 1;
    }
    if (c->parts == PARTS)
        return 0;
    c->part[c->parts] = *next;
    c->node[c->parts++] = node;
    return 1;
}

static int is_held(const struct rd_space *rope, size_t node)
{
    int any = 0;
    for (size_t i = 0; i < WIDE; i++)
        any |= rope->held[node * WIDE + i];
    return any;
}

/* One doubling of parts that are alike, while their joints are gentle; *below are the eigenvalues of each. */
static int doubled(struct counting *c, struct family *f, double *below)
{
    const double nothing[WIDE * WIDE] = {0};
    struct triple longer;
    /* at a resonance there is no joint, but numbers that are none */
    if (!(join(f->at, f->at, NULL, &longer).largest <= c->gentle))
        return 0;
    *below = 2 * *below + joint(c, f->at, f->at, nothing);
    advance(f, 1, &longer);
    return 1;
}

/* a norm of [[Phi, S], [q, -Phi^T]] of the piece, the lesser of those by rows and by columns */
static double size_of_rates(const struct counting *c)
{
    double row[2 * WIDE] = {0}, column[2 * WIDE] = {0}, by_rows = 0, by_columns = 0;
    for (size_t i = 0; i < WIDE; i++)
        for (size_t k = 0; k < WIDE; k++) {
            const double *at = c->E + i * WIDE + k;
            const double phi = fabs(at[0]), S = fabs(at[WIDE * WIDE]),
                         q = fabs(at[2 * WIDE * WIDE]);
            row[i] += phi + S;
            row[WIDE + i] += q;
            row[WIDE + k] += phi;
            column[k] += phi + q;
            column[WIDE + k] += S;
            column[WIDE + i] += phi;
        }
    for (size_t i = 0; i < 2 * WIDE; i++) {
        by_rows = fmax(by_rows, row[i]);
        by_columns = fmax(by_columns, column[i]);
    }
    return fmin(by_rows, by_columns);
}

/* how often piece p is halved for its series */
static int halvings_of(const struct counting *c, size_t p)
{
    if (c->rope->fields > 1)
        return c->rope->halvings[p];
    const double halved = ceil(log2(size_of_rates(c) * c->rope->length[p] / RADIANS));
    return halved > 0 ? (int)fmin(halved, MOST_HALVINGS) : 0;
}

/* one part of an `odd`th of piece p, of a series */
static void family_fill(struct counting *c, size_t p, size_t row, int odd, struct family *f)
{
    const struct rd_space *rope = c->rope;
    const struct rd_space_run run = {.equal = odd, .halvings = halvings_of(c, p), .nodes = 1};
    struct rates rates;
    family_begin(&run, f->at, f);
    rates_fill(1, c->E, rope->series + row * RD_SPACE_ORDERS, rope->length[p] * share_of(f),
               &rates);
    first(&rates, f->at);
}

/* so many copies of what there is of piece p, each of so many eigenvalues */
static int copies_add(struct counting *c, size_t p, const struct family *f, int copies,
                      double below)
{
    struct triple t;
    for (int k = 0; k < copies; k++) {
        const int apart = k == 0 && (p == 0 || is_held(c->rope, p));
        part_of(f, k, &t);
        if (k == 0)
            turn(c, &t, c->rope->turn + p * WIDE * WIDE);
        if (!part_add(c, &t, below, k == 0 ? (int)p : INNER, apart))
            return 0;
    }
    return 1;
}

/* Piece p, alike all along. A joint of two halves near a resonance is that of all their equals: a piece of which
   one is met is divided by three first, or five .., whose halves resonate elsewhere. */
static int piece_add(struct counting *c, size_t p, size_t row)
{
    struct family tried[TRIED];
    double below = 0, own;
    int copies = PARTS + 1, best = 0;
    rates_of(c, p, c->E);
    for (int odd = 1, left = 1; odd <= ODD && left > 0; odd += 2) {
        struct family *f = tried + !best;
        f->at = c->one + !best;
        own = 0;
        family_fill(c, p, row, odd, f);
        while (f->left > 0 && doubled(c, f, &own))
            ;
        left = f->left;
        if (left > 20 || odd << left >= copies)
            continue;
        copies = odd << left;
        best = !best;
        below = own;
    }
    return copies <= PARTS && copies_add(c, p, tried + best, copies, below);
}

/* how piece p, along which something changes, is divided and doubled */
static struct rd_space_run run_of(const struct rd_space *rope, size_t p, size_t row)
{
    return (struct rd_space_run){
        .width = WIDE,
        .length = rope->length[p],
        .equal = 1,
        .halvings = rope->halvings[p],
        .nodes = rope->nodes[p],
        .fields = rope->fields,
        .series = rope->series + row * rope->fields * RD_SPACE_ORDERS,
    };
}

/* the parts of all pieces at up to RD_LANES eigenvalues: lanes beyond the last are that once more */
static void pieces_double(struct counting *c, size_t count, const double *lambda, const double *z)
{
    const struct rd_space *rope = c->rope;
    for (size_t p = 0, row = 0; p < rope->pieces; row += (size_t)rope->nodes[p], p++) {
        for (size_t lane = 0; lane < RD_LANES; lane++) {
            const size_t k = lane < count ? lane : count - 1;
            c->lambda = lambda[k];
            c->z = z + k * WIDE;
            rates_of(c, p, c->E);
            for (size_t i = 0; i < rope->fields * TRIPLE; i++)
                c->many[i][lane] = c->E[i];
        }
        const struct rd_space_run run = run_of(rope, p, row);
        struct triple *kept = c->kept + p * RD_LANES * RD_SPACE_NODES;
        c->left[p] = run.halvings - RD_SPACE_(family)(&run, c->many, run.halvings, GENTLE,
                                                      &kept->D[0][0], c->room);
    }
}

/* piece p, along which something changes, from what is kept of it: no part has an eigenvalue */
static int changing_add(struct counting *c, size_t p, size_t row)
{
    const struct rd_space_run run = run_of(c->rope, p, row);
    struct family f;
    family_begin(&run, c->kept + (p * RD_LANES + c->lane) * RD_SPACE_NODES, &f);
    f.left = c->left[p];
    f.poly = parts_of(1, f.left) <= f.poly ? 0 : f.poly;
    f.count = f.poly > 0 ? f.poly : parts_of(1, f.left);
    return f.left <= HALVED && copies_add(c, p, &f, parts_of(1, f.left), 0);
}

/* A(row, column) += value, in the lower triangle */
static void put(struct counting *c, int rows, int row, int column, double value)
{
    if (row >= 0 && column >= 0)
        c->A[row > column ? column * rows + row : row * rows + column] += value;
}

/* The parts that are left, and all nodes between them and at the ends. */
static double parts_count(struct counting *c)
{
    const size_t nodes = c->parts + !c->rope->closed;
    int place[ALL], rows = 0;
    for (size_t k = 0; k <= c->parts; k++) {
        const int node = k == c->parts ? (int)c->rope->pieces : c->node[k];
        for (size_t i = 0; i < WIDE; i++) {
            const int held = node != INNER && c->rope->held[(size_t)node * WIDE + i];
            place[2 * k * WIDE + i] = k == nodes ? place[i] : held ? -1 : rows++;
        }
        for (size_t i = 0; i < WIDE && k < c->parts; i++)
            place[(2 * k + 1) * WIDE + i] = rows++;
    }
    assert(rows <= ALL);
    memset(c->A, 0, (size_t)(rows * rows) * sizeof *c->A);
    for (size_t k = 0; k < nodes; k++) {
        const int *u = place + 2 * k * WIDE, *f = u + WIDE;
        double N[WIDE * WIDE];
        node_fill(c, k == c->parts ? (int)c->rope->pieces : c->node[k], N);
        for (int i = 0; i < WIDE; i++)
            for (int j = 0; j < WIDE; j++) {
                const struct triple *t = c->part + k;
                if (j <= i)
                    put(c, rows, u[i], u[j], N[i * WIDE + j] + (k < c->parts ? t->Q[i][j] : 0));
                if (k == c->parts)
                    continue;
                if (j <= i)
                    put(c, rows, f[i], f[j], -t->G[i][j] - (i == j ? COMPLIANT : 0));
                put(c, rows, f[i], u[j], -t->D[i][j] - (i == j));
                if (i == j)
                    put(c, rows, f[i], f[WIDE + i], 1);
            }
    }
    return c->below + negative(c, rows) - (double)(c->parts * WIDE);
}

static double count_one(struct counting *c, double lambda, double gentle)
{
    c->lambda = lambda;
    c->gentle = gentle;
    c->parts = 0;
    c->below = 0;
    size_t row = 0;
    for (size_t p = 0; p < c->rope->pieces; row += (size_t)c->rope->nodes[p], p++)
        if (!(c->rope->fields > 1 ? changing_add : piece_add)(c, p, row))
            return NAN;
    return parts_count(c);
}

/* one component of a rope of several */
static struct rd_space component_of(const struct rd_space *rope, size_t k)
{
    const size_t pieces = k * rope->pieces, nodes = pieces + k, all = WIDE * WIDE;
    struct rd_space own = *rope;
    own.components = 1;
    own.rates += pieces * rope->fields * TRIPLE;
    own.inertia += pieces * all;
    own.turn += pieces * all;
    own.stiffness += nodes * all;
    own.mass += nodes * all;
    own.held += nodes * WIDE;
    return own;
}

enum rd_status RD_SPACE_(count)(const struct rd_space *rope, size_t count, const int32_t *component,
                                const double *lambda, const double *z, double *below,
                                struct rd_workspace *workspace)
{
    struct rd_space own;
    struct counting c = {.rope = &own};
    c.part = rd_take(workspace, PARTS, sizeof *c.part);
    c.E = rd_take(workspace, rope->fields * TRIPLE, sizeof *c.E);
    c.A = rd_take(workspace, (size_t)ALL * ALL, sizeof *c.A);
    c.work = rd_take(workspace, WORK, sizeof *c.work);
    if (rope->fields > 1) {
        c.left = rd_take(workspace, rope->pieces, sizeof *c.left);
        c.kept = rd_take(workspace, rope->pieces * RD_LANES * RD_SPACE_NODES, sizeof *c.kept);
        c.many = rd_take_aligned(workspace, rope->fields * TRIPLE, sizeof *c.many, sizeof(lanes));
        c.room =
            rd_take_aligned(workspace, rd_space_family_room(WIDE), sizeof *c.room, sizeof(lanes));
    }
    if (!rd_workspace_fits(workspace))
        return RD_NO_MEMORY;
    for (size_t k = 0, first = 0, last = 0; workspace->base && k < count; k++) {
        own = component_of(rope, (size_t)component[k]);
        if (rope->fields > 1 && k == last) {
            for (first = k; last < count && last < first + RD_LANES; last++)
                if (component[last] != component[first])
                    break;
            pieces_double(&c, last - first, lambda + first, z + first * WIDE);
        }
        c.lane = k - first;
        c.z = z + k * WIDE;
        for (int i = 0; i == 0 || (i < RD_SPACE_GENTLE && isnan(below[k])); i++)
            below[k] = count_one(&c, lambda[k], rd_space_gentle[i]);
    }
    return RD_OK;
}
