/* Simultaneous approximation of all roots within a circle, by Ehrlich's and Aberth's steps: with
   Newton's w = f/f' and all others repelling,

       z <- z - w/(1 - w sum 1/(z - z_j)),

   of third order for single roots; no two find the same. Of two that are mirror images one alone is
   asked for, until they meet: then they are two roots of their own. */
#include "damped/iterate.h"

#include "damped/powers.h"

#include <math.h>

static const double PI = 3.14159265358979323846;

enum {
    MOST_STEPS = 30,
    MOST_TRIES = 6,   /* where roots are missing the iteration begins anew so often at most */
    MOST_MOMENTS = 6, /* so many missing roots at most have their places guessed from moments */
};

/* A step of this part of the mean distance of roots, or of that of the distance to the next one, is
   the last: what is left is of the order of its square. */
static const double CLOSE = 1e-7, NEXT = 1e-3;

/* in mean distances of roots: what slopes are differences over, how near mirror images meet, and two
   numbers that may be one root */
static const double SLOPE = 1e-7, MEET = 0.05, SAME = 1e-6;

static const double GOLDEN =
    0.6180339887498949; /* its multiples, less whole turns, spread evenly */

bool rd_iterate_take(size_t roots, struct rd_workspace *workspace, struct rd_iterate *it)
{
    const size_t most = 2 * MOST_TRIES * roots;
    *it = (struct rd_iterate){
        .most = most,
        .z = rd_take(workspace, most, sizeof *it->z),
        .next = rd_take(workspace, most, sizeof *it->next),
        .at = rd_take(workspace, 2 * most, sizeof *it->at),
        .value = rd_take(workspace, 2 * most, sizeof *it->value),
        .magnitude = rd_take(workspace, 2 * most, sizeof *it->magnitude),
        .active = rd_take(workspace, most, sizeof *it->active),
        .twin = rd_take(workspace, most, sizeof *it->twin),
        .step = rd_take(workspace, most, sizeof *it->step),
    };
    return rd_workspace_fits(workspace);
}

/* --- one iteration --------------------------------------------------------------------------- */

/* roots first .. of z <- places in `next`, a little aside; how many are active */
static size_t set_off(struct rd_iterate *it, enum rd_mirror mirror, size_t first)
{
    size_t active = 0;
    for (size_t i = first; i < it->count; i++) {
        const double _Complex z = it->next[i - first], *const after = it->next + i + 1 - first;
        const bool paired = mirror != RD_NO_MIRROR && i + 1 < it->count &&
                            *after == rd_mirrored(mirror, z) && *after != z;
        it->z[i] = z + it->spacing * 1e-3 * cexp(CMPLX(0, (double)(i - first)));
        it->twin[i] = i;
        it->active[active++] = i;
        if (paired) {
            it->z[i + 1] = rd_mirrored(mirror, it->z[i]);
            it->twin[i] = i + 1;
            it->twin[i + 1] = i;
            i++;
        }
    }
    return active;
}

/* those of active pairs that meet go their own ways; how many are active then */
static size_t part(struct rd_iterate *it, size_t active)
{
    const double wide = MEET * it->spacing;
    size_t all = active;
    for (size_t k = 0; k < active; k++) {
        const size_t i = it->active[k], j = it->twin[i];
        if (i == j || cabs(it->z[i] - it->z[j]) >= wide)
            continue;
        it->z[i] += wide / 2;
        it->z[j] -= wide / 2;
        it->twin[i] = i;
        it->twin[j] = j;
        it->active[all++] = j;
    }
    return all;
}

/* Root i less its step with Newton's w; `step` <- the longer of the two: roots that are at one place by
   accident make short steps away from it. */
static double _Complex moved(struct rd_iterate *it, size_t i, double _Complex w)
{
    double _Complex sum = 0;
    for (size_t j = 0; j < it->count; j++)
        if (j != i)
            sum += 1 / (it->z[i] - it->z[j]);
    double _Complex step = w / (1 - w * sum);
    if (!isfinite(cabs(step)))
        step = it->spacing * 0.1;
    step *= fmin(1, 4 * it->spacing / fmax(cabs(step), 1e-300));
    it->step[i] = fmax(cabs(w), cabs(step));
    return it->z[i] - step;
}

/* a step of all active ones from values at them and h away */
static void move(struct rd_iterate *it, const struct rd_function *f, double h, size_t active)
{
    for (size_t k = 0; k < active; k++) {
        const double _Complex value = it->value[2 * k];
        const double grown = fmin(it->magnitude[2 * k + 1] - it->magnitude[2 * k], 600);
        const double _Complex slope = (it->value[2 * k + 1] * exp(grown) - value) / h;
        it->next[k] = moved(it, it->active[k], value / slope);
    }
    for (size_t k = 0; k < active; k++) {
        const size_t i = it->active[k];
        const double size = cabs(it->next[k]);
        it->z[i] = it->next[k];
        if (size > 0.999 * f->reach) {
            it->z[i] *= 0.9 * f->reach / size * cexp(CMPLX(0, 0.3));
            it->step[i] = INFINITY;
        }
        if (it->twin[i] != i) {
            it->z[it->twin[i]] = rd_mirrored(f->mirror, it->z[i]);
            it->step[it->twin[i]] = it->step[i];
        }
    }
}

/* Whether the last step of root i was the last of all; where others move it may go on. What may lie on
   the line of its own mirror images is known as well as any. */
static bool rests(const struct rd_iterate *it, enum rd_mirror mirror, size_t i)
{
    if (it->step[i] <= CLOSE * it->spacing)
        return true;
    double next = it->spacing;
    if (mirror != RD_NO_MIRROR)
        next = fmin(next, cabs(it->z[i] - rd_mirrored(mirror, it->z[i])));
    for (size_t j = 0; j < it->count; j++)
        if (j != i)
            next = fmin(next, cabs(it->z[i] - it->z[j]));
    return it->step[i] <= NEXT * next;
}

/* whether another root is where root j is */
static bool is_taken(const struct rd_iterate *it, size_t j)
{
    for (size_t k = 0; k < it->count; k++)
        if (k != j && cabs(it->z[k] - it->z[j]) <= SAME * it->spacing + it->step[k] + it->step[j])
            return true;
    return false;
}

/* Finds those of the active roots that do not rest; where all do, those of all from the first one, and
   images that came where another root is: that is no mirror image, and they go on from between both.
   How many they are. */
static size_t wake(struct rd_iterate *it, enum rd_mirror mirror, size_t first, size_t active)
{
    size_t left = 0;
    for (size_t k = 0; k < active; k++)
        if (!rests(it, mirror, it->active[k]))
            it->active[left++] = it->active[k];
    if (left > 0)
        return left;
    for (size_t i = first; i < it->count; i++) {
        const size_t j = it->twin[i];
        if (j >= i && !rests(it, mirror, i)) {
            it->active[left++] = i;
        } else if (j > i && is_taken(it, j)) {
            it->z[j] = (it->z[i] + it->z[j]) / 2 + MEET * it->spacing;
            it->step[j] = INFINITY;
            it->twin[i] = i;
            it->twin[j] = j;
            it->active[left++] = j;
        }
    }
    return left;
}

/* takes out roots that still move, and their twins */
static void drop(struct rd_iterate *it, size_t first, size_t active)
{
    size_t kept = first;
    for (size_t k = 0; k < active; k++) {
        const size_t i = it->active[k];
        it->z[i] = it->z[it->twin[i]] = NAN;
    }
    for (size_t i = first; i < it->count; i++)
        if (!isnan(creal(it->z[i]))) {
            it->step[kept] = it->step[i];
            it->z[kept++] = it->z[i];
        }
    it->count = kept;
}

/* roots first .. from their places in `next`, other than those before them */
static enum rd_status iterate(struct rd_iterate *it, struct rd_function *f, size_t first)
{
    const double h = SLOPE * it->spacing;
    size_t active = set_off(it, f->mirror, first);
    for (int step = 0; step < MOST_STEPS && active > 0; step++) {
        active = part(it, active);
        for (size_t k = 0; k < active; k++) {
            it->at[2 * k] = it->z[it->active[k]];
            it->at[2 * k + 1] = it->at[2 * k] + h;
        }
        const enum rd_status status =
            rd_function_at(f, 2 * active, it->at, it->value, it->magnitude);
        if (status != RD_OK)
            return status;
        move(it, f, h, active);
        active = wake(it, f->mirror, first, active);
    }
    drop(it, first, active);
    return RD_OK;
}

/* --- all of a circle ------------------------------------------------------------------------- */

/* whether root j may be the mirror image of another one, and is of none yet */
static bool is_image(const struct rd_iterate *it, size_t j, double _Complex image, double unsure)
{
    const double same = SAME * it->spacing + unsure + it->step[j];
    return it->twin[j] == j && cabs(it->z[j] - image) < same;
}

/* adds mirror images that are missing, as far as there is room */
static void complete(struct rd_iterate *it, enum rd_mirror mirror)
{
    const size_t count = it->count;
    for (size_t i = 0; i < count; i++)
        it->twin[i] = i;
    for (size_t i = 0; i < count && mirror != RD_NO_MIRROR; i++) {
        if (fabs(cimag(it->z[i])) <= SAME * it->spacing || it->twin[i] != i)
            continue;
        const double _Complex image = rd_mirrored(mirror, it->z[i]);
        size_t j = 0;
        while (j < count && (j == i || !is_image(it, j, image, it->step[i])))
            j++;
        if (j < count) {
            it->twin[i] = j;
            it->twin[j] = i;
        } else if (it->count < it->most) {
            it->step[it->count] = it->step[i];
            it->z[it->count++] = image;
        }
    }
}

/* roots inside the circle, to `known` */
static size_t inside(const struct rd_iterate *it, const struct rd_winding *within,
                     double _Complex *known)
{
    size_t count = 0;
    for (size_t i = 0; i < it->count; i++)
        if (cabs(it->z[i] - within->middle) < within->radius)
            known[count++] = it->z[i];
    return count;
}

/* `next` <- places of the missing roots from what the walk around the circle tells; how many */
static size_t guess_missing(struct rd_iterate *it, const struct rd_winding *within, size_t known,
                            size_t missing)
{
    double _Complex moment[MOST_MOMENTS];
    if (missing > MOST_MOMENTS)
        return 0;
    rd_winding_moments(within, known, it->at, missing, moment);
    if (rd_powers_invert(missing, moment, it->next) != RD_OK)
        return 0;
    for (size_t k = 0; k < missing; k++)
        it->next[k] = within->middle + within->radius * it->next[k];
    return missing;
}

static size_t take_guesses(struct rd_iterate *it, const struct rd_winding *within, size_t missing,
                           size_t guesses, const double _Complex *guess)
{
    size_t count = 0;
    for (size_t k = 0; k < guesses && count < missing; k++)
        if (cabs(guess[k] - within->middle) < within->radius)
            it->next[count++] = guess[k];
    return count;
}

enum rd_status rd_iterate_find(struct rd_iterate *it, struct rd_function *f,
                               const struct rd_winding *within, size_t guesses,
                               const double _Complex *guess)
{
    const double radius = within->radius;
    it->count = 0;
    it->spacing = 2 * radius / (double)within->count;
    for (int try = 0; try < MOST_TRIES; try++) {
        const size_t first = it->count, known = inside(it, within, it->at);
        if (known >= within->count || first + within->count - known > it->most)
            break;
        const size_t missing = within->count - known;
        size_t placed = try == 0 ? take_guesses(it, within, missing, guesses, guess)
                                 : guess_missing(it, within, known, missing);
        for (; placed < missing; placed++) {
            const double turns = GOLDEN * (double)(first + placed);
            it->next[placed] = within->middle + radius *
                                                    sqrt(((double)placed + 0.5) / (double)missing) *
                                                    cexp(CMPLX(0, 2 * PI * (turns - floor(turns))));
        }
        it->count += missing;
        const enum rd_status status = iterate(it, f, first);
        if (status != RD_OK)
            return status;
        complete(it, f->mirror);
    }
    return RD_OK;
}
