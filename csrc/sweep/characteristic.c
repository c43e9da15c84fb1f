/* The characteristic function, by carrying the motions that the left end allows.

   Columns of Y = (U; V), V the force of the right part on the left, span all motions of the part
   behind the walk. They are kept orthonormal, so there is no frequency at which they do not exist,
   whatever the damping and wherever s lies; what that takes out of the determinant is accumulated. */
#include "sweep/characteristic.h"

#include "graded/family.h"
#include "span/span.h"
#include "sweep/foot.h"

#include <assert.h>
#include <math.h>

#pragma GCC diagnostic ignored "-Wpsabi"

enum { W = RD_WIDTH_MAX, PACKED = W * W + 2 * RD_PAIRS_MAX };

static const struct sweep_kernel *const kernels[] = {&rd_sweep_kernel_1, &rd_sweep_kernel_2,
                                                     &rd_sweep_kernel_3, &rd_sweep_kernel_4};

/* a product too long for the exponent of a double: value 2^exponent e^growth */
struct product {
    cv value;
    lanes exponent, growth;
};

struct motions {
    cv U[W][W], V[W][W]; /* of column j in entry [.][j] */
    struct product product;
};

struct rd_characteristic {
    const struct rd_chain *chain;
    const struct sweep_kernel *kernel;
    struct rd_runs runs;
    struct sweep_extent bound;
    struct sweep_block block;
    struct sweep_way way[2];
    struct sweep_foot *foot; /* (attached) */
    struct motions motions;
    cv value;     /* what the right end leaves of them */
    int power[W]; /* of the scale of each coordinate in the product */
    size_t stretch, steps;
};

/* --- small matrices -------------------------------------------------------------------------- */

RD_INLINE cv c_conj(cv a)
{
    return (cv){a.re, -a.im};
}

RD_INLINE lanes c_square(cv a)
{
    return a.re * a.re + a.im * a.im;
}

RD_INLINE lanes l_sqrt(lanes a)
{
    for (int k = 0; k < RD_LANES; k++)
        a[k] = sqrt(a[k]);
    return a;
}

/* value *= x with the power of two taken out */
RD_INLINE void multiply(struct product *p, cv x)
{
    const cv v = c_mul(p->value, x);
    const lanes size = c_size(v) + 0x1p-1000;
    const lane_mask field = (lane_mask){0} + 0x7ff0000000000000LL;
    const lane_mask bits = (lane_mask)size & field;
    const lanes down = (lanes)((lane_mask){0} + 0x7fe0000000000000LL - bits); /* 1/2^e */
    p->value = c_scale_lanes(v, down);
    p->exponent += __builtin_convertvector(bits >> 52, lanes) - 1023.0;
}

/* H = I - t v v^*, unitary with determinant -1, H x = alpha e_1; v over x. Returns alpha. */
RD_INLINE cv reflector(cv *x, size_t stride, size_t rows, lanes *t)
{
    lanes square = {0};
    for (size_t i = 0; i < rows; i++)
        square += c_square(x[i * stride]);
    const lanes norm = l_sqrt(square), first = l_sqrt(c_square(x[0]));
    const lane_mask turned = first > 0.0;
    const lanes inverse = 1.0 / l_select(turned, first, l_fill(1.0));
    const cv phase = {l_select(turned, x[0].re * inverse, l_fill(1.0)),
                      l_select(turned, x[0].im * inverse, l_fill(0.0))};
    x[0] = c_scale_lanes(phase, first + norm);
    const lanes half = norm * (norm + first);
    *t = 1.0 / l_select(half > 0.0, half, l_fill(INFINITY));
    return c_scale_lanes(phase, -norm);
}

/* y <- H y */
RD_INLINE void reflect(const cv *v, size_t v_stride, lanes t, cv *y, size_t stride, size_t rows)
{
    cv dot = c_zero();
    for (size_t i = 0; i < rows; i++)
        dot = c_add(dot, c_mul(c_conj(v[i * v_stride]), y[i * stride]));
    dot = c_scale_lanes(dot, t);
    for (size_t i = 0; i < rows; i++)
        y[i * stride] = c_sub(y[i * stride], c_mul(v[i * v_stride], dot));
}

/* A (rows, w) = Q R, R's diagonal, the reflectors over A */
RD_INLINE void factorise(size_t w, size_t rows, cv (*A)[W], lanes *t, cv *diagonal)
{
    for (size_t k = 0; k < w; k++) {
        diagonal[k] = reflector(&A[k][k], W, rows - k, t + k);
        for (size_t j = k + 1; j < w; j++)
            reflect(&A[k][k], W, t[k], &A[k][j], W, rows - k);
    }
}

/* columns from .. from + w - 1 of Q */
RD_INLINE void unitary(size_t w, size_t rows, const cv (*A)[W], const lanes *t, size_t from,
                       cv (*Q)[W])
{
    for (size_t j = 0; j < w; j++) {
        for (size_t i = 0; i < rows; i++)
            Q[i][j] = c_real(i == from + j);
        for (size_t k = w; k-- > 0;)
            reflect(&A[k][k], W, t[k], &Q[k][j], W, rows - k);
    }
}

/* --- one step -------------------------------------------------------------------------------- */

/* place of (i, j) in a packed symmetric matrix */
static size_t at(size_t w, size_t i, size_t j)
{
    return i <= j ? i * w - i * (i + 1) / 2 + j : j * w - j * (j + 1) / 2 + i;
}

/* (U; V) <- Q of Y (2w, w) = Q R */
RD_INLINE void keep(const size_t w, cv (*Y)[W], struct motions *m)
{
    cv Q[2 * W][W], r[W];
    lanes t[W];
    factorise(w, 2 * w, Y, t, r);
    for (size_t k = 0; k < w; k++)
        multiply(&m->product, r[k]);
    unitary(w, 2 * w, (const cv(*)[W])Y, t, 0, Q);
    for (size_t i = 0; i < w; i++)
        for (size_t j = 0; j < w; j++) {
            m->U[i][j] = Q[i][j];
            m->V[i][j] = Q[w + i][j];
        }
}

/* The triple u_b = F u_a + G f_b, f_a = F^T f_b - Q u_a of a piece, D = F - I, and beside it a string
   of stiffness k in coordinate z, which a strut needs (element/strut.h): 0 for all others. The pole
   of the strut's own triple is none of the chain's. With f_b = phi + k e_z (u_b - u_a)_z and
   u_a = U y

       M (phi; y) = 0,  M = [F^T + k e_z G_z, k e_z D_z U - V - Q U]

   always has w solutions (N1; N2), columns of the unitary Q in M^* = Q R; then

       U <- F U N2 + G N1,  V <- N1 + k e_z (U_b - U N2)_z,  Delta det F = .. conj(det R)/det Q

   and both are orthonormal once more by another such factorisation. */
static RD_CLONES void cross(const size_t w, const cv *triple, size_t z, const cv *string,
                            struct motions *m)
{
    const cv *D = triple, *G = D + w * w, *Q = G + w * (w + 1) / 2;
    cv A[2 * W][W], N[2 * W][W], Y[2 * W][W], r[W];
    lanes t[W];
    for (size_t i = 0; i < w; i++)
        for (size_t j = 0; j < w; j++) {
            cv f = D[j * w + i], x = m->V[i][j];
            f.re += i == j ? 1.0 : 0.0;
            for (size_t k = 0; k < w; k++)
                x = c_add(x, c_mul(Q[at(w, i, k)], m->U[k][j]));
            if (string && i == z) {
                f = c_add(f, c_mul(*string, G[at(w, z, j)]));
                for (size_t k = 0; k < w; k++)
                    x = c_sub(x, c_mul(*string, c_mul(D[z * w + k], m->U[k][j])));
            }
            A[j][i] = c_conj(f);
            A[w + j][i] = c_neg(c_conj(x));
        }
    factorise(w, 2 * w, A, t, r);
    for (size_t k = 0; k < w; k++)
        multiply(&m->product, c_neg(c_conj(r[k])));
    unitary(w, 2 * w, (const cv(*)[W])A, t, w, N);
    for (size_t j = 0; j < w; j++) {
        cv u[W];
        for (size_t i = 0; i < w; i++) {
            u[i] = c_zero();
            for (size_t k = 0; k < w; k++)
                u[i] = c_add(u[i], c_mul(m->U[i][k], N[w + k][j]));
        }
        for (size_t i = 0; i < w; i++) {
            Y[i][j] = u[i];
            for (size_t k = 0; k < w; k++)
                Y[i][j] = c_add(Y[i][j],
                                c_add(c_mul(D[i * w + k], u[k]), c_mul(G[at(w, i, k)], N[k][j])));
            Y[w + i][j] = N[i][j];
        }
        if (string)
            Y[w + z][j] = c_add(Y[w + z][j], c_mul(*string, c_sub(Y[z][j], u[z])));
    }
    keep(w, Y, m);
}

/* The structure V <- V - (a/e) p p^T U (chain/attached.h), p scaled to 1, which is infinite where e
   is 0. With g = |a| + |e| and the unknown y of V <- V - (a/g) p y

       (U^T p; -e/g)^T (c; y) = 0

   always has w solutions, the columns of (N; n^T) that a reflector leaves of its w + 1; then

       U <- U N,  V <- V N - (a/g) p n^T,  e Delta = .. g alpha

   where (alpha, 0 ..) is what it makes of the row: |det N| is |e/(g alpha)|. */
static RD_CLONES void attach(const size_t w, const struct sweep_foot *foot, const lanes *z,
                             struct motions *m)
{
    cv p[W], row[W + 1], Y[2 * W][W];
    lanes square = {0}, t;
    for (size_t i = 0; i < w; i++) {
        p[i] = c_scale_lanes(foot->lever[i], z[i]);
        square += c_square(p[i]);
    }
    const cv a = c_scale_lanes(foot->weight, square);
    const lanes g = c_size(a) + c_size(foot->gap);
    const lanes unit = 1.0 / l_select(square > 0.0, l_sqrt(square), l_fill(INFINITY));
    for (size_t i = 0; i < w; i++)
        p[i] = c_scale_lanes(p[i], unit);
    for (size_t j = 0; j < w; j++) {
        row[j] = c_zero();
        for (size_t i = 0; i < w; i++)
            row[j] = c_add(row[j], c_conj(c_mul(p[i], m->U[i][j])));
    }
    row[w] = c_conj(c_scale_lanes(foot->gap, -1.0 / g));
    const cv alpha = reflector(row, 1, w + 1, &t), load = c_scale_lanes(a, -1.0 / g);
    for (size_t j = 0; j < w; j++) {
        cv N[W + 1];
        for (size_t i = 0; i <= w; i++)
            N[i] = c_real(i == j + 1);
        reflect(row, 1, t, N, 1, w + 1);
        const cv force = c_mul(load, N[w]);
        for (size_t i = 0; i < w; i++) {
            Y[i][j] = c_zero();
            Y[w + i][j] = c_mul(p[i], force);
            for (size_t k = 0; k < w; k++) {
                Y[i][j] = c_add(Y[i][j], c_mul(m->U[i][k], N[k]));
                Y[w + i][j] = c_add(Y[w + i][j], c_mul(m->V[i][k], N[k]));
            }
        }
    }
    multiply(&m->product, c_scale_lanes(c_conj(alpha), g));
    multiply(&m->product, foot->phase);
    m->product.growth += foot->growth;
    keep(w, Y, m);
}

/* Row e of one of (X, Y) comes to nothing: the limit of Y <- Y + k e e^T X for k -> infinity, divided
   by k. The columns are turned until the first alone has it, which then is (0; e), and no other has
   more of that. */
static RD_CLONES void vanish(size_t w, size_t e, cv (*X)[W], cv (*Y)[W], struct product *product)
{
    cv row[W];
    lanes t;
    for (size_t j = 0; j < w; j++)
        row[j] = c_conj(X[e][j]);
    const cv alpha = reflector(row, 1, w, &t);
    /* x^T H = conj(H conj(x)) */
    for (size_t i = 0; i < w; i++) {
        cv x[W], y[W];
        for (size_t j = 0; j < w; j++) {
            x[j] = c_conj(X[i][j]);
            y[j] = c_conj(Y[i][j]);
        }
        reflect(row, 1, t, x, 1, w);
        reflect(row, 1, t, y, 1, w);
        for (size_t j = 0; j < w; j++) {
            X[i][j] = i == e || j == 0 ? c_zero() : c_conj(x[j]);
            Y[i][j] = i == e ? c_real(j == 0) : j == 0 ? c_zero() : c_conj(y[j]);
        }
    }
    multiply(product, c_conj(alpha));
}

/* --- the chain ------------------------------------------------------------------------------- */

/* structures that a node carries */
static void carry(struct rd_characteristic *c, size_t term)
{
    const struct rd_chain *chain = c->chain;
    struct motions *m = &c->motions;
    const size_t w = chain->width;
    for (size_t k = rd_attached_first(chain, term); rd_attached_is_of(chain, k, (int32_t)term);
         k++) {
        for (size_t part = 0; part < 2; part++) {
            const double *row = chain->attached_row + (2 * k + part) * w;
            for (size_t j = 0; j < w; j++) {
                cv force = c_zero();
                for (size_t i = 0; i < w; i++)
                    force = c_add(force, c_scale_lanes(m->U[i][j], row[i] * c->block.z[i]));
                force = c_mul(c->foot[k].rest[part], force);
                for (size_t i = 0; i < w; i++)
                    m->V[i][j] = c_add(m->V[i][j], c_scale_lanes(force, row[i] * c->block.z[i]));
            }
        }
        attach(w, c->foot + k, c->block.z, m);
    }
}

/* V <- V + N U */
static void load(struct rd_characteristic *c, size_t term)
{
    const struct rd_chain *chain = c->chain;
    const struct sweep_way *way = c->way;
    struct motions *m = &c->motions;
    const size_t w = chain->width, own = term * w * w;
    for (size_t i = 0; i < w; i++)
        for (size_t k = 0; k < w; k++) {
            const size_t p = at(w, i, k), q = own + i * w + k;
            cv N = c_add(c_scale(way->spring[p], chain->stiffness[q]),
                         c_scale(way->inertia[p], chain->mass[q]));
            if (chain->damping)
                N = c_add(N, c_scale(way->dashpot[p], chain->damping[q]));
            for (size_t j = 0; j < w; j++)
                m->V[i][j] = c_add(m->V[i][j], c_mul(N, m->U[k][j]));
        }
}

/* hinges, springs as they are: U <- U + h e e^T V */
static void open(struct rd_characteristic *c, size_t term)
{
    const struct rd_chain *chain = c->chain;
    struct motions *m = &c->motions;
    const size_t w = chain->width;
    const double *hinge = chain->hinge + term * w;
    const cv soft = c_inverse(c->block.spring);
    for (size_t e = 0; e < w; e++) {
        if (isinf(hinge[e])) {
            vanish(w, e, m->V, m->U, &m->product);
            c->power[e] -= 2;
            continue;
        }
        const lanes zz = c->block.z[e] * c->block.z[e];
        const cv h = c_scale_lanes(soft, hinge[e] / zz);
        for (size_t j = 0; j < w; j++)
            m->U[e][j] = c_add(m->U[e][j], c_mul(h, m->V[e][j]));
    }
}

/* what stands at a node that the walk leaves */
static void leave(struct rd_characteristic *c, size_t term)
{
    const size_t w = c->chain->width;
    for (size_t e = 0; e < w; e++)
        if (c->chain->held[term * w + e]) {
            vanish(w, e, c->motions.U, c->motions.V, &c->motions.product);
            c->power[e] += 2;
        }
    load(c, term);
    carry(c, term);
    if (c->chain->hinge)
        open(c, term);
}

static size_t term_at(struct rd_characteristic *c, size_t node)
{
    c->stretch = rd_stretch_of(c->chain, node, c->stretch);
    return (size_t)c->chain->term[c->stretch];
}

static void step(struct rd_characteristic *c, const cv *triple)
{
    cross(c->chain->width, triple, 0, NULL, &c->motions);
    c->steps++;
}

/* a rigid strut: the element without tension, and a string of T/l beside it */
static void cross_strut(struct rd_characteristic *c, size_t e)
{
    const struct rd_chain *chain = c->chain;
    const double untensed = 0.0;
    struct rd_chain one = *chain;
    one.distinct = 1;
    one.length += e;
    one.flexibility += RD_CHANNELS * RD_CHANNELS * e;
    one.tension = &untensed;
    cv triple[PACKED];
    c->kernel->make_element(&one, &c->block, 0, triple);
    const size_t z = rd_coordinate_find(chain->width, chain->coordinate, RD_Z);
    const lanes ratio = c->block.ratio[z];
    const cv string = c_scale(c_scale_lanes(c->block.pull, 1.0 / (ratio * ratio)),
                              chain->tension[e] / chain->length[e]);
    cross(chain->width, triple, z, &string, &c->motions);
    c->steps++;
}

/* node by node */
static void walk(struct rd_characteristic *c, size_t node, size_t end)
{
    cv triple[PACKED];
    int32_t made = -1;
    for (; node < end; node++) {
        leave(c, term_at(c, node));
        const int32_t e = c->chain->element[c->stretch];
        if (sweep_is_strut(c->chain, (size_t)e)) {
            cross_strut(c, (size_t)e);
            continue;
        }
        if (e != made)
            c->kernel->make_element(c->chain, &c->block, (size_t)e, triple);
        made = e;
        step(c, triple);
    }
}

/* an element whose tension grows along it, by the pieces of its blocks */
static enum rd_status cross_graded(struct rd_characteristic *c, const struct rd_run *run)
{
    const struct rd_chain *chain = c->chain;
    const size_t e = (size_t)run->element;
    const struct rd_sizes sizes = rd_sweep_sizes(&c->bound);
    struct rd_block block[RD_BLOCKS_MOST];
    struct rd_family family;
    struct rate_matrix rate;
    const struct rd_field field = {
        .width = chain->width,
        .rate = &rate,
        .tension = chain->tension[e],
        .pull = c->block.pull,
    };
    cv triple[PACKED];
    const size_t blocks = rd_blocks_of(chain, e, &sizes, false, block);
    c->kernel->make_rate(chain, &c->block, e, &rate);
    leave(c, term_at(c, run->first));
    for (size_t k = 0; k < blocks; k++) {
        rd_family_fill(&field, block + k, &family);
        for (size_t i = 0; i < block[k].pieces; i++) {
            rd_family_piece(&family, i, triple);
            step(c, triple);
        }
    }
    return blocks > 0 ? RD_OK : RD_SHORT_WAVES;
}

/* A run by pieces that are joined by doubling: on the way up those that the binary digits of their
   number leave over. */
static enum rd_status cross_run(struct rd_characteristic *c, const struct rd_run *run)
{
    const struct rd_chain *chain = c->chain;
    const size_t count = run->last - run->first, e = (size_t)run->element;
    if (rd_is_graded(chain, e))
        return cross_graded(c, run);
    const struct sweep_pieces all =
        rd_sweep_pieces(chain, run, count, rd_sweep_waves(chain, run, &c->bound));
    if (all.level == 0 && !chain->inertia) {
        walk(c, run->first, run->last);
        return RD_OK;
    }
    if (all.count >> all.level > RD_PIECES_MOST)
        return RD_SHORT_WAVES;
    cv pair[2][PACKED], *one = pair[0], *two = pair[1];
    if (chain->inertia)
        c->kernel->make_slice(chain, &c->block, e, all.halvings, rd_span_terms(all.radians), one);
    else
        c->kernel->make_element(chain, &c->block, e, one);
    leave(c, term_at(c, run->first));
    int begun = 0;
    for (size_t k = 0; k <= all.level; k++) {
        const size_t pieces = k < all.level ? all.count >> k & 1 : all.count >> k;
        for (size_t i = 0; i < pieces; i++) {
            if (begun && run->term != RD_NO_TERM)
                load(c, (size_t)run->term);
            step(c, one);
            begun = 1;
        }
        if (k == all.level)
            break;
        c->kernel->join[0](chain, c->way, run->term, one, one, two);
        cv *swap = one;
        one = two;
        two = swap;
    }
    return RD_OK;
}

/* det of the conditions at the right end: u = 0 where held, else f = 0 */
static void finish(struct rd_characteristic *c)
{
    const size_t w = c->chain->width, term = term_at(c, c->chain->nodes - 1);
    struct motions *m = &c->motions;
    cv A[2 * W][W], r[W];
    lanes t[W];
    load(c, term);
    carry(c, term);
    for (size_t i = 0; i < w; i++) {
        const int held = c->chain->held[term * w + i];
        c->power[i] += held ? 1 : -1;
        for (size_t j = 0; j < w; j++)
            A[i][j] = held ? m->U[i][j] : m->V[i][j];
    }
    factorise(w, w, A, t, r);
    c->value = c_real(1.0);
    for (size_t k = 0; k < w; k++)
        c->value = c_mul(c->value, r[k]);
}

static enum rd_status walk_all(struct rd_characteristic *c)
{
    const size_t w = c->chain->width, last = c->chain->nodes - 1;
    c->motions.product = (struct product){.value = c_real(1.0)};
    c->stretch = 0;
    c->steps = 0;
    for (size_t i = 0; i < w; i++) {
        c->power[i] = -1;
        for (size_t j = 0; j < w; j++) {
            c->motions.U[i][j] = c_real(i == j);
            c->motions.V[i][j] = c_zero();
        }
    }
    size_t node = 0;
    for (size_t r = 0; r < c->runs.count; r++) {
        const struct rd_run *run = c->runs.run + r;
        walk(c, node, run->first);
        const enum rd_status status = cross_run(c, run);
        if (status != RD_OK)
            return status;
        node = run->last;
    }
    walk(c, node, last);
    finish(c);
    return RD_OK;
}

/* value = value phase(product), magnitude = log |product z^power| */
static void answer(const struct rd_characteristic *c, size_t lane, double *value, double *magnitude)
{
    const cv v = c->value, p = c->motions.product.value;
    const double size = hypot(p.re[lane], p.im[lane]);
    double log_size =
        log(size) + c->motions.product.exponent[lane] * log(2.0) + c->motions.product.growth[lane];
    for (size_t i = 0; i < c->chain->width; i++)
        log_size += c->power[i] * log(c->block.z[i][lane]);
    const double re = p.re[lane] / size, im = p.im[lane] / size;
    value[0] = v.re[lane] * re - v.im[lane] * im;
    value[1] = v.re[lane] * im + v.im[lane] * re;
    *magnitude = log_size;
}

struct rd_characteristic *rd_characteristic_take(const struct rd_chain *chain,
                                                 const struct rd_factors *bound,
                                                 struct rd_workspace *workspace)
{
    struct rd_characteristic *c = rd_take_aligned(workspace, 1, sizeof *c, sizeof(lanes));
    struct rd_run *run = rd_take(workspace, rd_runs_capacity(chain), sizeof *run);
    struct sweep_foot *foot =
        rd_take_aligned(workspace, chain->attached, sizeof *foot, sizeof(lanes));
    if (!rd_workspace_fits(workspace))
        return NULL;
    c->chain = chain;
    c->kernel = kernels[chain->width - 1];
    c->bound = rd_sweep_extent(bound, 0);
    c->foot = foot;
    c->steps = 0;
    rd_runs_find(chain, run, &c->runs);
    return c;
}

enum rd_status rd_characteristic_at(struct rd_characteristic *c, const struct rd_factors *factors,
                                    double *value, double *magnitude)
{
    size_t index[RD_LANES];
    struct sweep_extent extent[RD_LANES];
    assert(factors->count > 0 && factors->count <= RD_LANES);
    for (size_t lane = 0; lane < RD_LANES; lane++) {
        index[lane] = lane < factors->count ? lane : factors->count - 1;
        extent[lane] = rd_sweep_extent(factors, index[lane]);
    }
    rd_sweep_scale(c->chain, &c->runs, factors, index, extent, &c->block, c->way);
    rd_sweep_feet(c->chain, &c->block, c->foot);
    const enum rd_status status = walk_all(c);
    for (size_t i = 0; status == RD_OK && i < factors->count; i++)
        answer(c, i, value + 2 * i, magnitude + i);
    return status;
}

size_t rd_characteristic_steps(const struct rd_characteristic *c)
{
    return c->steps;
}
