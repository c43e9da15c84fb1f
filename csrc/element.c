/* Elements: massless pieces of rope between two nodes. */
#include "element.h"

#include "dense.h"
#include "triple.h"

#include <assert.h>
#include <math.h>
#include <string.h>

enum { W = RD_WIDTH_MAX };

/* The section force a coordinate's end force causes at the distance s from that end is
   s^power in one channel: axial: F_x; torque: M_alpha; moment: s F_z + M_beta. */
static const int channel[RD_WIDTH_MAX] = {RD_AXIAL, RD_BENDING, RD_TORSION, RD_BENDING};
static const int power[RD_WIDTH_MAX] = {0, 1, 0, 0};

struct rd_element rd_chain_element(const struct rd_chain *chain, size_t i)
{
    assert(i < chain->distinct);
    return (struct rd_element){
        .kind = chain->kind,
        .width = chain->width,
        .coordinate = chain->coordinate,
        .length = chain->length[i],
        .tension = chain->tension[i],
        .flexibility = chain->flexibility + i * RD_CHANNELS * RD_CHANNELS,
    };
}

/* index of a coordinate in the element, or its width where absent */
static size_t find(const struct rd_element *element, enum rd_coordinate coordinate)
{
    size_t i = 0;
    while (i < element->width && element->coordinate[i] != (int32_t)coordinate)
        i++;
    return i;
}

/* a string: z is present and has no bending to carry it */
static bool is_string(const struct rd_element *element)
{
    return find(element, RD_Z) < element->width && find(element, RD_BETA) == element->width;
}

/* integral of (s - r)^m (p - r)^n dr from 0 to min(s, p), m and n 0 or 1 */
static double overlap(double s, int m, double p, int n)
{
    const double e = fmin(s, p);
    if (m == 0 && n == 0)
        return e;
    if (n == 0)
        return e * (s - e / 2);
    if (m == 0)
        return e * (p - e / 2);
    return e * (s * p - (s + p) * e / 2 + e * e / 3);
}

/* G(s, p) = integral P_s^T S P_p dr: displacement at s per force at p of the element held at its
   left node alone. A string's z has no section to bend: its row is zero. */
static void cantilever(const struct rd_element *element, double s, double p, double *G)
{
    const size_t w = element->width;
    const bool string = is_string(element);
    for (size_t i = 0; i < w; i++)
        for (size_t j = 0; j < w; j++) {
            const int32_t a = element->coordinate[i];
            const int32_t b = element->coordinate[j];
            const double S = element->flexibility[channel[a] * RD_CHANNELS + channel[b]];
            const bool absent = string && (a == RD_Z || b == RD_Z);
            G[i * w + j] = absent ? 0 : S * overlap(s, power[a], p, power[b]);
        }
}

/* F(s) = I: the study's kinematics; with the lever z += s beta: a rigid body's */
static void transfer(const struct rd_element *element, double s, double *F)
{
    const size_t w = element->width;
    for (size_t i = 0; i < w * w; i++)
        F[i] = i % (w + 1) == 0;
    const size_t z = find(element, RD_Z);
    const size_t beta = find(element, RD_BETA);
    if (element->kind != RD_DIFFERENCE && z < w && beta < w)
        F[z * w + beta] = s;
}

bool rd_element_grip(const struct rd_element *element, double *F, double *inverse)
{
    transfer(element, element->length, F);
    cantilever(element, element->length, element->length, inverse);
    return rd_dense_invert(element->width, inverse);
}

/* K (2 width, 2 width) <- [[Q + F^T G^-1 F, -F^T G^-1], [-G^-1 F, G^-1]] */
static void assemble(size_t w, const double *F, const double *Gi, const double *Q, double *K)
{
    double Ft[W * W], GiF[W * W], FtGiF[W * W];
    rd_dense_transpose(w, w, F, Ft);
    rd_dense_multiply(w, w, w, Gi, F, GiF);
    rd_dense_multiply(w, w, w, Ft, GiF, FtGiF);
    const size_t n = 2 * w;
    for (size_t i = 0; i < w; i++)
        for (size_t j = 0; j < w; j++) {
            K[i * n + j] = Q[i * w + j] + (FtGiF[i * w + j] + FtGiF[j * w + i]) / 2;
            K[i * n + w + j] = -GiF[j * w + i];
            K[(w + i) * n + j] = -GiF[i * w + j];
            K[(w + i) * n + w + j] = Gi[i * w + j];
        }
}

/* sections and tension are one in a tensed element that bends */
static bool is_inseparable(const struct rd_element *element)
{
    return element->kind == RD_TENSED && find(element, RD_BETA) < element->width;
}

enum rd_status rd_element_stiffness(const struct rd_element *element, double *elastic,
                                    double *tension)
{
    const size_t w = element->width;
    const size_t n = 2 * w;
    double F[W * W], Gi[W * W], Q[W * W] = {0};
    memset(tension, 0, n * n * sizeof *tension);
    if (is_inseparable(element)) {
        const enum rd_status status = rd_triple_real(element, F, Gi, Q);
        if (status != RD_OK)
            return status;
        if (!rd_dense_invert(w, Gi))
            return RD_CRITICAL_ELEMENT;
    } else if (!rd_element_grip(element, F, Gi)) {
        return RD_NOT_POSITIVE_DEFINITE;
    }
    assemble(w, F, Gi, Q, elastic);
    const size_t z = find(element, RD_Z);
    if (z < w && !is_inseparable(element)) {
        const double t = element->tension / element->length;
        tension[z * n + z] = tension[(w + z) * n + w + z] = t;
        tension[z * n + w + z] = tension[(w + z) * n + z] = -t;
    }
    return RD_OK;
}

/* G(s, l) G^-1, with s/l for the z of a string */
static bool tip_share(const struct rd_element *element, double s, double *share)
{
    const size_t w = element->width;
    double G[W * W], Gi[W * W];
    cantilever(element, s, element->length, G);
    cantilever(element, element->length, element->length, Gi);
    if (!rd_dense_invert(w, Gi))
        return false;
    rd_dense_multiply(w, w, w, G, Gi, share);
    const size_t z = find(element, RD_Z);
    if (is_string(element))
        share[z * w + z] = s / element->length;
    return true;
}

/* u(s) = F(s) u_a + G(s, l) G^-1 (u_b - F u_a) */
enum rd_status rd_element_shape(const struct rd_element *element, double s, double *shape)
{
    assert(0 <= s && s <= element->length);
    const size_t w = element->width;
    double F[W * W], Fs[W * W], share[W * W], carried[W * W];
    if (!tip_share(element, s, share))
        return RD_NOT_POSITIVE_DEFINITE;
    transfer(element, element->length, F);
    transfer(element, s, Fs);
    rd_dense_multiply(w, w, w, share, F, carried);
    for (size_t i = 0; i < w; i++)
        for (size_t j = 0; j < w; j++) {
            shape[i * 2 * w + j] = Fs[i * w + j] - carried[i * w + j];
            shape[i * 2 * w + w + j] = share[i * w + j];
        }
    return RD_OK;
}

/* G(s, p) - G(s, l) G^-1 G(l, p); for a string (min(s, p) - s p/l)/T */
enum rd_status rd_element_local(const struct rd_element *element, double s, double p, double *local)
{
    const size_t w = element->width;
    double share[W * W], Glp[W * W], carried[W * W];
    if (!tip_share(element, s, share))
        return RD_NOT_POSITIVE_DEFINITE;
    cantilever(element, s, p, local);
    cantilever(element, element->length, p, Glp);
    rd_dense_multiply(w, w, w, share, Glp, carried);
    for (size_t i = 0; i < w * w; i++)
        local[i] -= carried[i];
    const size_t z = find(element, RD_Z);
    if (is_string(element))
        local[z * w + z] = (fmin(s, p) - s * p / element->length) / element->tension;
    return RD_OK;
}
