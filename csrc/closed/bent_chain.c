/* Modes and counts of chains that bend: what stands left and right of a face meets there. */
#include "closed/chain_lanes.h"

enum { SPAN_NUMBERS = 4, LENGTH = 0, INERTIA, TENSION, STIFFNESS };
enum { STATION_NUMBERS = 4, MASS = 0, TURNING, SPRING_Z, SPRING_BETA };

static size_t at_span(size_t e)
{
    return SPAN_NUMBERS * e;
}

static size_t at_station(size_t spans, size_t s)
{
    return SPAN_NUMBERS * spans + STATION_NUMBERS * s;
}

/* both of its sides go their own ways */
static _Bool chain_splits(const struct rd_chains *chains, const double *number, size_t s)
{
    const double *here = number + at_station(chains->spans, s);
    return here[SPRING_Z] == (double)INFINITY &&
           (here[SPRING_BETA] == (double)INFINITY || chains->hinge[s]);
}

static _Bool chain_valid(const struct rd_chains *chains, const double *number)
{
    _Bool valid = 1;
    for (size_t e = 0; e < chains->spans; e++) {
        const double *span = number + at_span(e);
        valid &= span[LENGTH] > 0 && span[INERTIA] > 0 && span[STIFFNESS] > 0 &&
                 span[LENGTH] < (double)INFINITY && span[INERTIA] < (double)INFINITY &&
                 span[STIFFNESS] < (double)INFINITY && fabs(span[TENSION]) < (double)INFINITY;
    }
    for (size_t s = 0; s <= chains->spans; s++) {
        const double *here = number + at_station(chains->spans, s);
        valid &= fabs(here[MASS]) < (double)INFINITY && here[MASS] >= 0 &&
                 fabs(here[TURNING]) < (double)INFINITY && here[TURNING] >= 0 &&
                 here[SPRING_Z] > -(double)INFINITY && here[SPRING_BETA] > -(double)INFINITY;
    }
    return valid;
}

/* omega of mode n of one span between held ends with all the mass, or so */
static double chain_guess(const struct rd_chains *chains, const double *number, size_t first,
                         size_t last, double n)
{
    double L = 0, m = 0, T = 0, B = 0;
    for (size_t e = first; e < last; e++) {
        const double *span = number + at_span(e), l = span[LENGTH];
        L += l;
        m += l * span[INERTIA];
        T += l * span[TENSION];
        B += l * span[STIFFNESS];
    }
    const double beta = n * PI / L;
    return beta * sqrt(((T > 0 ? T : 0) + B * beta * beta) / m);
}

static void chain_fill(struct chain_lanes *chain, size_t i, const double *number)
{
    for (size_t j = 0; j < chain->numbers; j++)
        chain->number[j][i] = number[j];
    for (size_t e = 0; e < chain->spans; e++) {
        const double *span = number + at_span(e);
        chain->load[e][i] = sqrt(span[INERTIA] / span[STIFFNESS]);
        chain->pull[e][i] = 0.5 * span[TENSION] / span[STIFFNESS];
    }
}

RD_INLINE struct standing standing_at(const struct chain_lanes *chain, size_t s)
{
    const lanes *here = chain->number + at_station(chain->spans, s);
    return (struct standing){here[MASS], here[TURNING], here[SPRING_Z], here[SPRING_BETA]};
}

RD_INLINE struct scales scales_of(const struct chain_lanes *chain, size_t e)
{
    return (struct scales){chain->wave[e].of_z, chain->wave[e].of_beta};
}

/* the waves of all spans, and how fast kl grows with ln omega */
RD_INLINE lanes bent_spans(struct chain_lanes *chain, lanes omega)
{
    lanes pace = l_fill(0);
    for (size_t e = 0; e < chain->spans; e++) {
        const lanes *span = chain->number + at_span(e);
        struct span_waves *w = chain->wave + e;
        *w = span_waves(span[LENGTH], chain->load[e], chain->pull[e], span[STIFFNESS], omega);
        const long long at = (long long)e;
        const lane_mask mine = (chain->first <= at) & (chain->last > at);
        pace += l_select(mine, w->kl * w->alpha * w->alpha, l_fill(0));
    }
    return pace;
}

/* right of a station that holds what meets there */
RD_INLINE struct part beyond_split(_Bool hinged)
{
    struct part part = free_part();
    part.G.a = c_real(-1);
    part.less.eighths = l_fill(hinged ? 2 : 4);
    if (!hinged)
        part.G.c = c_real(-1);
    return part;
}

/* from the left to each face */
RD_INLINE void bent_from_left(struct chain_lanes *chain, lanes omega)
{
    struct part part = free_part();
    for (size_t s = 0; s < chain->spans; s++) {
        const long long at = (long long)s;
        const struct part before = part;
        const struct standing here = standing_at(chain, s);
        chain->station[0][s] = pass_station(&part, &here, omega, scales_of(chain, s ? s - 1 : 0),
                                            scales_of(chain, s));
        if (chain->hinge[s])
            pass_hinge(&part, chain->station[0] + s);
        if (chain->split && s > 0) {
            const struct part apart = beyond_split(chain->hinge[s]);
            put_where(chain->first == at, &part, &apart, sizeof part);
        }
        chain->Y[0][s] = pass_span(&part, chain->wave + s, chain->near[0] + s);
        if (chain->split)
            put_where(chain->last <= at, &part, &before, sizeof part);
        chain->left[s + 1] = part;
    }
}

/* what stands at the last station alone */
RD_INLINE struct part bent_end(struct chain_lanes *chain, lanes omega, size_t s)
{
    struct part part = free_part();
    const struct standing here = standing_at(chain, s);
    const struct scales scales = scales_of(chain, s - 1);
    chain->station[1][s] = pass_station(&part, &here, omega, scales, scales);
    return part;
}

/* the part from the right to the face left of station s, of what it was right of span s */
RD_INLINE void bent_from_right(struct chain_lanes *chain, lanes omega, size_t s, struct part *part)
{
    const struct part end = bent_end(chain, omega, s);
    if (s == chain->spans) {
        *part = end;
        return;
    }
    const struct station end_station = chain->station[1][s];
    const struct standing here = standing_at(chain, s);
    chain->Y[1][s] = pass_span(part, chain->wave + s, chain->near[1] + s);
    struct station hinged;
    if (chain->hinge[s])
        pass_hinge(part, &hinged);
    struct station *station = chain->station[1] + s;
    *station = pass_station(part, &here, omega, scales_of(chain, s), scales_of(chain, s - 1));
    if (chain->hinge[s])
        station->hinge = hinged.hinge;
    const lane_mask last = chain->last == (long long)s;
    put_where(last, part, &end, sizeof end);
    put_where(last, station, &end_station, sizeof end_station);
}

/* where the two parts meet: at the right end, or where the phase is nearest to passing 0 */
RD_INLINE struct meeting bent_meeting(struct chain_lanes *chain, lanes omega,
                                      const struct chain_place *place, lane_mask *face)
{
    struct meeting found = {0};
    struct part part = free_part();
    lanes least = l_fill(INFINITY);
    const _Bool wide = any(place->wide);
    *face = (lane_mask){0};
    for (size_t s = chain->spans; s > 0; s--) {
        const long long at = (long long)s;
        const lane_mask last = chain->last == at;
        if (!wide && !any(last))
            continue;
        if (wide)
            bent_from_right(chain, omega, s, &part);
        else
            part = bent_end(chain, omega, s);
        const struct meeting here = meet(chain->left + s, &part);
        const lanes off = l_abs(meeting_beyond(&here, place->odd, place->turns));
        const lane_mask mine = (chain->first < at) & (chain->last >= at) & (off < least);
        const lane_mask take = last | (place->wide & mine);
        put_where(take, &found, &here, sizeof here);
        least = l_select(take, off, least);
        *face = (take & at) | (~take & *face);
    }
    return found;
}

RD_INLINE lanes chain_phase(struct chain_lanes *chain, lanes omega, const struct chain_place *place,
                           lanes *pace)
{
    lane_mask face;
    *pace = bent_spans(chain, omega);
    bent_from_left(chain, omega);
    const struct meeting m = bent_meeting(chain, omega, place, &face);
    return meeting_beyond(&m, place->odd, place->turns);
}

/* what a station does to the phase, where b goes in after it */
RD_INLINE void station_slopes(struct chain_lanes *chain, const struct station *station, size_t s,
                              lanes omega, struct duo b, struct scales scales,
                              struct chain_slope *sum)
{
    const struct duo a = pair_times(&station->G, b);
    const lanes z = c_square(c_add(a.z, b.z)) * 0.25, beta = c_square(c_add(a.beta, b.beta)) * 0.25;
    const lanes *here = chain->number + at_station(chain->spans, s);
    lanes *slope = chain->slope + at_station(chain->spans, s);
    const lanes of_z = -2.0 * z / scales.z, of_beta = -2.0 * beta / scales.beta;
    const lanes square = omega * omega, none = l_fill(0);
    slope[SPRING_Z] += l_select(finite(here[SPRING_Z]), of_z, none);
    slope[SPRING_BETA] += l_select(finite(here[SPRING_BETA]), of_beta, none);
    slope[MASS] -= square * of_z;
    slope[TURNING] -= square * of_beta;
    sum->of_omega -= 2.0 * square * (here[MASS] * of_z + here[TURNING] * of_beta);
    sum->noise += 12.0 * duo_square(b);
    sum->noise += l_select(finite(here[SPRING_Z]), 8.0 * station->load_z * z, none);
    sum->noise += l_select(finite(here[SPRING_BETA]), 8.0 * station->load_beta * beta, none);
}

/* what goes into each span left of the face where the parts meet */
RD_INLINE void bent_to_left(struct chain_lanes *chain, lanes omega, lane_mask face,
                            struct duo start, struct chain_slope *sum)
{
    struct duo b = {c_zero(), c_zero()};
    for (size_t s = chain->spans; s > 0; s--) {
        const size_t e = s - 1;
        const struct station *station = chain->station[0] + e;
        b = duo_add(b, duo_where(face == (long long)s, start));
        chain->in[0][e] = b;
        sum->noise += 8.0 * duo_square(pair_times(&chain->wave[e].N, b)) * chain->near[0][e];
        b = mirrored_duo(through_span(chain->wave + e, chain->Y[0] + e, b, chain->in[1] + e));
        if (chain->split && e > 0)
            b = duo_where(chain->first != (long long)e, b);
        if (chain->hinge[e])
            b.beta = c_mul(station->hinge, b.z);
        station_slopes(chain, station, e, omega, b, scales_of(chain, e), sum);
        b = through_station(station, b);
    }
}

/* and right of it */
RD_INLINE void bent_to_right(struct chain_lanes *chain, lanes omega, lane_mask face,
                             struct duo start, _Bool wide, struct chain_slope *sum)
{
    struct duo b = {c_zero(), c_zero()}, back;
    for (size_t s = 1; s <= chain->spans; s++) {
        const struct station *station = chain->station[1] + s;
        const lane_mask ends = chain->last == (long long)s;
        if (!wide && !any(ends))
            continue;
        b = duo_add(b, duo_where(face == (long long)s, start));
        station_slopes(chain, station, s, omega, b, scales_of(chain, s - 1), sum);
        if (s == chain->spans)
            return;
        b = duo_where(~ends, through_station(station, b));
        if (!wide)
            continue;
        if (chain->hinge[s])
            b.beta = c_mul(station->hinge, b.z);
        sum->noise += 8.0 * duo_square(pair_times(&chain->wave[s].N, b)) * chain->near[1][s];
        chain->in[1][s] = duo_add(chain->in[1][s], b);
        b = mirrored_duo(through_span(chain->wave + s, chain->Y[1] + s, b, &back));
        chain->in[0][s] = duo_add(chain->in[0][s], back);
    }
}

/* the phase with its slopes by all numbers */
RD_INLINE struct chain_slope chain_slopes(struct chain_lanes *chain, lanes omega,
                                        const struct chain_place *place)
{
    lane_mask face;
    for (size_t j = 0; j < chain->numbers; j++)
        chain->slope[j] = l_fill(0);
    bent_spans(chain, omega);
    bent_from_left(chain, omega);
    const struct meeting m = bent_meeting(chain, omega, place, &face);
    const struct duo wave = meeting_wave(&m, place->odd);
    struct chain_slope sum = {.beyond = meeting_beyond(&m, place->odd, place->turns),
                              .of_omega = l_fill(0),
                              .noise = 16.0 + l_abs(m.K),
                              .split = m.size};
    bent_to_left(chain, omega, face, pair_times(&m.second, wave), &sum);
    bent_to_right(chain, omega, face, mirrored_duo(wave), any(place->wide), &sum);
    for (size_t e = 0; e < chain->spans; e++) {
        const lanes *span = chain->number + at_span(e);
        lanes *slope = chain->slope + at_span(e);
        const struct span_slopes of =
            span_slopes(chain->wave + e, chain->pull[e], chain->in[0][e], chain->in[1][e]);
        slope[LENGTH] = of.length / span[LENGTH];
        slope[INERTIA] = of.inertia / span[INERTIA];
        slope[TENSION] = of.tension / span[STIFFNESS];
        slope[STIFFNESS] = of.stiffness / span[STIFFNESS];
        sum.of_omega += 2.0 * of.inertia;
        sum.noise += of.noise;
    }
    return sum;
}

#include "closed/chain_roots.h"

void rd_bent_chain_modes(const struct rd_chains *chains, size_t first, size_t last,
                         const struct rd_closed_modes *modes, void *work)
{
    chain_modes(chains, rd_bent_numbers(chains->spans), first, last, modes, work);
}

void rd_bent_chain_count(const struct rd_chains *chains, size_t first, size_t last, double omega,
                         int64_t *count, void *work)
{
    chain_count(chains, rd_bent_numbers(chains->spans), first, last, omega, count, work);
}
