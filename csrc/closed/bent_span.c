/* Modes and counts of tensed spans that bend: Newton's way to Phi_n(y) = n pi. */
#include "closed/rope_lanes.h"
#include "closed/span_phase.h"

struct bent {
    lanes number[RD_BENT_NUMBERS];
    struct span_ends ends;
    lanes kappa[2], sigma[2];
    lanes scale;     /* sqrt(B/mu)/L^2 [rad/s] */
    lane_mask valid; /* the numbers have a meaning */
};

RD_INLINE struct bent bent_ropes(const struct rd_ropes *ropes, const struct lane_places *at)
{
    struct bent rope;
    rope_lanes(ropes, at, RD_BENT_NUMBERS, rope.number);
    const lanes L = rope.number[RD_BENT_LENGTH], mu = rope.number[RD_BENT_INERTIA];
    const lanes B = rope.number[RD_BENT_STIFFNESS], per = L / B;
    rope.ends.p = rope.number[RD_BENT_TENSION] * L * per;
    rope.scale = l_root(B / mu) / (L * L);
    rope.valid = (L > 0.0) & (mu > 0.0) & (B > 0.0) & finite(rope.ends.p) & finite(rope.scale) &
                 (rope.scale > 0.0);
    for (int i = 0; i < 2; i++) {
        const lanes z = rope.number[i ? RD_BENT_Z1 : RD_BENT_Z0];
        const lanes beta = rope.number[i ? RD_BENT_BETA1 : RD_BENT_BETA0];
        rope.kappa[i] = beta * per;
        rope.sigma[i] = z * L * L * per;
        rope.ends.end[i] = end_of_springs(rope.kappa[i], rope.sigma[i]);
        rope.valid &= (z > -(double)INFINITY) & (beta > -(double)INFINITY);
    }
    return rope;
}

/* d ln omega by every number, and the sum of all that their rounding does to it, in units of eps */
RD_INLINE lanes bent_slopes(const struct bent *rope, const struct span_phase *f, lanes y,
                            lanes of_y, lanes *slope)
{
    const lanes p = rope->ends.p, y2 = y * y, K2 = f->K * f->K, A2 = f->A * f->A;
    const lanes w = y * (1.0 / K2 + 1.0 / A2) / of_y;
    const lane_mask tensed = p >= 0.0;
    const lanes of_p = l_select(tensed, 0.5 * f->of_A / f->A, -0.5 * f->of_K / f->K);
    const lanes by_p = l_select(tensed, 0.5 / A2, -0.5 / K2) - w * of_p;
    const lanes *number = rope->number, L = number[RD_BENT_LENGTH], B = number[RD_BENT_STIFFNESS];
    const lanes per = L / B;
    lanes kappas = l_fill(0), sigmas = l_fill(0), size = l_fill(0);
    for (int i = 0; i < 2; i++) {
        const struct end_springs *end = rope->ends.end + i;
        /* d k2 = -|kappa|^-2 d|kappa| where kappa is stiff */
        const lanes k = -w * f->of_k[i], s = -w * f->of_s[i];
        const lanes k_turn = l_negative_where(end->k1 > 0.0, end->k2 * end->k2);
        const lanes s_turn = l_negative_where(end->s1 > 0.0, end->s2 * end->s2);
        const lanes kappa = k * l_select(end->stiff_k, -end->k2, end->k1);
        const lanes sigma = s * l_select(end->stiff_s, -end->s2, end->s1);
        kappas += kappa;
        sigmas += sigma;
        size += 3.0 * l_abs(kappa) + 5.0 * l_abs(sigma);
        slope[i ? RD_BENT_BETA1 : RD_BENT_BETA0] =
            k * l_select(end->stiff_k, k_turn, l_fill(1)) * per;
        slope[i ? RD_BENT_Z1 : RD_BENT_Z0] =
            s * l_select(end->stiff_s, s_turn, l_fill(1)) * per * L * L;
    }
    slope[RD_BENT_TENSION] = by_p * L * per;
    slope[RD_BENT_INERTIA] = -0.5 / number[RD_BENT_INERTIA];
    slope[RD_BENT_STIFFNESS] = (0.5 * y2 / (y2 + l_abs(p)) + w * p * of_p - kappas - sigmas) / B;
    slope[RD_BENT_LENGTH] = (-2.0 + 2.0 * p * by_p + kappas + 3.0 * sigmas) / L;
    return 3.0 * l_abs(p * by_p) + size;
}

/* Of mode n, from K = (n + 1/4) pi; the K of a mode is never above that of clamped ends,
   (n + 1) pi. */
RD_INLINE lanes bent_root(const struct bent *rope, lanes n, lane_mask odd, lane_mask *near)
{
    const lanes less = l_select(rope->ends.p < 0.0, rope->ends.p, l_fill(0));
    const lanes most = (n + 1.0) * PI, about = (n + 0.25) * PI;
    const lanes room = most * most + less, guess = about * about + less;
    lanes low = l_fill(0), high = l_root(l_select(room > 0.0, room, l_fill(0))) * (1 + 1e-15);
    lanes y = l_select(guess > 0.0, l_root(l_select(guess > 0.0, guess, l_fill(0))), 0.5 * high);
    lane_mask open = rope->valid & (high > 0.0) & (y > 0.0);
    *near = (lane_mask){0};
    for (int step = 0; step < STEPS && any(open); step++) {
        const struct span_phase f = span_phase(&rope->ends, y, odd, 1);
        const lanes beyond = phase_beyond(&f, odd, n);
        const lanes of_y = y * (f.of_K / f.K + f.of_A / f.A);
        low = l_select(open & (beyond < 0.0), y, low);
        high = l_select(open & (beyond >= 0.0), y, high);
        const lanes newton = y - beyond / of_y;
        const lane_mask inside = (newton > low) & (newton < high);
        const lanes half = l_select(low > 0.0, 0.5 * (low + high), 0.125 * high);
        const lane_mask close = (of_y > 0.0) & (l_abs(newton - y) <= NEAR * y);
        const lanes next = l_select(inside | close, newton, half);
        *near |= open & close;
        y = l_select(open, next, y);
        open &= ~close & (y > 1e-9);
    }
    return y;
}

/* of which modes the index is shown: Phi_n < n pi at y (1 - wide), > n pi at y (1 + wide) */
RD_INLINE lane_mask bent_index(const struct bent *rope, lanes y, lanes wide, lanes noise, lanes n,
                               lane_mask odd)
{
    const struct span_phase below = span_phase(&rope->ends, y * (1.0 - wide), odd, 0);
    const struct span_phase above = span_phase(&rope->ends, y * (1.0 + wide), odd, 0);
    return (below.delta > 0.0) & (above.delta > 0.0) & (phase_beyond(&below, odd, n) < -noise) &
           (phase_beyond(&above, odd, n) > noise);
}

RD_INLINE void bent_modes_at(const struct rd_ropes *ropes, const struct lane_places *at,
                             const struct bent *of, const struct rd_closed_modes *modes)
{
    const struct bent rope = *of;
    lane_mask odd, near;
    const lanes n = mode_lanes(at, &odd);
    lanes y = bent_root(&rope, n, odd, &near), slope[RD_BENT_NUMBERS];
    const struct span_phase f = span_phase(&rope.ends, y, odd, 1);
    const lanes of_y = y * (f.of_K / f.K + f.of_A / f.A);
    const lanes step = phase_beyond(&f, odd, n) / of_y;
    y -= step;
    /* of y, relative */
    const lanes noise = ROUNDING * f.noise;
    const lanes moved = noise / (y * of_y) + ROUNDING + 1e8 * (step / y) * (step / y);
    const lanes stiff = y * y + l_abs(rope.ends.p);
    const lanes given = bent_slopes(&rope, &f, y, of_y, slope);
    const lanes error = (1.0 + y * y / stiff) * moved + ROUNDING * (given + 4.0);
    const lanes wide = l_most(l_fill(2e-13), 4.0 * moved);
    const lane_mask certified = rope.valid & near & (error < CERTAIN) & (of_y > 0.0) &
                                (f.delta > 0.0) & bent_index(&rope, y, wide, noise, n, odd);
    keep_modes(ropes, at, RD_BENT_NUMBERS, modes, rope.scale * y * l_root(stiff), error, certified,
               slope);
}

RD_CLONES static void bent_modes(const struct rd_ropes *ropes, size_t first, size_t last,
                                 const struct rd_closed_modes *modes)
{
    for (; first < last; first += RD_LANES) {
        const size_t rows = last - first < RD_LANES ? last - first : RD_LANES;
        struct bent rope;
        for (size_t start = 0; start < rows * modes->number; start += RD_LANES) {
            const struct lane_places at = lane_places(first, rows, modes->number, start);
            if (start == 0 || rows < RD_LANES)
                rope = bent_ropes(ropes, &at);
            bent_modes_at(ropes, &at, &rope, modes);
        }
    }
}

/* modes below y of odd or even n */
RD_INLINE lanes bent_count_of(const struct bent *rope, lanes y, lane_mask odd, lane_mask *certain)
{
    const struct span_phase f = span_phase(&rope->ends, y, odd, 1);
    const lanes turns = phase_beyond(&f, odd, l_fill(0)) / PI, slack = f.noise + l_abs(y * f.of_K);
    *certain &= f.delta > 0.0;
    return whole_turns(0.5 * (turns + l_select(odd, l_fill(1), l_fill(0))), slack, certain);
}

RD_CLONES static void bent_count(const struct rd_ropes *ropes, size_t first, size_t last,
                                 double omega, int64_t *count)
{
    for (; first < last; first += RD_LANES) {
        const size_t rows = last - first < RD_LANES ? last - first : RD_LANES;
        const struct lane_places at = lane_places(first, rows, 1, 0);
        const struct bent rope = bent_ropes(ropes, &at);
        const lanes p = 0.5 * l_abs(rope.ends.p), W = omega / rope.scale;
        /* K A = W */
        const lanes y = W / l_root(p + l_root(p * p + W * W));
        lane_mask certain = rope.valid & (y > 0.0);
        const lanes odd = bent_count_of(&rope, y, (lane_mask){0} - 1, &certain);
        const lanes all = odd + bent_count_of(&rope, y, (lane_mask){0}, &certain);
        for (size_t i = 0; i < rows; i++)
            count[first + i] = certain[i] ? (int64_t)all[i] : -1;
    }
}

/* copies are chosen behind these: a copied function would be seen outside the library */
void rd_bent_modes(const struct rd_ropes *ropes, size_t first, size_t last,
                   const struct rd_closed_modes *modes)
{
    bent_modes(ropes, first, last, modes);
}

void rd_bent_count(const struct rd_ropes *ropes, size_t first, size_t last, double omega,
                   int64_t *count)
{
    bent_count(ropes, first, last, omega, count);
}
