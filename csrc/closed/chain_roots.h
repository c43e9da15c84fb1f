/* Roots, certificates and counts of chains of one kind. What includes this has, beside
   what closed/chain_walk.h asks for,

       chain_splits, chain_valid, chain_guess   of the numbers of a row
       chain_fill       puts what follows from them into a lane

   Places of (rope, mode) fill the lanes; one that is done makes room for the next. */
#ifndef RD_CHAIN_ROOTS_H
#define RD_CHAIN_ROOTS_H

#include "closed/chain_walk.h"

enum {
    BLOCK = 64,       /* rows that wait for each other, at most */
    PLACES = 8192,    /* in a block, or those of one row */
    LIGHT_STEPS = 14, /* with the right end as the place to meet */
    WIDE_STEPS = 80,
};

/* a step of so much between two points of a bracket leaves less than NEAR, and that Newton's squares */
static const double SOON = 3e-7;

/* of mode n of a section of a row */
struct chain_task {
    size_t row, first, last, n;
    _Bool wide;
};

struct chain_block {
    struct chain_task *task; /* (places) */
    double *omega;           /* (places) 0 where it was not found */
    struct chain_task *mode; /* (rows x number) */
    double *root;            /* (rows x number) */
};

static size_t block_rows(size_t spans, size_t number)
{
    const size_t rows = PLACES / (spans * number);
    return rows < 1 ? 1 : rows < BLOCK ? rows : BLOCK;
}

static void lay(struct rd_workspace *work, size_t spans, size_t numbers, size_t number,
                struct chain_lanes *chain, struct chain_block *block)
{
    const size_t wide = sizeof(lanes), rows = block_rows(spans, number);
    chain->number = rd_take_aligned(work, numbers, wide, wide);
    chain->slope = rd_take_aligned(work, numbers, wide, wide);
    chain->load = rd_take_aligned(work, spans, wide, wide);
    chain->pull = rd_take_aligned(work, spans, wide, wide);
    chain->wave = rd_take_aligned(work, spans, sizeof *chain->wave, wide);
    chain->left = rd_take_aligned(work, spans + 1, sizeof *chain->left, wide);
    for (int side = 0; side < 2; side++) {
        chain->station[side] = rd_take_aligned(work, spans + 1, sizeof **chain->station, wide);
        chain->Y[side] = rd_take_aligned(work, spans, sizeof **chain->Y, wide);
        chain->near[side] = rd_take_aligned(work, spans, wide, wide);
        chain->in[side] = rd_take_aligned(work, spans, sizeof **chain->in, wide);
    }
    block->task = rd_take(work, rows * spans, number * sizeof *block->task);
    block->omega = rd_take(work, rows * spans, number * sizeof *block->omega);
    block->mode = rd_take(work, rows, number * sizeof *block->mode);
    block->root = rd_take(work, rows, number * sizeof *block->root);
}

static void put_task(const struct rd_chains *chains, struct chain_lanes *chain,
                     struct chain_place *place, size_t i, const struct chain_task *task)
{
    const double *number = chains->number + task->row * chain->numbers;
    for (size_t j = 0; j < chain->numbers; j++)
        chain->number[j][i] = number[j];
    chain_fill(chain, i, number);
    chain->first[i] = (long long)task->first;
    chain->last[i] = (long long)task->last;
    chain->split |= task->first > 0 || task->last < chain->spans;
    place->odd[i] = task->n % 2 ? -1 : 0;
    place->turns[i] = (double)((task->n - 1) / 2);
    place->wide[i] = task->wide ? -1 : 0;
}

/* a root between low and high, where the phase is below 0 and above */
struct bracket {
    lanes low, high, below, above, x;
    lane_mask rising;  /* the last step moved low */
    lanes steps, turn; /* since the bracket was halved */
};

RD_INLINE void narrow(struct bracket *b, lanes beyond, lanes pace)
{
    const lane_mask up = beyond < 0.0, open = b->high == (double)INFINITY, begun = b->low > 0.0;
    const lane_mask again = (up & b->rising) | (~up & ~b->rising);
    /* Anderson and Bjorck: what stays is weighed by how much nearer the other came */
    const lanes part = 1.0 - beyond / l_select(up, b->below, b->above);
    const lanes weight =
        l_select(again & ~open & begun, l_select(part > 0.0, part, l_fill(0.5)), l_fill(1));
    b->above = l_select(up, b->above * weight, beyond);
    b->below = l_select(up, beyond, b->below * weight);
    b->low = l_select(up, b->x, b->low);
    b->high = l_select(up, b->high, b->x);
    b->rising = up;
    /* outside: as kl asks, and ever further; inside: between, or halves where that is slow */
    const lanes size = (l_abs(beyond) / pace + 0.01) * (1.0 + b->steps);
    const lanes far = 1.0 + l_least(size, l_fill(3));
    const lanes outside = l_select(up, b->x * far, b->x / far);
    const lanes width = b->high - b->low, share = b->below / (b->below - b->above);
    const lane_mask slow = (l_abs(beyond) > 0.05) & (b->turn >= 3.0);
    b->turn = l_select(slow, l_fill(0), b->turn + 1.0);
    const lanes inside = b->low + width * l_select(slow, l_fill(0.5), share);
    const lane_mask bracketed = (b->high < (double)INFINITY) & (b->low > 0.0);
    b->steps += 1.0;
    b->x = l_select(bracketed, inside, outside);
}

static size_t next_place(const struct chain_task *task, size_t at, size_t count, _Bool wide)
{
    while (at < count && task[at].wide != wide)
        at++;
    return at;
}

/* omega of places, of those that are wide or of the others; 0 where it was not found */
RD_CLONES static void seek(const struct rd_chains *chains, struct chain_lanes *chain,
                           const struct chain_task *task, size_t count, _Bool wide, double *omega)
{
    const double steps = wide ? WIDE_STEPS : LIGHT_STEPS;
    struct chain_place place = {0};
    struct bracket b = {0};
    const size_t least = next_place(task, 0, count, wide);
    size_t next = least, at[RD_LANES];
    lane_mask busy = {0};
    chain->split = 0;
    if (least == count)
        return;
    for (size_t i = 0; i < RD_LANES; i++)
        at[i] = count;
    for (;;) {
        for (size_t i = 0; i < RD_LANES; i++) {
            if (busy[i] || (next == count && at[i] < count))
                continue;
            const size_t t = next < count ? next : least;
            at[i] = t;
            put_task(chains, chain, &place, i, task + t);
            b.x[i] = chain_guess(chains, chains->number + task[t].row * chain->numbers,
                                 task[t].first, task[t].last, (double)task[t].n);
            b.low[i] = b.steps[i] = b.turn[i] = 0;
            b.high[i] = INFINITY;
            busy[i] = next < count ? -1 : 0;
            next = next_place(task, next < count ? next + 1 : count, count, wide);
        }
        if (!any(busy))
            return;
        lanes pace, beyond;
        const lanes x = b.x;
        chain_phase(chain, &x, &place, &beyond, &pace);
        narrow(&b, beyond, pace);
        const lane_mask near = (l_abs(beyond) < SOON) & (l_abs(b.x - x) < SOON * x);
        const lane_mask lost =
            (b.steps >= steps) | (b.high - b.low < 4e-16 * b.high) | ~(x > 0.0) | ~finite(beyond);
        for (size_t i = 0; i < RD_LANES; i++)
            if (busy[i] && (near[i] || lost[i])) {
                omega[at[i]] = near[i] ? b.x[i] : 0;
                busy[i] = 0;
            }
    }
}

/* The phase below and above: does it pass 0. Where the parts may meet anywhere it is the least of all
   faces, each with noise that is as much smaller. */
RD_INLINE lane_mask chain_passes(struct chain_lanes *chain, const struct chain_place *place,
                                 lanes omega, lanes wide, lanes noise)
{
    lane_mask passes = ~(lane_mask){0};
    for (int side = -1; side < 2; side += 2) {
        const lanes at = omega * (1.0 + side * wide);
        lanes beyond, pace;
        chain_phase(chain, &at, place, &beyond, &pace);
        passes &= side * beyond > l_select(place->wide, l_fill(0), noise);
    }
    return passes;
}

/* the last step to the modes of rows, their slopes and certificates */
RD_CLONES static void settle(const struct rd_chains *chains, struct chain_lanes *chain,
                             const struct chain_task *task, const double *root, size_t count,
                             size_t row, const struct rd_closed_modes *modes)
{
    for (size_t t = 0; t < count; t += RD_LANES) {
        struct chain_place place = {0};
        lanes x = l_fill(0);
        chain->split = 0;
        for (size_t i = 0; i < RD_LANES; i++) {
            const size_t own = t + i < count ? t + i : t;
            put_task(chains, chain, &place, i, task + own);
            x[i] = root[own];
        }
        struct chain_slope f;
        chain_slopes(chain, &x, &place, &f);
        const lanes step = f.beyond / f.of_omega, omega = x * (1.0 - step);
        const lanes noise = ROUNDING * f.noise;
        const lanes left = f.beyond * f.beyond / f.of_omega + 8.0 * step * step;
        const lanes error = noise / f.of_omega + left + 4.0 * ROUNDING;
        const lanes wide = l_most(l_fill(2e-13), 4.0 * error);
        const lane_mask found = (x > 0.0) & (f.of_omega > 0.0) & (error < CERTAIN) &
                                (f.split > 1e-6) & chain_passes(chain, &place, omega, wide, noise);
        for (size_t i = 0; i < RD_LANES && t + i < count; i++) {
            const size_t mode = row * modes->number + t + i;
            modes->omega[mode] = omega[i];
            modes->error[mode] = error[i];
            if (!found[i])
                modes->certified[mode / modes->number] = 0;
            for (size_t c = 0; modes->slope && c < chains->columns; c++) {
                double sum = 0;
                for (size_t j = 0; j < chain->numbers; j++) {
                    const double by = chains->jacobian[j * chains->columns + c];
                    if (by != 0)
                        sum -= by * chain->slope[j][i];
                }
                modes->slope[mode * chains->columns + c] = sum / f.of_omega[i];
            }
        }
    }
}

/* the sections of a row with `number` modes each; how many places that are */
static size_t list_sections(const struct rd_chains *chains, size_t numbers, size_t row,
                            size_t number, struct chain_task *task)
{
    size_t count = 0, first = 0;
    for (size_t s = 1; s <= chains->spans; s++) {
        if (s < chains->spans && !chain_splits(chains, chains->number + row * numbers, s))
            continue;
        for (size_t n = 1; n <= number; n++)
            task[count++] = (struct chain_task){row, first, s, n, 0};
        first = s;
    }
    return count;
}

/* the lowest of the sections of a row, which are sorted each; 0 if some was not found */
static _Bool lowest(const struct chain_task *task, const double *omega, size_t count, size_t number,
                    struct chain_task *mode, double *root)
{
    _Bool found = 1;
    for (size_t t = 0; t < count; t++)
        found &= omega[t] > 0;
    for (size_t k = 0; k < number; k++) {
        /* the next one of each section is where all before it were taken */
        size_t best = count;
        for (size_t start = 0; start < count; start += number) {
            size_t t = start;
            for (size_t j = 0; j < k; j++)
                t += mode[j].first == task[start].first;
            if (best == count || omega[t] < omega[best])
                best = t;
        }
        mode[k] = task[best];
        root[k] = omega[best];
    }
    return found;
}

static void chain_modes(const struct rd_chains *chains, size_t numbers, size_t first, size_t last,
                        const struct rd_closed_modes *modes, struct rd_workspace work)
{
    struct chain_lanes chain = {.spans = chains->spans, .numbers = numbers, .hinge = chains->hinge};
    struct chain_block block;
    const size_t number = modes->number, rows = block_rows(chains->spans, number);
    work.used = 0;
    lay(&work, chains->spans, numbers, number, &chain, &block);
    for (; first < last; first += rows) {
        const size_t stop = last - first < rows ? last : first + rows;
        size_t count = 0;
        for (size_t row = first; row < stop; row++)
            count += list_sections(chains, numbers, row, number, block.task + count);
        seek(chains, &chain, block.task, count, 0, block.omega);
        for (size_t t = 0; t < count; t++)
            block.task[t].wide = !(block.omega[t] > 0);
        seek(chains, &chain, block.task, count, 1, block.omega);
        size_t t = 0;
        for (size_t row = first; row < stop; row++) {
            size_t own = 0;
            while (t + own < count && block.task[t + own].row == row)
                own++;
            const size_t at = (row - first) * number;
            const _Bool found = lowest(block.task + t, block.omega + t, own, number,
                                       block.mode + at, block.root + at);
            modes->certified[row] = found && chain_valid(chains, chains->number + row * numbers);
            t += own;
        }
        settle(chains, &chain, block.mode, block.root, (stop - first) * number, first, modes);
    }
}

/* eigenvalues of sections below omega, of odd index or even; -1 where that is not certain */
RD_CLONES static void count_places(const struct rd_chains *chains, struct chain_lanes *chain,
                                   const struct chain_task *task, size_t count, double omega,
                                   int64_t *each)
{
    for (size_t t = 0; t < count; t += RD_LANES) {
        struct chain_place place = {0};
        chain->split = 0;
        for (size_t i = 0; i < RD_LANES; i++)
            put_task(chains, chain, &place, i, task + (t + i < count ? t + i : t));
        const double turn = 2 * PI, off = 2e-13;
        lane_mask certain = ~(lane_mask){0};
        const lanes here = l_fill(omega);
        struct chain_slope f;
        chain_slopes(chain, &here, &place, &f);
        const lanes slack = f.noise + l_abs(f.of_omega);
        const lanes below = whole_turns(f.beyond / turn + 1.0, slack, &certain);
        for (int side = -1; side < 2; side += 2) {
            const lanes at = l_fill(omega * (1 + side * off));
            lanes beyond, pace;
            chain_phase(chain, &at, &place, &beyond, &pace);
            certain &= whole_turns(beyond / turn + 1.0, l_fill(4), &certain) == below;
        }
        for (size_t i = 0; i < RD_LANES && t + i < count; i++)
            each[t + i] = certain[i] ? (int64_t)below[i] : -1;
    }
}

static void chain_count(const struct rd_chains *chains, size_t numbers, size_t first, size_t last,
                        double omega, int64_t *count, struct rd_workspace work)
{
    struct chain_lanes chain = {.spans = chains->spans, .numbers = numbers, .hinge = chains->hinge};
    struct chain_block block;
    const size_t rows = block_rows(chains->spans, 2);
    work.used = 0;
    lay(&work, chains->spans, numbers, 2, &chain, &block);
    for (; first < last; first += rows) {
        const size_t stop = last - first < rows ? last : first + rows;
        int64_t *each = (int64_t *)block.omega;
        size_t places = 0;
        for (size_t row = first; row < stop; row++)
            places += list_sections(chains, numbers, row, 2, block.task + places);
        count_places(chains, &chain, block.task, places, omega, each);
        for (size_t row = first; row < stop; row++)
            count[row] = chain_valid(chains, chains->number + row * numbers) && omega > 0 ? 0 : -1;
        for (size_t t = 0; t < places; t++) {
            int64_t *sum = count + block.task[t].row;
            *sum = *sum < 0 || each[t] < 0 ? -1 : *sum + each[t];
        }
    }
}

#endif
