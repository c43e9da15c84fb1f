/* The count of one width: included once for each RD_WAVE_WIDTH. */
#include "modes/walk/width.h"

#include "modes/count/count.h"
#include "modes/count/whole.h"
#include "modes/walk/graded.h"
#include "modes/walk/piece.h"
#include "modes/walk/wave.h"

/* a piece in scaled coordinates, G = V diag(g) V^T with V unit lower triangular */
struct step {
    lanes D[W][W], Q[W][W], v[W][W], g[W];
    _Bool tilts; /* D is not zero */
};

RD_INLINE void step_fill(const struct piece *piece, _Bool doubled, const lanes *z,
                         const lanes *inverse, struct step *step)
{
    lanes L[W][W];
    step->tilts = doubled;
    for (int i = 0; i < W; i++)
        for (int j = 0; j < W; j++) {
            step->D[i][j] = piece->D[i][j] * (z[j] * inverse[i]);
            step->Q[i][j] = piece->Q[i][j] * (z[i] * z[j]);
            step->tilts |= piece->D[i][j][0] != 0;
        }
    for (int j = 0; j < W; j++) {
        for (int i = j; i < W; i++) {
            L[i][j] = piece->G[i][j] * (inverse[i] * inverse[j]);
            for (int k = 0; k < j; k++)
                L[i][j] -= L[i][k] * step->v[k][j];
        }
        step->g[j] = L[j][j];
        /* v of column j: (0 .. 1 .. L_ij/g_j), row j of the transposed factor */
        for (int i = 0; i < W; i++)
            step->v[j][i] = i < j    ? l_fill(0)
                            : i == j ? l_fill(1)
                                     : l_select(L[j][j] == 0.0, l_fill(0), L[i][j] / L[j][j]);
    }
}

/* N and Q of a node as springs: the diagonal, and V_ij on u_i + u_j */
RD_INLINE void node(struct wave *wave, const lanes V[W][W])
{
    _Bool coupled = 0;
    for (int i = 0; i < W; i++)
        for (int j = 0; j < i; j++)
            coupled |= !every(V[i][j] == 0.0);
    for (int i = 0; i < W; i++) {
        lanes q = V[i][i];
        for (int j = 0; coupled && j < W; j++)
            q -= i == j ? l_fill(0) : V[i][j];
        add_spring(wave, i, q);
    }
    for (int i = 0; coupled && i < W; i++)
        for (int j = 0; j < i; j++)
            add_pair(wave, i, j, V[i][j]);
}

/* Of a rope that hangs nothing follows x: F is first a shear of x, which turns by less than pi, and
   then what leaves x alone. */
RD_INLINE void hanging_transfer(struct wave *wave, const struct step *step, const _Bool *bends)
{
    lanes shear[W][W], rest[W][W];
    for (int i = 0; i < W; i++)
        for (int j = 0; j < W; j++) {
            shear[i][j] = i == 0 ? step->D[i][j] : l_fill(0);
            rest[i][j] = i == 0 ? l_fill(0) : step->D[i][j];
        }
    transfer(wave, shear);
    transfer_in_parts(wave, rest, bends);
}

RD_INLINE void step_transfer(struct wave *wave, const struct step *step,
                             const struct rd_chain *chain)
{
    _Bool bends[W];
    for (int i = 0; i < W; i++)
        bends[i] = rd_channel_of(chain->coordinate[i]) == RD_BENDING;
    if (step->tilts && W > 2 && chain->sag != NULL)
        hanging_transfer(wave, step, bends);
    else if (step->tilts && W > 2)
        transfer_in_parts(wave, step->D, bends);
    else if (step->tilts)
        transfer(wave, step->D);
}

/* F = T^-1 f T of a strut (element/strut.h) in these factors: f moves z and beta alone,
   T: u_i - r_i beta */
RD_INLINE void strut_transfer(struct wave *wave, const struct rd_chain *chain, int32_t element,
                              const struct step *step, const lanes *z, const lanes *inverse)
{
    const double *S = chain->flexibility + (size_t)element * RD_CHANNELS * RD_CHANNELS;
    lanes shear[W][W], back[W][W], f[W][W];
    for (int i = 0; i < W; i++) {
        const int channel = rd_channel_of(chain->coordinate[i]);
        const _Bool bends = channel == RD_BENDING;
        const double r = S[channel * RD_CHANNELS + RD_BENDING] / S[RD_CHANNELS * RD_CHANNELS - 1];
        for (int j = 0; j < W; j++) {
            back[i][j] = bends || j < W - 1 ? l_fill(0) : r * z[j] * inverse[i];
            shear[i][j] = -back[i][j];
            f[i][j] = bends ? step->D[i][j] : l_fill(0);
        }
    }
    transfer(wave, shear);
    transfer(wave, f);
    transfer(wave, back);
}

RD_INLINE void step_comply(struct wave *wave, const struct step *step)
{
    for (int i = 0; i < W; i++)
        add_compliance(wave, step->v[i], step->g[i]);
    normalise(wave);
}

/* node term of a node, scaled; held coordinates are held before */
RD_INLINE void term_scale(const struct rd_walk *walk, int32_t term, int32_t before, lanes lambda,
                          const lanes *z, lanes N[W][W])
{
    term_load(walk, term, before, lambda, N);
    for (int i = 0; i < W; i++)
        for (int j = 0; j < W; j++)
            N[i][j] *= z[i] * z[j];
}

RD_INLINE void walk_node(struct wave *wave, const struct rd_walk *walk, int32_t term,
                         const lanes N[W][W], const struct step *step, _Bool first)
{
    const uint8_t *held = rd_walk_held(walk, term);
    lanes V[W][W];
    for (int i = 0; i < W; i++) {
        if (!first && held[i])
            hold(wave, i);
        for (int j = 0; j < W; j++)
            V[i][j] = N[i][j] + step->Q[i][j];
    }
    node(wave, V);
}

/* The structures that a node carries: their poles, and how many eigenvalues they have with their
   feet held (Wittrick, Williams 1971), of which the infinite springs at the poles have taken one
   each. */
RD_INLINE void walk_feet(struct wave *wave, const struct rd_walk *walk, int32_t term, lanes lambda,
                         const lanes *z, lanes *held)
{
    const struct rd_chain *chain = walk->chain;
    if (chain->attached == 0 || term == RD_NO_TERM)
        return;
    for (size_t k = rd_attached_first(chain, (size_t)term); rd_attached_is_of(chain, k, term);
         k++) {
        struct foot foot;
        int own = -1;
        foot_load(chain, k, lambda, &foot);
        foot_scale(&foot, z);
        for (int i = 0; i < W; i++)
            if (!every(foot.v[i] == 0.0))
                own = own == -1 ? i : -2;
        add_pole(wave, foot.v, own, foot.w, foot.e);
        *held += foot.held;
    }
}

/* a plain span at once; false where it has to be walked by pieces, the wave as it was */
RD_INLINE _Bool leg_walk_whole(struct wave *wave, const struct rd_walk *walk,
                               const struct rd_leg *leg, lanes lambda, const lanes *z, lanes *own)
{
    const struct wave before = *wave;
    const lanes own_before = *own;
    const struct step bare = {.tilts = 0};
    lanes first[W][W];
    if (!is_whole(walk, leg))
        return 0;
    term_scale(walk, leg->first, leg->before, lambda, z, first);
    walk_node(wave, walk, leg->first, first, &bare, leg == walk->leg);
    walk_feet(wave, walk, leg->first, lambda, z, own);
    if (whole_walk(wave, walk, leg, lambda, z))
        return 1;
    *wave = before;
    *own = own_before;
    return 0;
}

/* the same of a leg whose tension grows, by pieces of its blocks */
static RD_CLONES _Bool leg_walk_graded(struct wave *wave, const struct rd_walk *walk,
                                       const struct rd_leg *leg, const lanes *lambda,
                                       const lanes *z, const lanes *inverse, lanes *own)
{
    struct rd_block block[RD_BLOCKS_MOST];
    struct rd_family family;
    struct piece piece;
    struct step step;
    lanes first[W][W], inner[W][W];
    const size_t blocks = graded_blocks(walk, leg, lambda, block);
    term_scale(walk, leg->first, leg->before, *lambda, z, first);
    term_scale(walk, leg->term, leg->element, *lambda, z, inner);
    for (size_t k = 0; k < blocks; k++) {
        graded_fill(walk, leg, lambda, block + k, &family);
        for (size_t i = 0; i < block[k].pieces; i++) {
            const _Bool start = k == 0 && i == 0;
            graded_load(&family, i, &piece, NULL);
            step_fill(&piece, 1, z, inverse, &step);
            walk_node(wave, walk, start ? leg->first : leg->term, start ? first : inner, &step,
                      start && leg == walk->leg);
            if (start)
                walk_feet(wave, walk, leg->first, *lambda, z, own);
            step_transfer(wave, &step, walk->chain);
            step_comply(wave, &step);
        }
    }
    return blocks > 0;
}

/* A leg of equal elements, by pieces of 2^k of them, the largest first; false where they are too
   many. own: eigenvalues of structures with their feet held, added. */
RD_INLINE _Bool leg_walk(struct wave *wave, const struct rd_walk *walk, const struct rd_leg *leg,
                         lanes lambda, const lanes *z, const lanes *inverse, lanes *own)
{
    struct piece level[LEVELS];
    struct step step;
    lanes first[W][W], inner[W][W];
    const int halvings = leg_halvings(walk, leg, lambda);
    const int top = pieces_fill(walk, leg, halvings, lambda, level);
    if (is_endless(walk, leg, halvings, top))
        return 0;
    term_scale(walk, leg->first, leg->before, lambda, z, first);
    term_scale(walk, leg->term, leg->element, lambda, z, inner);
    const size_t all = leg->count << halvings;
    size_t left = all;
    for (int k = top; k >= 0; k--) {
        if (left >> k == 0)
            continue;
        step_fill(level + k, k > 0 || leg_is_continuous(walk, leg), z, inverse, &step);
        for (; left >> k > 0; left -= (size_t)1 << k) {
            const _Bool start = left == all;
            walk_node(wave, walk, start ? leg->first : leg->term, start ? first : inner, &step,
                      start && leg == walk->leg);
            if (start)
                walk_feet(wave, walk, leg->first, lambda, z, own);
            if (W > 2 && walk->strut[leg->element] && (size_t)leg->element < walk->chain->distinct)
                strut_transfer(wave, walk->chain, leg->element, &step, z, inverse);
            else
                step_transfer(wave, &step, walk->chain);
            step_comply(wave, &step);
        }
    }
    return 1;
}

RD_INLINE _Bool leg_cross(struct wave *wave, const struct rd_walk *walk, const struct rd_leg *leg,
                          lanes lambda, const lanes *z, const lanes *inverse, lanes *own)
{
    if (leg_is_graded(walk, leg))
        return leg_walk_graded(wave, walk, leg, &lambda, z, inverse, own);
    return leg_walk_whole(wave, walk, leg, lambda, z, own) ||
           leg_walk(wave, walk, leg, lambda, z, inverse, own);
}

/* left end: U = 0 where held; U = 1 and the angle -pi/2 where free */
RD_INLINE void start(struct wave *wave, const struct rd_walk *walk)
{
    const uint8_t *held = rd_walk_held(walk, walk->leg[0].first);
    wave->e = c_make(l_fill(1), l_fill(0));
    wave->turns = l_fill(0);
    for (int i = 0; i < W; i++) {
        for (int j = 0; j < W; j++)
            wave->U[i][j] = wave->Y[i][j] = c_make(l_fill(0), l_fill(0));
        if (held[i])
            wave->Y[i][i].re += 1;
        else
            wave->U[i][i].re += 1;
        if (!held[i])
            wave->e = c_make(wave->e.im, -wave->e.re);
    }
    /* -pi/2 a coordinate; -pi and beyond is a turn less */
    wave->e.im += 0;
    int free = 0;
    for (int i = 0; i < W; i++)
        free += !held[i];
    wave->turns -= free >= 2 ? 1 : 0;
}

/* before every so many legs; a leg of equal elements is short work however long it is */
static _Bool is_asked_to_stop(const struct rd_walk *walk, size_t leg)
{
    enum { LEGS = 1 << 12 };
    return leg % LEGS == 0 && rd_stop_is_asked(&walk->stop);
}

static RD_CLONES void count_lanes(const struct rd_walk *walk, const double *lambdas, double *counts)
{
    lanes lambda, z[W], inverse[W], N[W][W], own = l_fill(0);
    for (int k = 0; k < RD_LANES; k++) {
        double scale[RD_WIDTH_MAX];
        lambda[k] = lambdas[k];
        rd_walk_scale(walk, lambdas[k], scale);
        for (int i = 0; i < W; i++)
            z[i][k] = scale[i];
    }
    for (int i = 0; i < W; i++)
        inverse[i] = 1 / z[i];
    struct wave wave;
    start(&wave, walk);
    for (size_t r = 0; r < walk->legs; r++)
        if (is_asked_to_stop(walk, r) ||
            !leg_cross(&wave, walk, walk->leg + r, lambda, z, inverse, &own)) {
            for (int k = 0; k < RD_LANES; k++)
                counts[k] = NAN;
            return;
        }

    term_scale(walk, walk->last, walk->behind, lambda, z, N);
    for (int i = 0; i < W; i++)
        if (rd_walk_held(walk, walk->last)[i])
            hold(&wave, i);
    node(&wave, N);
    walk_feet(&wave, walk, walk->last, lambda, z, &own);
    for (int i = 0; i < W; i++)
        release(&wave, i);
    for (int k = 0; k < RD_LANES; k++) {
        const double pi = 3.14159265358979323846;
        const double angle = atan2(wave.e.im[k] + 0, wave.e.re[k]) / pi;
        counts[k] = round(-angle - 2 * wave.turns[k]) + own[k];
    }
}

void WIDTH(count)(const struct rd_walk *walk, const double *lambdas, double *counts)
{
    count_lanes(walk, lambdas, counts);
}
