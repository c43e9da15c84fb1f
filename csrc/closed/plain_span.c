/* Modes and counts of strings and of rods that twist or stretch: the phase is that of two ends.

   u = sin(kx + phi) over the length 1, K = k L; a spring sigma = s L/D = s1/s2 turns by
   atan2(K s2, s1), 0 where it holds and pi/2 where nothing does:

       Phi = K + atan2(K s2L, s1L) + atan2(K s2R, s1R) = n pi */
#include "closed/rope_lanes.h"

struct plain_end {
    lanes sigma, s1, s2;
    lane_mask stiff;
};

struct plain {
    lanes number[RD_PLAIN_NUMBERS];
    struct plain_end end[2];
    lanes scale; /* sqrt(D/m)/L [rad/s] */
    lane_mask valid;
};

struct plain_phase {
    struct turned ends;
    lanes of_K;
};

RD_INLINE struct plain plain_ropes(const struct rd_ropes *ropes, const struct lane_places *at)
{
    struct plain rope;
    rope_lanes(ropes, at, RD_PLAIN_NUMBERS, rope.number);
    const lanes L = rope.number[RD_PLAIN_LENGTH], m = rope.number[RD_PLAIN_INERTIA];
    const lanes D = rope.number[RD_PLAIN_STIFFNESS];
    rope.scale = l_root(D / m) / L;
    rope.valid = (L > 0.0) & (m > 0.0) & (D > 0.0) & finite(rope.scale) & (rope.scale > 0.0);
    for (int i = 0; i < 2; i++) {
        struct plain_end *end = rope.end + i;
        const lanes s = rope.number[i ? RD_PLAIN_SPRING1 : RD_PLAIN_SPRING0];
        end->sigma = s * L / D;
        end->stiff = projected(end->sigma, &end->s1, &end->s2);
        rope.valid &= s > -(double)INFINITY;
    }
    return rope;
}

RD_INLINE struct plain_phase plain_phase(const struct plain *rope, lanes K)
{
    struct plain_phase f = {{l_fill(0), l_fill(0)}, l_fill(1)};
    for (int i = 0; i < 2; i++) {
        const struct plain_end *end = rope->end + i;
        const lanes across = K * end->s2;
        f.ends = t_sub(f.ends, l_angle(across, end->s1));
        f.of_K += end->s1 * end->s2 / (end->s1 * end->s1 + across * across);
    }
    return f;
}

RD_INLINE lanes plain_beyond(const struct plain_phase *f, lanes K, lanes n)
{
    return l_less_angle(K, (struct turned){f->ends.eighths + 4.0 * n, f->ends.rest});
}

RD_INLINE lanes plain_root(const struct plain *rope, lanes n, lane_mask *near)
{
    lanes low = l_fill(0), high = n * (PI * (1 + 1e-15)), K = (n - 0.25) * PI;
    lane_mask open = rope->valid;
    *near = (lane_mask){0};
    for (int step = 0; step < STEPS && any(open); step++) {
        const struct plain_phase f = plain_phase(rope, K);
        const lanes beyond = plain_beyond(&f, K, n), newton = K - beyond / f.of_K;
        low = l_select(open & (beyond < 0.0), K, low);
        high = l_select(open & (beyond >= 0.0), K, high);
        const lane_mask close = (f.of_K > 0.0) & (l_abs(newton - K) <= NEAR * K);
        const lane_mask inside = (newton > low) & (newton < high);
        const lanes half = l_select(low > 0.0, 0.5 * (low + high), 0.125 * high);
        *near |= open & close;
        K = l_select(open, l_select(inside | close, newton, half), K);
        open &= ~close & (K > 1e-9);
    }
    return K;
}

/* d ln omega by every number, and the sum of what rounding of the springs does to it, in eps */
RD_INLINE lanes plain_slopes(const struct plain *rope, lanes K, lanes of_K, lanes *slope)
{
    const lanes *number = rope->number, L = number[RD_PLAIN_LENGTH], D = number[RD_PLAIN_STIFFNESS];
    lanes sum = l_fill(0), size = l_fill(0);
    for (int i = 0; i < 2; i++) {
        const struct plain_end *end = rope->end + i;
        const lanes across = K * end->s2, square = end->s1 * end->s1 + across * across;
        /* of the angle by sigma, with the other of s1 and s2 fixed, over K Phi' */
        const lanes turn = l_select(end->stiff, -end->s1, end->s2) / (square * of_K);
        const lanes by_sigma =
            turn *
            l_select(end->stiff, l_negative_where(end->s1 > 0.0, end->s2 * end->s2), l_fill(1));
        const lanes part = turn * l_select(end->stiff, -end->s2, end->s1);
        sum += part;
        size += 2.0 * l_abs(part);
        slope[i ? RD_PLAIN_SPRING1 : RD_PLAIN_SPRING0] = by_sigma * L / D;
    }
    slope[RD_PLAIN_INERTIA] = -0.5 / number[RD_PLAIN_INERTIA];
    slope[RD_PLAIN_STIFFNESS] = (0.5 - sum) / D;
    slope[RD_PLAIN_LENGTH] = (sum - 1.0) / L;
    return size;
}

RD_INLINE lane_mask plain_index(const struct plain *rope, lanes K, lanes wide, lanes noise, lanes n)
{
    const lanes low = K * (1.0 - wide), high = K * (1.0 + wide);
    const struct plain_phase below = plain_phase(rope, low), above = plain_phase(rope, high);
    return (plain_beyond(&below, low, n) < -noise) & (plain_beyond(&above, high, n) > noise);
}

RD_INLINE void plain_modes_at(const struct rd_ropes *ropes, const struct lane_places *at,
                              const struct rd_closed_modes *modes)
{
    const struct plain rope = plain_ropes(ropes, at);
    lane_mask odd, near;
    const lanes n = mode_lanes(at, &odd);
    lanes K = plain_root(&rope, n, &near), slope[RD_PLAIN_NUMBERS];
    const struct plain_phase f = plain_phase(&rope, K);
    const lanes step = plain_beyond(&f, K, n) / f.of_K, noise = l_fill(4 * ROUNDING);
    K -= step;
    const lanes moved = noise / (K * f.of_K) + ROUNDING + 1e8 * (step / K) * (step / K);
    const lanes error = moved + ROUNDING * (plain_slopes(&rope, K, f.of_K, slope) + 3.0);
    const lane_mask certified = rope.valid & near & (error < CERTAIN) & (f.of_K > 0.0) &
                                plain_index(&rope, K, l_most(l_fill(2e-13), 4.0 * moved), noise, n);
    keep_modes(ropes, at, RD_PLAIN_NUMBERS, modes, rope.scale * K, error, certified, slope);
}

RD_CLONES static void plain_modes(const struct rd_ropes *ropes, size_t first, size_t last,
                                  const struct rd_closed_modes *modes)
{
    for (; first < last; first += RD_LANES) {
        const size_t rows = last - first < RD_LANES ? last - first : RD_LANES;
        for (size_t start = 0; start < rows * modes->number; start += RD_LANES) {
            const struct lane_places at = lane_places(first, rows, modes->number, start);
            plain_modes_at(ropes, &at, modes);
        }
    }
}

RD_CLONES static void plain_count(const struct rd_ropes *ropes, size_t first, size_t last,
                                  double omega, int64_t *count)
{
    for (; first < last; first += RD_LANES) {
        const size_t rows = last - first < RD_LANES ? last - first : RD_LANES;
        const struct lane_places at = lane_places(first, rows, 1, 0);
        const struct plain rope = plain_ropes(ropes, &at);
        const lanes K = omega / rope.scale;
        const struct plain_phase f = plain_phase(&rope, K);
        lane_mask certain = rope.valid & (K > 0.0);
        const lanes slack = 4.0 + K * l_abs(f.of_K);
        const lanes below = whole_turns(plain_beyond(&f, K, l_fill(0)) / PI, slack, &certain);
        for (size_t i = 0; i < rows; i++)
            count[first + i] = certain[i] ? (int64_t)below[i] : -1;
    }
}

/* copies are chosen behind these: a copied function would be seen outside the library */
void rd_plain_modes(const struct rd_ropes *ropes, size_t first, size_t last,
                    const struct rd_closed_modes *modes)
{
    plain_modes(ropes, first, last, modes);
}

void rd_plain_count(const struct rd_ropes *ropes, size_t first, size_t last, double omega,
                    int64_t *count)
{
    plain_count(ropes, first, last, omega, count);
}
