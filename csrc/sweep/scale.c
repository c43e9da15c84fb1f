/* The characteristic receptances that scale a sweep, and how long its pieces may be. */
#include "sweep/scale.h"

#include "closed/lane_trig.h"

#include "span/span.h"

#include <math.h>

#pragma GCC diagnostic ignored "-Wpsabi"

/* Propagating and evanescent wavenumber squared of B z'''' - T z'' = q z:
       h = T/2B, r = sqrt(h^2 + q/B), a^2 = r + h, k^2 = r - h, the smaller one from k a */
static void wavenumbers(double B, double T, double q, double *k2, double *a2)
{
    const double h = 0.5 * T / B, r = sqrt(h * h + q / B);
    if (h >= 0.0) {
        *a2 = r + h;
        *k2 = *a2 > 0.0 ? q / (B * *a2) : 0.0;
    } else {
        *k2 = r - h;
        *a2 = q / (B * *k2);
    }
}

static const double PI = 3.14159265358979323846;

/* a piece has so many at most, below the first resonance of a cantilever */
static const double RADIANS = 1.2;

static double size_of(const double *factor)
{
    if (factor[1] == 0.0)
        return fabs(factor[0]);
    return sqrt(factor[0] * factor[0] + factor[1] * factor[1]);
}

/* z^2 = 1/(B k (k^2 + a^2)), 1/(B a) for z, beta; 1/(T k) without bending; 1/(C k) for twist,
   and so for x: receptances of the endless rope; a rigid element has no less than l/4B for beta.
   Below its first resonance a rope that can move as a rigid body does: where that receptance is the
   larger, I - U = -i f of the parts would be the small difference of large numbers without it. */
void rd_sweep_receptance(const struct rd_chain *chain, const struct rd_runs *runs,
                         const struct sweep_extent *x, double *z)
{
    const double section = 1.0 / x->section, T = runs->tension * x->tension;
    const double spring = x->spring, lambda = x->inertia;
    const double L = runs->length, least = 1.0 / (L * L);
    const double S = runs->flexibility[RD_BENDING], l = L / (double)(chain->nodes - 1);
    const size_t lateral = rd_coordinate_find(chain->width, chain->coordinate, RD_Z);
    const double mu = lateral < chain->width ? runs->mass[lateral] : 0.0;
    for (size_t i = 0; i < chain->width; i++) {
        const int32_t c = chain->coordinate[i];
        double endless;
        if (S > 0.0 && (c == RD_Z || c == RD_BETA)) {
            double k2, a2;
            wavenumbers(section / S, T, mu * lambda, &k2, &a2);
            k2 = fmax(k2, least);
            a2 = fmax(a2, least);
            if (c == RD_BETA && chain->kind == RD_RIGID)
                a2 = fmin(a2, 16.0 / (l * l));
            endless = c == RD_Z ? S / (section * sqrt(k2) * (k2 + a2)) : S / (section * sqrt(a2));
        } else {
            const double C = c == RD_Z ? fabs(T) : section / runs->flexibility[rd_channel_of(c)];
            endless = 1.0 / (C * sqrt(fmax(lambda * runs->mass[i] / C, least)));
        }
        z[i] = sqrt(fmax(endless, rd_body_receptance(&runs->body, chain, i, lambda, spring, T)));
    }
    /* x of a rope that hangs follows z */
    if (chain->sag)
        z[0] = hypot(z[0], runs->sag * L * z[1]);
}

static cv times(cv a, lanes s)
{
    return c_scale_lanes(a, s);
}

/* the factors of a block */
struct factors {
    cv section, tension, spring, inertia, dashpot;
};

static void load_one(const double *factor, size_t lane, cv *into)
{
    into->re[lane] = factor[0];
    into->im[lane] = factor[1];
}

static void load(const struct rd_chain *chain, const struct rd_factors *f, size_t lane, size_t i,
                 struct factors *into)
{
    load_one(f->section + 2 * i, lane, &into->section);
    load_one(f->tension + 2 * i, lane, &into->tension);
    load_one(f->spring + 2 * i, lane, &into->spring);
    load_one(f->inertia + 2 * i, lane, &into->inertia);
    if (rd_chain_is_dragged(chain) || chain->attached > 0)
        load_one(f->dashpot + 2 * i, lane, &into->dashpot);
}

struct sweep_extent rd_sweep_extent(const struct rd_factors *factors, size_t i)
{
    return (struct sweep_extent){
        .section = 1.0 / size_of(factors->section + 2 * i),
        .tension = size_of(factors->tension + 2 * i),
        .spring = size_of(factors->spring + 2 * i),
        .inertia = size_of(factors->inertia + 2 * i),
        .dashpot = factors->dashpot ? size_of(factors->dashpot + 2 * i) : 0.0,
    };
}

struct rd_sizes rd_sweep_sizes(const struct sweep_extent *extent)
{
    return (struct rd_sizes){
        .section = 1.0 / extent->section,
        .tension = extent->tension,
        .inertia = extent->inertia,
        .dashpot = extent->dashpot,
    };
}

/* whether structures that nodes carry are damped */
static int is_lossy(const struct rd_chain *chain)
{
    int any = 0;
    for (size_t k = 0; k < chain->attached; k++)
        any |= chain->attached_value[(k + 1) * RD_ATTACHED_VALUES - 1] != 0.0;
    return any;
}

/* what follows from the scales and the factors of all lanes */
static RD_CLONES void fill(const struct rd_chain *chain, const struct factors *of,
                           struct sweep_block *block, struct sweep_way *way)
{
    const size_t w = chain->width;
    block->bends = chain->coordinate[w - 1] == RD_BETA;
    way[0].backward = 0;
    way[1].backward = 1;
    const lanes last = block->z[w - 1];
    const cv soft = c_inverse(of->section);
    for (size_t i = 0; i < w; i++) {
        const int32_t c = chain->coordinate[i];
        block->channel[i] = rd_channel_of(c);
        block->arm[i] = block->bends && c == RD_Z;
        block->ratio[i] = last / block->z[i];
        way[0].sign[i] = 1.0;
        way[1].sign[i] = c == RD_Z || chain->kind == RD_DIFFERENCE ? 1.0 : -1.0;
        if (c == RD_Z)
            block->slack = times(c_inverse(of->tension), 1.0 / (block->z[i] * block->z[i]));
    }
    block->soft = soft;
    block->tension = of->tension;
    block->spring = of->spring;
    block->inertia = of->inertia;
    block->dashpot = of->dashpot;
    if (block->bends && chain->kind != RD_CONTINUOUS)
        shape_prepare(c_mul(of->tension, soft), &block->series);
    block->real = !some((of->spring.im != 0.0) | (of->inertia.im != 0.0));
    const lane_mask real = (of->section.im == 0.0) & (of->tension.im == 0.0) &
                           (of->spring.im == 0.0) & (of->inertia.im == 0.0);
    block->undamped = rd_chain_is_dragged(chain) || is_lossy(chain) ? (lane_mask){0} : real;
    block->waves = block->undamped & (of->inertia.re <= 0.0) & (of->section.re > 0.0);
    block->pull = times(of->tension, last * last);
    for (size_t i = 0, p = 0; i < w; i++)
        for (size_t j = i; j < w; j++, p++) {
            const lanes zz = block->z[i] * block->z[j];
            block->flex[p] = times(soft, 1.0 / zz);
            for (size_t b = 0; b < 2; b++) {
                const double d = way[b].sign[i] * way[b].sign[j];
                way[b].spring[p] = times(of->spring, zz * d);
                way[b].inertia[p] = times(of->inertia, zz * d);
                if (chain->damping)
                    way[b].dashpot[p] = times(of->dashpot, zz * d);
            }
        }
}

void rd_sweep_scale(const struct rd_chain *chain, const struct rd_runs *runs,
                    const struct rd_factors *factors, const size_t *index,
                    const struct sweep_extent *extent, struct sweep_block *block,
                    struct sweep_way *way)
{
    const size_t w = chain->width;
    struct factors all = {.dashpot = c_zero()};
    for (size_t lane = 0; lane < RD_LANES; lane++) {
        const size_t i = index[lane];
        double z[RD_WIDTH_MAX];
        load(chain, factors, lane, i, &all);
        rd_sweep_receptance(chain, runs, extent + lane, z);
        for (size_t c = 0; c < w; c++)
            block->z[c][lane] = z[c];
    }
    fill(chain, &all, block, way);
}

/* what the nodes of a run, or its own inertia, add to the stiffness per length of each coordinate, and
   of z with beta; sizes */
static double load_of(const struct rd_chain *chain, const struct rd_run *run,
                      const struct sweep_extent *x, double *n)
{
    const size_t w = chain->width, e = (size_t)run->element;
    double turn = 0.0;
    for (size_t i = 0; chain->inertia && i < w; i++)
        n[i] = chain->inertia[e * w + i] * x->inertia +
               (chain->drag ? chain->drag[e * w + i] * x->dashpot : 0.0);
    if (run->term == RD_NO_TERM)
        return turn;
    const double l = chain->length[e];
    const double *m = chain->mass + (size_t)run->term * w * w;
    const double *k = chain->stiffness + (size_t)run->term * w * w;
    const double *d = chain->damping ? chain->damping + (size_t)run->term * w * w : NULL;
    for (size_t i = 0; i < w; i++) {
        n[i] = (fabs(k[i * (w + 1)]) * x->spring + fabs(m[i * (w + 1)]) * x->inertia) / l;
        if (d)
            n[i] += fabs(d[i * (w + 1)]) * x->dashpot / l;
        if (chain->coordinate[i] == RD_Z)
            turn = (fabs(k[i * w + w - 1]) * x->spring + fabs(m[i * w + w - 1]) * x->inertia) / l;
    }
    return turn;
}

/* largest wavenumber of a run: of z with bending from N_zz, N_beta,beta (which acts like a
   compression) and N_z,beta; of the others from their own term */
static double run_wavenumber(const struct rd_chain *chain, const struct rd_run *run,
                             const struct sweep_extent *x)
{
    const size_t w = chain->width, e = (size_t)run->element;
    const double *S = chain->flexibility + 9 * e;
    const int bends = chain->coordinate[w - 1] == RD_BETA;
    double n[RD_WIDTH_MAX] = {0}, most = 0.0;
    const double turn = load_of(chain, run, x, n);
    const double T = rd_blocks_least(chain, e) * x->tension;
    for (size_t i = 0; i < w; i++) {
        const int32_t c = chain->coordinate[i];
        const double s = S[4 * (size_t)rd_channel_of(c)] * x->section;
        if (bends && c == RD_Z) {
            double k2, a2;
            wavenumbers(1.0 / s, T - n[w - 1], n[i], &k2, &a2);
            most = fmax(most, sqrt(k2));
            if (turn > 0.0)
                most = fmax(most, cbrt(turn * s));
            most = fmax(most, 1.2 * sqrt(fmax(-T * s, 0.0)));
        } else if (c == RD_Z) {
            most = fmax(most, sqrt(n[i] / fabs(T)));
        } else if (c != RD_BETA) {
            most = fmax(most, sqrt(n[i] * s));
        }
    }
    return most;
}

struct sweep_waves rd_sweep_waves(const struct rd_chain *chain, const struct rd_run *run,
                                  const struct sweep_extent *extent)
{
    struct sweep_waves waves = {.propagating = run_wavenumber(chain, run, extent)};
    if (chain->inertia) {
        const struct rd_span span = rd_span_of(chain, (size_t)run->element, 1.0 / extent->section,
                                               extent->tension, extent->inertia, extent->dashpot);
        waves.all = rd_span_wavenumber(&span);
    }
    return waves;
}

struct sweep_extent rd_sweep_most(const struct sweep_extent *extent, size_t count)
{
    struct sweep_extent most = extent[0];
    for (size_t i = 1; i < count; i++) {
        most.section = fmax(most.section, extent[i].section);
        most.tension = fmax(most.tension, extent[i].tension);
        most.spring = fmax(most.spring, extent[i].spring);
        most.inertia = fmax(most.inertia, extent[i].inertia);
        most.dashpot = fmax(most.dashpot, extent[i].dashpot);
    }
    return most;
}

struct sweep_pieces rd_sweep_pieces(const struct rd_chain *chain, const struct rd_run *run,
                                    size_t count, struct sweep_waves waves)
{
    struct sweep_pieces pieces = {.count = count};
    double length = chain->length[run->element];
    if (chain->inertia) {
        const double whole = length * waves.all;
        pieces.halvings = rd_span_halvings(whole, count);
        pieces.count = count << pieces.halvings;
        pieces.radians = whole / (double)((size_t)1 << pieces.halvings);
        length /= (double)((size_t)1 << pieces.halvings);
    }
    while (((size_t)2 << pieces.level) <= pieces.count &&
           2.0 * length * waves.propagating <= RADIANS) {
        pieces.level++;
        length *= 2.0;
    }
    return pieces;
}

/* stretch k as a run of its own */
static struct rd_run run_of(const struct rd_chain *chain, size_t k)
{
    return (struct rd_run){.element = chain->element[k],
                           .term = chain->inertia ? RD_NO_TERM : chain->term[k]};
}

/* a block's pieces and the joints that make them */
static size_t graded_steps(const struct rd_chain *chain, size_t e,
                           const struct sweep_extent *extent)
{
    struct rd_block block[RD_BLOCKS_MOST];
    const struct rd_sizes sizes = rd_sweep_sizes(extent);
    const size_t blocks = rd_blocks_of(chain, e, &sizes, false, block);
    size_t steps = 0;
    for (size_t k = 0; k < blocks; k++)
        steps += block[k].pieces + 2 * (size_t)block[k].doublings;
    return steps;
}

size_t rd_sweep_steps(const struct rd_chain *chain, const struct sweep_extent *extent)
{
    size_t steps = 1;
    for (size_t k = 0; k + 1 < chain->stretches; k++) {
        if (rd_is_graded(chain, (size_t)chain->element[k])) {
            steps += graded_steps(chain, (size_t)chain->element[k], extent);
            continue;
        }
        const struct rd_run run = {.element = chain->element[k],
                                   .term = chain->inertia ? RD_NO_TERM : chain->term[k]};
        const struct sweep_pieces pieces = rd_sweep_pieces(chain, &run, rd_stretch_nodes(chain, k),
                                                           rd_sweep_waves(chain, &run, extent));
        steps += (pieces.count >> pieces.level) + 2 * pieces.level;
    }
    return steps;
}

double rd_sweep_turning(const struct rd_chain *chain, const struct sweep_extent *extent)
{
    double radians = RADIANS;
    for (size_t k = 0; k + 1 < chain->stretches; k++) {
        const struct rd_run run = run_of(chain, k);
        const double nodes = (double)rd_stretch_nodes(chain, k),
                     length = chain->length[run.element];
        const double waves = nodes * length * run_wavenumber(chain, &run, extent);
        /* lumps let no waves pass that are shorter than they are apart */
        radians += chain->inertia ? waves + PI : fmin(waves, nodes * PI);
    }
    return radians;
}
