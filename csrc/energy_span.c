/* Strain and kinetic energy of the modes of continuous spans, by what stores it. */
#include "energy_span.h"

#include "dense.h"
#include "transfer.h"

#include <math.h>
#include <string.h>

#pragma GCC diagnostic ignored "-Wpsabi"

enum { W = RD_WIDTH_MAX, STORES = RD_STRAINS + 2 * RD_WIDTH_MAX, GROUPS = 2 };

/* size of an imaginary step: its square is nothing beside 1, so derivatives are exact */
static const double STEP = 0x1p-200;

/* What may store energy: an entry of the section, the tension, or the inertia of a coordinate; the
   mixed form P = f^T F u_a + (f^T G f - u_a^T Q u_a)/2 of an element is stationary, so that twice
   the energy is 2 S dP/dS, -2 T dP/dT, and of inertia p 2 p dP/d(lambda p); of drag likewise. */
struct store {
    double *energy; /* where it is added */
    double factor;
};

struct rope {
    const struct rd_chain *chain;
    size_t e, stores;
    struct store store[STORES];
    struct rd_transfer transfer[GROUPS];
    double F[W * W], G[W * W], inverse[W * W], Q[W * W];
};

/* the strain that the section's entry of two channels stores */
static enum rd_strain strain_of(size_t c, size_t d)
{
    if (c != d)
        return RD_STRAIN_LAY;
    return c == RD_BENDING   ? RD_STRAIN_BENDING
           : c == RD_TORSION ? RD_STRAIN_TWIST
                             : RD_STRAIN_STRETCH;
}

/* an imaginary step in all entries of the section that one strain belongs to */
static bool step_section(const struct rd_chain *chain, enum rd_strain strain, int lane,
                         struct rate_matrix *rate)
{
    bool any = false;
    for (size_t i = 0; i < chain->width; i++)
        for (size_t j = 0; j < chain->width; j++) {
            const size_t c = (size_t)rd_channel_of(chain->coordinate[i]);
            const size_t d = (size_t)rd_channel_of(chain->coordinate[j]);
            if (chain->coordinate[i] == RD_Z || chain->coordinate[j] == RD_Z ||
                !rate->elastic[i][j] || strain_of(c, d) != strain)
                continue;
            rate->S[i][j].im[lane] = STEP * rate->S[i][j].re[lane];
            any = true;
        }
    return any;
}

static bool step_tension(const struct rope *rope, int lane, struct rate_matrix *rate)
{
    const size_t w = rope->chain->width;
    const double T = rope->chain->tension[rope->e];
    if (rate->z >= 0)
        rate->q[w - 1].im[lane] += STEP * T;
    for (size_t i = 0; rate->z < 0 && i < w; i++)
        if (rope->chain->coordinate[i] == RD_Z)
            rate->S[i][i].im[lane] = -STEP * rate->S[i][i].re[lane];
    return T != 0;
}

/* an imaginary step in what is p per length of a coordinate, in lane n */
static bool step_load(double p, size_t i, size_t n, struct rate_matrix *rate)
{
    if (p != 0)
        rate[n / RD_LANES].q[i].im[n % RD_LANES] -= STEP * p;
    return p != 0;
}

/* the energies of an element, a lane each */
static void prepare(const struct rd_chain *chain, size_t e, double lambda, double *strain,
                    double *kinetic, double *dragged, struct rope *rope)
{
    const size_t w = chain->width;
    struct rate_matrix rate[GROUPS];
    size_t n = 0;
    *rope = (struct rope){.chain = chain, .e = e};
    for (int g = 0; g < GROUPS; g++)
        rd_rate_fill(chain, e, c_real(1), c_real(1), c_real(-lambda), c_zero(), rate + g);
    for (int s = RD_STRAIN_BENDING; s <= RD_STRAIN_TENSION; s++) {
        const int lane = (int)(n % RD_LANES);
        struct rate_matrix *of = rate + n / RD_LANES;
        const bool any = s == RD_STRAIN_TENSION ? step_tension(rope, lane, of)
                                                : step_section(chain, (enum rd_strain)s, lane, of);
        if (any)
            rope->store[n++] = (struct store){strain + s, s == RD_STRAIN_TENSION ? -2 : 2};
    }
    for (size_t i = 0; i < w; i++) {
        if (step_load(chain->inertia[e * w + i], i, n, rate))
            rope->store[n++] = (struct store){kinetic + i, 2};
        if (chain->drag && step_load(chain->drag[e * w + i], i, n, rate))
            rope->store[n++] = (struct store){dragged, 2};
    }
    rope->stores = n;
    for (size_t g = 0; g * RD_LANES < n; g++)
        rd_transfer_fill(chain, e, rate + g, rope->transfer + g);
}

static enum rd_status set_element(struct rope *rope)
{
    const size_t full = rope->chain->width * rope->chain->width;
    for (size_t i = 0; i < full; i++) {
        rope->F[i] = creal(rope->transfer[0].F[0][i]);
        rope->G[i] = rope->inverse[i] = creal(rope->transfer[0].G[0][i]);
        rope->Q[i] = creal(rope->transfer[0].Q[0][i]);
    }
    return rd_dense_invert(rope->chain->width, rope->inverse) ? RD_OK : RD_NOT_POSITIVE_DEFINITE;
}

/* f_b = G^-1 (u_b - F u_a) and f_a = F^T f_b - Q u_a */
static void forces(const struct rope *rope, const double *u, double *fb, double *fa)
{
    const size_t w = rope->chain->width;
    double left[W];
    for (size_t i = 0; i < w; i++) {
        left[i] = u[w + i];
        for (size_t j = 0; j < w; j++)
            left[i] -= rope->F[i * w + j] * u[j];
    }
    for (size_t i = 0; i < w; i++) {
        fb[i] = 0;
        for (size_t j = 0; j < w; j++)
            fb[i] += rope->inverse[i * w + j] * left[j];
    }
    for (size_t i = 0; i < w; i++) {
        fa[i] = 0;
        for (size_t j = 0; j < w; j++)
            fa[i] += rope->F[j * w + i] * fb[j] - rope->Q[i * w + j] * u[j];
    }
}

/* Moves u_a across the hinges C of the left node: without a jump f_a would be m, each radian of it
   takes k = (F^T G^-1 F + Q)_ee away, so that it is C m/(1 + C k), m/k where the hinge is free.
   Returns twice the energy of their springs. */
static double open_hinges(const struct rope *rope, const double *hinge, double *u)
{
    const size_t w = rope->chain->width;
    double energy = 0;
    for (size_t e = 0; hinge && e < w; e++) {
        if (hinge[e] == 0)
            continue;
        double fb[W], fa[W], k = rope->Q[e * (w + 1)];
        forces(rope, u, fb, fa);
        for (size_t i = 0; i < w; i++)
            for (size_t j = 0; j < w; j++)
                k += rope->F[i * w + e] * rope->inverse[i * w + j] * rope->F[j * w + e];
        const double jump = isinf(hinge[e]) ? fa[e] / k : hinge[e] * fa[e] / (1 + hinge[e] * k);
        u[e] += jump;
        energy += jump * (jump / hinge[e]);
    }
    return energy;
}

/* imaginary part of P in a lane, by the step */
static double slope(const struct rd_transfer *t, int lane, size_t w, const double *u,
                    const double *f)
{
    double sum = 0;
    for (size_t i = 0; i < w; i++)
        for (size_t j = 0; j < w; j++) {
            const size_t at = i * w + j;
            sum += f[i] * cimag(t->F[lane][at]) * u[j];
            sum += (f[i] * cimag(t->G[lane][at]) * f[j] - u[i] * cimag(t->Q[lane][at]) * u[j]) / 2;
        }
    return sum / STEP;
}

/* the elements of a stretch */
static void add_stretch(const struct rope *rope, size_t k, const double *shape, double *strain)
{
    const struct rd_chain *chain = rope->chain;
    const size_t w = chain->width;
    const double *hinge = chain->hinge ? chain->hinge + (size_t)chain->term[k] * w : NULL;
    for (size_t i = (size_t)chain->first[k]; i < (size_t)chain->first[k + 1]; i++) {
        double u[2 * W], fb[W], fa[W];
        memcpy(u, shape + i * w, 2 * w * sizeof *u);
        strain[RD_STRAIN_SPRING] += open_hinges(rope, hinge, u);
        forces(rope, u, fb, fa);
        for (size_t s = 0; s < rope->stores; s++)
            *rope->store[s].energy += rope->store[s].factor * slope(rope->transfer + s / RD_LANES,
                                                                    (int)(s % RD_LANES), w, u, fb);
    }
}

enum rd_status rd_energy_span(const struct rd_chain *chain, double lambda, const double *shape,
                              double *strain, double *kinetic, double *dragged)
{
    struct rope rope;
    size_t made = chain->distinct;
    memset(strain, 0, RD_STRAINS * sizeof *strain);
    rd_energy_kinetic(chain, shape, kinetic);
    *dragged = rd_energy_dashpots(chain, shape);
    for (size_t k = 0; k + 1 < chain->stretches; k++) {
        if ((size_t)chain->element[k] != made) {
            made = (size_t)chain->element[k];
            prepare(chain, made, lambda, strain, kinetic, dragged, &rope);
            const enum rd_status status = set_element(&rope);
            if (status != RD_OK)
                return status;
        }
        add_stretch(&rope, k, shape, strain);
    }
    strain[RD_STRAIN_SPRING] += rd_energy_springs(chain, shape);
    return RD_OK;
}
