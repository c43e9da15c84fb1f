/* Walks over the lanes of a chain: to the face where its parts meet, and back with the waves there.
   What includes this has

       chain_standing        what stands at a station
       chain_turns_free      whether beta is free beside a station that splits the chain
       chain_span            the waves of a span; how fast its kl grows with ln omega
       chain_pass            the part with a span more
       chain_beyond          the phase that passes 0 at the mode of a place
       chain_wave            what goes into the second part there
       chain_station_slopes, chain_span_slopes

*/
#ifndef RD_CHAIN_WALK_H
#define RD_CHAIN_WALK_H

#include "closed/chain_lanes.h"

RD_INLINE struct scales scales_of(const struct chain_lanes *chain, size_t e)
{
    return (struct scales){chain->wave[e].of_z, chain->wave[e].of_beta};
}

/* the waves of all spans, and how fast kl grows with ln omega */
RD_INLINE lanes chain_spans(struct chain_lanes *chain, lanes omega)
{
    lanes pace = l_fill(0);
    for (size_t e = 0; e < chain->spans; e++) {
        const long long at = (long long)e;
        const lane_mask mine = (chain->first <= at) & (chain->last > at);
        pace += l_select(mine, chain_span(chain, e, omega), l_fill(0));
    }
    return pace;
}

/* right of a station that holds what meets there */
RD_INLINE struct part beyond_split(_Bool turns_free)
{
    struct part part = free_part();
    part.G.a = c_real(-1);
    /* half a turn for each that is held */
    part.turn = turns_free ? c_imag(1) : c_real(-1);
    if (!turns_free)
        part.G.c = c_real(-1);
    return part;
}

/* from the left to each face; with `kept` what the way back asks for */
RD_INLINE void chain_from_left(struct chain_lanes *chain, lanes omega, _Bool kept)
{
    struct part part = free_part();
    for (size_t s = 0; s < chain->spans; s++) {
        const long long at = (long long)s;
        const struct standing here = chain_standing(chain, s);
        if (chain->split)
            chain->left[s + 1] = part;
        struct station station =
            pass_station(&part, &here, omega, scales_of(chain, s ? s - 1 : 0), scales_of(chain, s));
        if (chain->hinge[s])
            pass_hinge(&part, &station);
        if (chain->split && s > 0) {
            const struct part apart = beyond_split(chain_turns_free(chain, s));
            put_where(chain->first == at, &part, &apart, sizeof part);
        }
        lanes near;
        const struct pair Y = chain_pass(&part, chain->wave + s, &near);
        if (kept) {
            chain->station[0][s] = station;
            chain->Y[0][s] = Y;
            chain->near[0][s] = near;
        }
        if (chain->split)
            put_where(chain->last <= at, &part, chain->left + s + 1, sizeof part);
        chain->left[s + 1] = part;
    }
}

/* what stands at the last station alone */
RD_INLINE struct part chain_end(struct chain_lanes *chain, lanes omega, size_t s)
{
    struct part part = free_part();
    const struct standing here = chain_standing(chain, s);
    const struct scales scales = scales_of(chain, s - 1);
    chain->station[1][s] = pass_station(&part, &here, omega, scales, scales);
    return part;
}

/* the part from the right to the face left of station s, of what it was right of span s */
RD_INLINE void chain_from_right(struct chain_lanes *chain, lanes omega, size_t s, struct part *part)
{
    const struct part end = chain_end(chain, omega, s);
    if (s == chain->spans) {
        *part = end;
        return;
    }
    const struct station end_station = chain->station[1][s];
    const struct standing here = chain_standing(chain, s);
    chain->Y[1][s] = chain_pass(part, chain->wave + s, chain->near[1] + s);
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
RD_INLINE struct meeting chain_meeting(struct chain_lanes *chain, lanes omega,
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
            chain_from_right(chain, omega, s, &part);
        else
            part = chain_end(chain, omega, s);
        const struct meeting here = meet(chain->left + s, &part);
        const lanes off = l_abs(chain_beyond(&here, place));
        const lane_mask mine = (chain->first < at) & (chain->last >= at) & (off < least);
        const lane_mask take = last | (place->wide & mine);
        put_where(take, &found, &here, sizeof here);
        least = l_select(take, off, least);
        *face = (take & at) | (~take & *face);
    }
    return found;
}

/* the phase that passes 0 at the mode of a place; how fast it grows with ln omega where nothing
   disturbs the waves */
RD_CLONES static void chain_phase(struct chain_lanes *chain, const lanes *omega,
                                  const struct chain_place *place, lanes *beyond, lanes *pace)
{
    lane_mask face;
    *pace = chain_spans(chain, *omega);
    chain_from_left(chain, *omega, 0);
    const struct meeting m = chain_meeting(chain, *omega, place, &face);
    *beyond = chain_beyond(&m, place);
}

/* what a station does to the phase, where b goes in after it */
RD_INLINE void station_slopes(struct chain_lanes *chain, const struct station *station, size_t s,
                              lanes omega, struct duo b, struct scales scales,
                              struct chain_slope *sum)
{
    const struct duo a = pair_times(&station->G, b);
    const struct standing here = chain_standing(chain, s);
    const lanes none = l_fill(0), square = omega * omega;
    const lanes z = -0.5 * c_square(c_add(a.z, b.z)) / scales.z;
    const lanes beta = -0.5 * c_square(c_add(a.beta, b.beta)) / scales.beta;
    /* what is held does not move */
    const lanes of_z = l_select(finite(here.spring_z), z, none);
    const lanes of_beta = l_select(finite(here.spring_beta), beta, none);
    const lanes inert_z = square * here.mass, inert_beta = square * here.turning;
    chain_station_slopes(chain->slope + chain->spans * SPAN_NUMBERS + s * STATION_NUMBERS, of_z,
                         of_beta, square);
    sum->of_omega -= 2.0 * (inert_z * of_z + inert_beta * of_beta);
    sum->noise += 12.0 * duo_square(b);
    sum->noise +=
        l_select(finite(here.spring_z), 4.0 * l_abs(of_z) * (l_abs(here.spring_z) + inert_z), none);
    sum->noise += l_select(finite(here.spring_beta),
                           4.0 * l_abs(of_beta) * (l_abs(here.spring_beta) + inert_beta), none);
}

/* a span on the way of b, with what comes back from beyond it; b is 0 where no wave goes, whatever
   was found there */
RD_INLINE struct duo cross_span(struct chain_lanes *chain, size_t e, int side, struct duo b,
                                lane_mask way, struct duo *back, struct chain_slope *sum)
{
    const struct span_waves *w = chain->wave + e;
    const lanes near = l_root(chain->near[side][e]);
    const lanes noise = 8.0 * duo_square(pair_times(&w->N, b)) * near;
    sum->noise += l_select(way, noise, l_fill(0));
    b = mirrored_duo(through_span(w, chain->Y[side] + e, b, back));
    *back = duo_where(way, *back);
    return duo_where(way, b);
}

/* a station on the way of b */
RD_INLINE struct duo cross_station(struct chain_lanes *chain, size_t s, int side, lanes omega,
                                   struct scales scales, struct duo b, lane_mask way,
                                   struct chain_slope *sum)
{
    struct station station = chain->station[side][s];
    put_where(~way, &station, &(struct station){0}, sizeof station);
    if (side == 0 && chain->hinge[s])
        b.beta = c_mul(station.hinge, b.z);
    station_slopes(chain, &station, s, omega, b, scales, sum);
    b = through_station(&station, b);
    if (side == 1 && chain->hinge[s])
        b.beta = c_mul(station.hinge, b.z);
    return b;
}

/* what goes into each span left of the face where the parts meet */
RD_INLINE void chain_to_left(struct chain_lanes *chain, lanes omega, lane_mask face,
                             struct duo start, struct chain_slope *sum)
{
    struct duo b = {c_zero(), c_zero()};
    for (size_t e = chain->spans; e-- > 0;) {
        const long long at = (long long)e;
        const lane_mask way = (chain->first <= at) & (face > at);
        b = duo_add(b, duo_where(face == at + 1, start));
        chain->in[0][e] = b;
        b = cross_span(chain, e, 0, b, way, chain->in[1] + e, sum);
        const lane_mask further = e > 0 ? way & (chain->first < at) : way;
        b = cross_station(chain, e, 0, omega, scales_of(chain, e), duo_where(further, b), further,
                          sum);
    }
}

/* and right of it */
RD_INLINE void chain_to_right(struct chain_lanes *chain, lanes omega, lane_mask face,
                              struct duo start, _Bool wide, struct chain_slope *sum)
{
    struct duo b = {c_zero(), c_zero()}, back;
    for (size_t s = 1; s <= chain->spans; s++) {
        const long long at = (long long)s;
        if (!wide && !any(chain->last == at))
            continue;
        b = duo_add(b, duo_where(face == at, start));
        b = cross_station(chain, s, 1, omega, scales_of(chain, s - 1), b,
                          (face <= at) & (chain->last >= at), sum);
        const lane_mask way = (face <= at) & (chain->last > at);
        b = duo_where(way, b);
        if (!wide || s == chain->spans)
            continue;
        chain->in[1][s] = duo_add(chain->in[1][s], b);
        b = cross_span(chain, s, 1, b, way, &back, sum);
        chain->in[0][s] = duo_add(chain->in[0][s], back);
    }
}

/* the phase with its slopes by all numbers */
RD_CLONES static void chain_slopes(struct chain_lanes *chain, const lanes *at,
                                   const struct chain_place *place, struct chain_slope *sum)
{
    lane_mask face;
    const lanes omega = *at;
    for (size_t j = 0; j < chain->numbers; j++)
        chain->slope[j] = l_fill(0);
    chain_spans(chain, omega);
    chain_from_left(chain, omega, 1);
    const struct meeting m = chain_meeting(chain, omega, place, &face);
    const struct duo wave = chain_wave(&m, place);
    *sum = (struct chain_slope){.beyond = chain_beyond(&m, place),
                                .of_omega = l_fill(0),
                                .noise = 16.0 + l_abs(m.K),
                                .split = chain_split(&m)};
    chain_to_left(chain, omega, face, pair_times(&m.second, wave), sum);
    chain_to_right(chain, omega, face, mirrored_duo(wave), any(place->wide), sum);
    for (size_t e = 0; e < chain->spans; e++)
        chain_span_slopes(chain, e, sum);
}

#endif
