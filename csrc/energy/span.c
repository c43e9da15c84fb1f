/* How the form of continuous elements changes with their numbers. */
#include "energy/span.h"

#include "base/complex_step.h"
#include "base/dense.h"

#include <math.h>
#include <stdbool.h>

#pragma GCC diagnostic ignored "-Wpsabi"

enum { W = RD_WIDTH_MAX };

/* The mixed form P = f^T F u_a + (f^T G f - u_a^T Q u_a)/2 of an element has u_b = dP/df and
   f_a = dP/du_a; Pi = 2 (f^T u_b - P) is stationary in f, so that dPi/dp = -2 dP/dp at fixed f. A
   number gets a lane in which it is stepped by i RD_COMPLEX_STEP scale. */
static struct rate_matrix *next(struct rd_wave_slopes *slopes, struct rate_matrix *rate,
                                size_t property, double scale, int *lane)
{
    const size_t k = slopes->count++;
    slopes->at[k] = property;
    slopes->step[k] = -2 / (RD_COMPLEX_STEP * scale);
    *lane = (int)(k % RD_LANES);
    return rate + k / RD_LANES;
}

/* both places of an entry of S, whose size is that of its channels' own */
static void step_section(struct rd_wave_slopes *slopes, struct rate_matrix *rate, size_t i,
                         size_t j)
{
    const struct rd_chain *chain = slopes->chain;
    const double *S = chain->flexibility + slopes->element * RD_CHANNELS * RD_CHANNELS;
    const int c = rd_channel_of(chain->coordinate[i]), d = rd_channel_of(chain->coordinate[j]);
    const double scale = sqrt(S[c * (RD_CHANNELS + 1)]) * sqrt(S[d * (RD_CHANNELS + 1)]);
    int lane;
    struct rate_matrix *in = next(slopes, rate, rd_property_of(c, d), scale, &lane);
    in->S[i][j].im[lane] = in->S[j][i].im[lane] = RD_COMPLEX_STEP * scale;
    in->elastic[i][j] = in->elastic[j][i] = 1;
}

/* a rigid element is a beam beside a string, which is not here */
static bool is_beam(const struct rd_chain *chain)
{
    return chain->kind == RD_RIGID && chain->coordinate[chain->width - 1] == RD_BETA;
}

/* T stands in q of beta, of a string as 1/T in S */
static void step_tension(struct rd_wave_slopes *slopes, struct rate_matrix *rate)
{
    const struct rd_chain *chain = slopes->chain;
    const size_t z = rd_coordinate_find(chain->width, chain->coordinate, RD_Z);
    int lane;
    if (z == chain->width || is_beam(chain))
        return;
    const bool string = rate->z < 0;
    const double scale = string ? chain->tension[slopes->element] : 1;
    struct rate_matrix *in = next(slopes, rate, RD_OF_TENSION, scale, &lane);
    if (string)
        in->S[z][z].im[lane] = -RD_COMPLEX_STEP * in->S[z][z].re[lane];
    else
        in->q[chain->width - 1].im[lane] = RD_COMPLEX_STEP;
}

/* lambda p stands in q = -lambda p */
static void step_inertia(struct rd_wave_slopes *slopes, struct rate_matrix *rate, size_t i)
{
    int lane;
    struct rate_matrix *in = next(slopes, rate, RD_OF_INERTIA + i, -1, &lane);
    in->q[i].im[lane] = -RD_COMPLEX_STEP;
}

static void step_sag(struct rd_wave_slopes *slopes, struct rate_matrix *rate)
{
    int lane;
    if (!rate->hangs)
        return;
    struct rate_matrix *in = next(slopes, rate, RD_OF_SAG, 1, &lane);
    in->sag.im[lane] = RD_COMPLEX_STEP;
}

static void step_all(struct rd_wave_slopes *slopes, struct rate_matrix *rate)
{
    const struct rd_chain *chain = slopes->chain;
    slopes->count = 0;
    for (size_t i = 0; i < chain->width; i++)
        for (size_t j = 0; j <= i; j++)
            if (chain->coordinate[i] != RD_Z && chain->coordinate[j] != RD_Z)
                step_section(slopes, rate, i, j);
    step_tension(slopes, rate);
    step_sag(slopes, rate);
    for (size_t i = 0; chain->inertia && i < chain->width; i++)
        step_inertia(slopes, rate, i);
}

enum rd_status rd_wave_slopes_of(const struct rd_chain *chain, size_t e, double lambda,
                                 struct rd_wave_slopes *slopes)
{
    const size_t w = chain->width;
    struct rate_matrix rate[RD_SLOPE_GROUPS];
    slopes->chain = chain;
    slopes->element = e;
    for (int g = 0; g < RD_SLOPE_GROUPS; g++)
        rd_rate_fill(chain, e, c_real(1), c_real(!is_beam(chain)), c_real(-lambda), c_zero(),
                     rate + g);
    slopes->rate = rate[0];
    step_all(slopes, rate);
    for (size_t g = 0; g * RD_LANES < slopes->count; g++)
        rd_transfer_fill(chain, e, rate + g, slopes->transfer + g);
    for (size_t i = 0; i < w * w; i++) {
        slopes->F[i] = creal(slopes->transfer[0].F[0][i]);
        slopes->G[i] = slopes->stiff[i] = creal(slopes->transfer[0].G[0][i]);
        slopes->Q[i] = creal(slopes->transfer[0].Q[0][i]);
    }
    return rd_dense_invert(w, slopes->stiff) ? RD_OK : RD_NOT_POSITIVE_DEFINITE;
}

/* f_b = G^-1 (u_b - F u_a) and f_a = F^T f_b - Q u_a */
static void forces(const struct rd_wave_slopes *slopes, const double *u, double *fb, double *fa)
{
    const size_t w = slopes->chain->width;
    double left[W];
    for (size_t i = 0; i < w; i++) {
        left[i] = u[w + i];
        for (size_t j = 0; j < w; j++)
            left[i] -= slopes->F[i * w + j] * u[j];
    }
    for (size_t i = 0; i < w; i++) {
        fb[i] = 0;
        for (size_t j = 0; j < w; j++)
            fb[i] += slopes->stiff[i * w + j] * left[j];
    }
    for (size_t i = 0; i < w; i++) {
        fa[i] = 0;
        for (size_t j = 0; j < w; j++)
            fa[i] += slopes->F[j * w + i] * fb[j] - slopes->Q[i * w + j] * u[j];
    }
}

/* Without a jump f_a would be m, each radian of it takes k = (F^T G^-1 F + Q)_ee away, so that it is
   C m/(1 + C k), m/k where the hinge is free. */
void rd_wave_slopes_open(const struct rd_wave_slopes *slopes, const double *hinge, double *u,
                         double *jump)
{
    const size_t w = slopes->chain->width;
    for (size_t e = 0; hinge && e < w; e++) {
        if (hinge[e] == 0)
            continue;
        double fb[W], fa[W], k = slopes->Q[e * (w + 1)];
        forces(slopes, u, fb, fa);
        for (size_t i = 0; i < w; i++)
            for (size_t j = 0; j < w; j++)
                k += slopes->F[i * w + e] * slopes->stiff[i * w + j] * slopes->F[j * w + e];
        const double opens = isinf(hinge[e]) ? fa[e] / k : hinge[e] * fa[e] / (1 + hinge[e] * k);
        u[e] += opens;
        jump[e] += opens * opens;
    }
}

/* imaginary part of P in a lane */
static double imaginary(const struct rd_transfer *t, int lane, size_t w, const double *u,
                        const double *f)
{
    double sum = 0;
    for (size_t i = 0; i < w; i++)
        for (size_t j = 0; j < w; j++) {
            const size_t at = i * w + j;
            sum += f[i] * cimag(t->F[lane][at]) * u[j];
            sum += (f[i] * cimag(t->G[lane][at]) * f[j] - u[i] * cimag(t->Q[lane][at]) * u[j]) / 2;
        }
    return sum;
}

/* dP/dl = f^T Phi u + (f^T S' f - u^T q u)/2, the same everywhere along the element */
static double by_length(const struct rd_wave_slopes *slopes, const double *u, const double *f)
{
    const struct rate_matrix *rate = &slopes->rate;
    const size_t w = slopes->chain->width;
    double sum = rate->z >= 0 ? f[rate->z] * rate->lever[0] * u[w - 1] : 0;
    sum += rate->hangs ? f[0] * rate->sag.re[0] * u[1] : 0;
    for (size_t i = 0; i < w; i++) {
        sum -= rate->q[i].re[0] * u[i] * u[i] / 2;
        for (size_t j = 0; j < w; j++)
            sum += f[i] * rate->S[i][j].re[0] * f[j] / 2;
    }
    return sum;
}

void rd_wave_slopes_add(const struct rd_wave_slopes *slopes, const double *u, double *slope)
{
    const size_t w = slopes->chain->width;
    double fb[W], fa[W];
    forces(slopes, u, fb, fa);
    for (size_t k = 0; k < slopes->count; k++)
        slope[slopes->at[k]] += slopes->step[k] * imaginary(slopes->transfer + k / RD_LANES,
                                                            (int)(k % RD_LANES), w, u, fb);
    slope[RD_OF_LENGTH] -= 2 * by_length(slopes, u, fa);
}
