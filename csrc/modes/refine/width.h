/* Inverse iteration of one width: included once for each RD_WAVE_WIDTH.

   Going right, u = U s + g and f = -i Y s + i g describe the left part (modes/walk/wave.h). Loads:
   p at the node, d between the ends of the piece, u_b = F u_a + G f_b + d. With K = (G + i I)^-1,
   B = K F, Wt = i I + Q + N + F^T B, E = (Wt U - i I)^-1, h = p - B^T d - Wt g:
       s_a = E (B^T s_b + h)
       U <- K G + i B U E B^T,  g <- i B (U E h + g) + i K d

   Structures (chain/attached.h) have an unknown y each and, where e y = v^T u + load, the node
   feels -w v y: with h = v^T U v, x = U v,

       U <- U + x x^T i w/(e - i w h),  g <- g + x i w (load + v^T g)/(e - i w h)
       y = (load + v^T (U s + g))/(e - i w h) with the old U, g and the new s;  s_old = s + i w v y */
#include "modes/walk/width.h"

#include "modes/refine/end.h"
#include "modes/refine/foot.h"
#include "modes/refine/quotient.h"
#include "modes/refine/shape.h"
#include "modes/walk/graded.h"

#include <math.h>
#include <string.h>

/* the lambda that pieces were planned for */
RD_INLINE lanes planned(const struct rd_refine *r)
{
    return l_fill(r->most);
}

RD_INLINE const uint8_t *held_at(const struct rd_refine *r, int32_t term)
{
    return rd_walk_held(r->walk, term);
}

/* the two pieces of a plain leg with their d/dlambda */
RD_INLINE void plain_change(const struct rd_refine *r, const struct rd_leg *leg, lanes lambda,
                            struct piece *level)
{
    const struct rd_chain *chain = r->walk->chain;
    struct rate_matrix rate;
    lanes first, other;
    plain_rate(r->walk, leg, lambda, &rate);
    plain_lengths(&rate, (double)leg->count * chain->length[leg->element], &first, &other);
    plain_load(&rate, first, level, level + 1);
    plain_load(&rate, other, level + 2, level + 3);
}

/* the pieces of a leg whose tension grows, from step m on, as its plan has them; returns the last */
static size_t graded_change(const struct rd_refine *r, size_t m, const lanes *lambda)
{
    const struct rd_leg *leg = r->walk->leg + r->step[m].leg;
    struct rd_block block[RD_BLOCKS_MOST];
    struct rd_family family;
    const lanes at = planned(r);
    int32_t made = 0;
    graded_blocks(r->walk, leg, &at, block);
    for (; m < r->steps && r->step[m].leg == (int32_t)(leg - r->walk->leg); m++) {
        const struct rd_step *step = r->step + m;
        struct piece *piece = (struct piece *)(r->piece + (size_t)step->piece * 6 * W * W);
        if (step->block != made)
            graded_fill(r->walk, leg, lambda, block + step->block - 1, &family);
        made = step->block;
        graded_load(&family, step->at, piece, piece + 1);
    }
    return m - 1;
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
        if (step->block > 0) {
            m = graded_change(r, m, &lambda);
            done = r->step[m].piece;
            continue;
        }
        done = step->piece;
        const struct rd_leg *leg = r->walk->leg + step->leg;
        if (step->plain) {
            plain_change(r, leg, lambda, (struct piece *)(r->piece + (size_t)done * 6 * W * W));
            done++;
            continue;
        }
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
            p[i] = l_select(lanes_of(begin), fixed_load(r->block, n, i), p[i]);
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

void WIDTH(iterate)(struct rd_refine *r, const double *lambdas, unsigned begin)
{
    iterate_lanes(r, lambdas, begin);
}

static _Bool are_equal(const struct rd_leg *a, const struct rd_leg *b)
{
    return a->element == b->element && a->count == b->count && a->term == b->term;
}

/* Steps of a plain leg: a long piece and two short ones. */
static enum rd_status plan_plain(struct rd_refine *r, int32_t index, int32_t *pieces)
{
    const struct rd_leg *leg = r->walk->leg + index;
    const struct rd_step *last = r->steps > 0 ? r->step + r->steps - 1 : NULL;
    const _Bool shared = last && last->piece >= 0 && index > 0 && are_equal(leg - 1, leg);
    const int32_t base = shared ? last->piece - 1 : *pieces;
    if ((size_t)base + 2 > r->pieces || r->steps + PLAIN_STEPS > r->capacity)
        return RD_NO_MEMORY;
    for (int k = 0; k < PLAIN_STEPS; k++)
        r->step[r->steps++] = (struct rd_step){
            .at = (size_t)k,
            .piece = base + (k > 0),
            .element = leg->element,
            .term = k == 0 ? leg->first : leg->term,
            .before = k == 0 ? leg->before : leg->element,
            .leg = index,
            .plain = 1,
        };
    *pieces = base + 2;
    return RD_OK;
}

/* Steps of a leg whose tension grows: the pieces of its blocks. */
static enum rd_status plan_graded(struct rd_refine *r, int32_t index, const lanes *lambda,
                                  int32_t *pieces)
{
    const struct rd_leg *leg = r->walk->leg + index;
    struct rd_block block[RD_BLOCKS_MOST];
    const size_t blocks = graded_blocks(r->walk, leg, lambda, block);
    for (size_t k = 0; k < blocks; k++)
        for (size_t i = 0; i < block[k].pieces; i++) {
            const _Bool start = k == 0 && i == 0;
            if ((size_t)*pieces == r->pieces || r->steps == r->capacity)
                return RD_NO_MEMORY;
            r->step[r->steps++] = (struct rd_step){
                .at = i,
                .piece = (*pieces)++,
                .element = leg->element,
                .term = start ? leg->first : leg->term,
                .before = start ? leg->before : leg->element,
                .leg = index,
                .block = (int32_t)k + 1,
            };
        }
    return blocks > 0 ? RD_OK : RD_SHORT_WAVES;
}

/* Steps of a leg: single elements where it is short, pieces of 2^k otherwise. Equal spans side by
   side share their pieces. */
static enum rd_status plan_leg(struct rd_refine *r, int32_t index, lanes lambda, int32_t *pieces)
{
    const struct rd_leg *leg = r->walk->leg + index;
    if (leg_is_plain_at(r->walk, leg, lambda))
        return plan_plain(r, index, pieces);
    if (leg_is_graded(r->walk, leg))
        return plan_graded(r, index, &lambda, pieces);
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
    r->most = most;
    r->steps = 0;
    enum rd_status status = RD_OK;
    for (size_t i = 0; i < r->walk->legs && status == RD_OK; i++)
        status = plan_leg(r, (int32_t)i, lambda, &pieces);
    return status;
}
