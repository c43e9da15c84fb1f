/* The transfer of a strongly compressed element, without the poles of its cantilever. */
#include "element/strut.h"

#include "element/triple.h"

#include <math.h>
#include <string.h>

enum { BB = RD_BENDING * RD_CHANNELS + RD_BENDING };

static double compression(const struct rd_element *element)
{
    return -element->tension * element->flexibility[BB] * element->length * element->length;
}

bool rd_element_is_strut(const struct rd_element *element)
{
    return element->kind != RD_DIFFERENCE && rd_element_find(element, RD_BETA) < element->width &&
           compression(element) > 1;
}

/* of the beam in (z, beta): K_aa, K_ba and P = K_bb - G^-1 */
struct beam {
    double aa[2][2], ba[2][2], P[2][2];
};

/* zz, zb, bb: shear and moment at an end for its own z and beta; bc: moment for the other's beta */
static struct beam beam_of(double zz, double zb, double bb, double bc, double B, double l)
{
    return (struct beam){
        .aa = {{zz, zb}, {zb, bb}},
        .ba = {{-zz, -zb}, {zb, bc}},
        .P = {{zz - 12 * B / (l * l * l), -zb + 6 * B / (l * l)},
              {-zb + 6 * B / (l * l), bb - 4 * B / l}},
    };
}

/* rigid: the string T/l beside the untensed beam */
static struct beam string_beside(const struct rd_element *element)
{
    const double l = element->length;
    const double B = 1 / element->flexibility[BB];
    const double k = element->tension / l;
    struct beam beam =
        beam_of(12 * B / (l * l * l) + k, 6 * B / (l * l), 4 * B / l, 2 * B / l, B, l);
    beam.P[0][0] = k;
    beam.P[0][1] = beam.P[1][0] = beam.P[1][1] = 0;
    return beam;
}

/* tensed, t^2 = -T l^2/B, d = 2 (1 - cos t) - t sin t = 4 sin(t/2) (sin(t/2) - (t/2) cos(t/2)):
       zz = B/l^3 t^3 sin t/d, zb = B/l^2 t^2 (1 - cos t)/d, bb = B/l t (sin t - t cos t)/d,
       bc = B/l t (t - sin t)/d */
static struct beam column(const struct rd_element *element)
{
    const double l = element->length;
    const double B = 1 / element->flexibility[BB];
    const double t = sqrt(compression(element));
    const double s = sin(t / 2), c = cos(t / 2);
    const double d = 4 * s * (s - t / 2 * c);
    return beam_of(B / (l * l * l) * t * t * t * 2 * s * c / d, B / (l * l) * t * t * 2 * s * s / d,
                   B / l * t * (sin(t) - t * cos(t)) / d, B / l * t * (t - sin(t)) / d, B, l);
}

/* f = -G K_ba and q = K_aa - K_ab G K_ba = K_aa + K_ab f, G untensed */
static void condense(const struct beam *beam, const double G[2][2], double f[2][2], double q[2][2])
{
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 2; j++)
            f[i][j] = -(G[i][0] * beam->ba[0][j] + G[i][1] * beam->ba[1][j]);
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 2; j++)
            q[i][j] = beam->aa[i][j] + beam->ba[0][i] * f[0][j] + beam->ba[1][i] * f[1][j];
}

/* The other channels follow the rotation: u_i,b = u_i,a + r_i (beta_b - beta_a) + their own
   flexibility, r_i = S_ib/S_bb, so that D_i = r_i D_beta; G is the untensed one as a whole. */
enum rd_status rd_strut_fill(const struct rd_element *element, double *D, double *G, double *Q,
                             double *P)
{
    const size_t w = element->width;
    const size_t z = rd_element_find(element, RD_Z), beta = rd_element_find(element, RD_BETA);
    struct rd_element untensed = *element;
    untensed.tension = 0;
    const enum rd_status status = rd_triple_change(&untensed, D, G, Q);
    if (status != RD_OK)
        return status;
    const struct beam beam = element->kind == RD_RIGID ? string_beside(element) : column(element);
    const double g[2][2] = {{G[z * w + z], G[z * w + beta]}, {G[beta * w + z], G[beta * w + beta]}};
    double f[2][2], q[2][2];
    condense(&beam, g, f, q);
    if (!isfinite(f[0][0]) || !isfinite(q[1][1]))
        return RD_CRITICAL_ELEMENT;
    memset(D, 0, w * w * sizeof *D);
    memset(Q, 0, w * w * sizeof *Q);
    memset(P, 0, w * w * sizeof *P);
    const size_t at[2] = {z, beta};
    for (int j = 0; j < 2; j++)
        for (size_t i = 0; i < w; i++) {
            const int c = rd_channel_of(element->coordinate[i]);
            const double r =
                element->flexibility[c * RD_CHANNELS + RD_BENDING] / element->flexibility[BB];
            D[i * w + at[j]] = i == z ? f[0][j] - (j == 0) : r * (f[1][j] - (j == 1));
        }
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 2; j++) {
            Q[at[i] * w + at[j]] = (q[i][j] + q[j][i]) / 2;
            P[at[i] * w + at[j]] = beam.P[i][j];
        }
    return RD_OK;
}
