/* Stiffness and static shapes of an element between two nodes. */
#include "element/stiffness.h"

#include "base/dense.h"
#include "element/area.h"
#include "element/cantilever.h"
#include "element/rods.h"

#include <assert.h>
#include <math.h>
#include <string.h>

enum { W = RD_WIDTH_MAX, N = 2 * RD_WIDTH_MAX };

/* The section force a coordinate's end force causes at the distance s from that end is
   s^power in its channel: axial: F_x; torque: M_alpha; moment: s F_z + M_beta. */
static const int power[RD_WIDTH_MAX] = {0, 1, 0, 0};

/* a string: z is present and has no bending to carry it */
static bool is_string(const struct rd_element *element)
{
    return rd_element_find(element, RD_Z) < element->width &&
           rd_element_find(element, RD_BETA) == element->width;
}

/* sections and tension shape it together */
static bool is_tensed_beam(const struct rd_element *element)
{
    return element->kind == RD_TENSED && rd_element_find(element, RD_BETA) < element->width;
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
            const double S =
                element->flexibility[rd_channel_of(a) * RD_CHANNELS + rd_channel_of(b)];
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
    const size_t z = rd_element_find(element, RD_Z);
    const size_t beta = rd_element_find(element, RD_BETA);
    if (element->kind != RD_DIFFERENCE && z < w && beta < w)
        F[z * w + beta] = s;
}

/* K (n, n) <- K + k v v^T, symmetric to the last bit where each v is 0, +-1 or one other number */
static void add_square(size_t n, double _Complex k, const double *v, double _Complex *K)
{
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < n; j++)
            K[i * n + j] += k * v[i] * v[j];
}

/* row (2 width) += factor (u_b - u_a) of coordinate i */
static void add_change(size_t w, size_t i, double factor, double *row)
{
    row[i] -= factor;
    row[w + i] += factor;
}

/* Rope that hangs is longer by w/T times the area a under z, and h along it loads it by (w/T) h: with
   both ends held (element/area.h)

       row of x -= (w/T) a (u_a, u_b),  k^-1 of x += (w/T)^2 a(1) section

   of the rods' stiffness k section, k (rods, rods), x being the first of them. */
static void hang(const struct rd_element *element, double _Complex section, double _Complex tension,
                 size_t rods, double _Complex *row, double _Complex *k)
{
    const size_t w = element->width, beta = rd_element_find(element, RD_BETA);
    const double l = element->length, sag = element->sag;
    double _Complex yield = sag * sag * l * l * l * section / (12 * element->tension * tension);
    row[RD_Z] -= sag * l / 2;
    row[w + RD_Z] -= sag * l / 2;
    if (beta < w) {
        const double soft = element->flexibility[RD_BENDING * (RD_CHANNELS + 1)] * l * l;
        const struct rd_area_held a = rd_area_held_at(
            element->kind == RD_TENSED ? element->tension * soft * tension / section : 0);
        row[beta] -= sag * l * l * a.lean;
        row[w + beta] += sag * l * l * a.lean;
        yield = sag * sag * soft * l * l * l * a.load;
    }
    const double _Complex share = yield / (1 + yield * k[0]);
    double _Complex pull[2];
    memcpy(pull, k, rods * sizeof *pull);
    for (size_t i = 0; i < rods; i++)
        for (size_t j = 0; j < rods; j++)
            k[i * rods + j] -= pull[i] * pull[j] * share;
}

/* K += e^T S^^-1 e section/l of torque and axial force, see element/rods.h */
static bool add_rods(const struct rd_element *element, double _Complex section,
                     double _Complex tension, double _Complex *K)
{
    const size_t w = element->width;
    struct rd_rods rods;
    double _Complex motion[2][N], k[4];
    if (rd_rods_of(element, &rods) != RD_OK)
        return false;
    for (size_t i = 0; i < rods.count; i++) {
        double change[N] = {0};
        add_change(w, rods.at[i], 1, change);
        if (rods.r[i] != 0)
            add_change(w, w - 1, -rods.r[i], change);
        for (size_t p = 0; p < 2 * w; p++)
            motion[i][p] = change[p];
    }
    for (size_t i = 0; i < rods.count * rods.count; i++)
        k[i] = rods.inverse[i] / element->length;
    if (element->sag != 0)
        hang(element, section, tension, rods.count, motion[0], k);
    for (size_t i = 0; i < rods.count; i++)
        for (size_t j = 0; j < rods.count; j++)
            for (size_t p = 0; p < 2 * w; p++)
                for (size_t q = 0; q < 2 * w; q++)
                    K[p * 2 * w + q] +=
                        section * k[i * rods.count + j] * (motion[i][p] * motion[j][q]);
    return true;
}

/* The element bends symmetrically by delta = beta_b - beta_a and antisymmetrically by
   sigma = z_b - z_a - (beta_b + beta_a) l/2 (the study's: - (beta_b - beta_a) l/2). Each half is a
   cantilever of theta/4 loaded by a moment alone or by a force alone:

       K += (delta^2/tau + (2 sigma/l)^2 tau/P2) section/(S_bb l)

   with tau = 1, P2 = 1/3 where the tension is a string beside the element. The poles are the
   buckling loads of the element held at both ends; none where it is critical as a cantilever.
   The levers l/2 multiply one rounded force, so that turning the element as a whole costs no more
   than its last bit: n^4 times that is what an assembled chain loses. */
static bool add_bending(const struct rd_element *element, double _Complex section,
                        double _Complex tension, double _Complex *K)
{
    const size_t w = element->width, z = rd_element_find(element, RD_Z), beta = w - 1;
    const double l = element->length;
    const double Sbb = element->flexibility[RD_BENDING * (RD_CHANNELS + 1)];
    if (!(Sbb > 0))
        return false;
    struct rd_cantilever half = {.tau = 1, .P = {1, 1.0 / 2, 1.0 / 3}};
    if (element->kind == RD_TENSED)
        half =
            rd_cantilever_at(RD_TENSED, element->tension * Sbb * l * l * tension / (4 * section));
    double delta[N] = {0}, sigma[N] = {0};
    add_change(w, beta, 1, delta);
    add_change(w, z, 1, sigma);
    sigma[beta] = element->kind == RD_DIFFERENCE ? l / 2 : -l / 2;
    sigma[w + beta] = -l / 2;
    add_square(2 * w, section / (Sbb * l) / half.tau, delta, K);
    add_square(2 * w, 4 * section / (Sbb * l * l * l) * (half.tau / half.P[2]), sigma, K);
    return true;
}

static void add_string(const struct rd_element *element, double _Complex tension,
                       double _Complex *K)
{
    const size_t w = element->width, z = rd_element_find(element, RD_Z);
    double change[N] = {0};
    if (z == w)
        return;
    add_change(w, z, 1, change);
    add_square(2 * w, element->tension * tension / element->length, change, K);
}

/* A hinge opens between the left node and the element by jump = -share row u. */
struct opening {
    size_t coordinate;
    double _Complex share, row[N];
};

/* Opens the hinge of a coordinate in K, with C its compliance and k the row of the coordinate:
   K <- K - k^T k C/(1 + C K_ee), 1/K_ee where free. False where there is nothing to open. */
static bool open_hinge(const struct rd_element *element, size_t e, double _Complex spring,
                       double _Complex *K, struct opening *opening)
{
    const size_t n = 2 * element->width;
    const double _Complex own = K[e * n + e];
    if (!element->hinge || element->hinge[e] == 0 || own == 0)
        return false;
    const bool free = isinf(element->hinge[e]);
    const double _Complex C = free ? 0 : element->hinge[e] / spring;
    const double _Complex kept = free ? 0 : 1 / (1 + C * own);
    opening->coordinate = e;
    opening->share = free ? 1 / own : C * kept;
    memcpy(opening->row, K + e * n, n * sizeof *K);
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < n; j++)
            if (i == e || j == e)
                K[i * n + j] *= kept;
            else
                K[i * n + j] -= opening->share * opening->row[i] * opening->row[j];
    return true;
}

/* rows (count, 2 width) over the motion of the element itself <- over that of its nodes */
static void follow(const struct rd_element *element, const struct opening *opening, size_t count,
                   double *rows)
{
    const size_t n = 2 * element->width;
    for (size_t r = 0; r < count; r++) {
        const double jump = creal(opening->share) * rows[r * n + opening->coordinate];
        for (size_t j = 0; j < n; j++)
            rows[r * n + j] -= jump * creal(opening->row[j]);
    }
}

/* without its hinge */
static enum rd_status closed_matrix(const struct rd_element *element, double _Complex section,
                                    double _Complex tension, double _Complex *K)
{
    const size_t w = element->width;
    memset(K, 0, 4 * w * w * sizeof *K);
    if (!add_rods(element, section, tension, K))
        return RD_NOT_POSITIVE_DEFINITE;
    if (rd_element_find(element, RD_BETA) < w && !add_bending(element, section, tension, K))
        return RD_NOT_POSITIVE_DEFINITE;
    add_string(element, tension, K);
    return RD_OK;
}

enum rd_status rd_element_matrix(const struct rd_element *element, double _Complex section,
                                 double _Complex tension, double _Complex spring,
                                 double _Complex *K)
{
    const size_t w = element->width;
    const enum rd_status status = closed_matrix(element, section, tension, K);
    struct opening opening;
    for (size_t e = 0; e < w; e++)
        open_hinge(element, e, spring, K, &opening);
    for (size_t i = 0; i < 4 * w * w; i++)
        if (status == RD_OK && !(isfinite(creal(K[i])) && isfinite(cimag(K[i]))))
            return RD_CRITICAL_ELEMENT;
    return status;
}

/* sections and tension are one in a tensed element that bends, where a hinge opens in z, and in a
   string that hangs */
static bool is_inseparable(const struct rd_element *element)
{
    const size_t z = rd_element_find(element, RD_Z);
    const bool opens = element->hinge && z < element->width && element->hinge[z] != 0;
    return opens || (element->sag != 0 && is_string(element)) || is_tensed_beam(element);
}

enum rd_status rd_element_stiffness(const struct rd_element *element, double *elastic,
                                    double *tension)
{
    const size_t entries = 4 * element->width * element->width;
    const bool apart = !is_inseparable(element);
    double _Complex K[N * N], T[N * N] = {0};
    enum rd_status status = rd_element_matrix(element, 1, apart ? 0 : 1, 1, K);
    if (status == RD_OK && apart)
        status = rd_element_matrix(element, 0, 1, 1, T);
    for (size_t i = 0; i < entries; i++) {
        elastic[i] = creal(K[i]);
        tension[i] = creal(T[i]);
    }
    return status;
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
    const size_t z = rd_element_find(element, RD_Z);
    if (is_string(element))
        share[z * w + z] = s / element->length;
    return true;
}

/* block (i, j) of the matrix of a part of the element, added to K (width, width) */
static void add_block(size_t w, const double _Complex *part, size_t i, size_t j, double *K)
{
    for (size_t k = 0; k < w; k++)
        for (size_t m = 0; m < w; m++)
            K[k * w + m] += creal(part[(i * w + k) * 2 * w + j * w + m]);
}

/* A node at s, 0 < s < l, yields by the inverse of what both parts hold it with and moves by that
   times what they pull it with, as shape (width, 2 width), which may be NULL. */
static bool parted(const struct rd_element *element, double s, double *yields, double *shape)
{
    const size_t w = element->width;
    double _Complex left[N * N], right[N * N];
    double pulled[2][W * W] = {0}, moved[W * W];
    struct rd_element part = *element;
    part.length = s;
    if (closed_matrix(&part, 1, 1, left) != RD_OK)
        return false;
    part.length = element->length - s;
    if (closed_matrix(&part, 1, 1, right) != RD_OK)
        return false;
    memset(yields, 0, w * w * sizeof *yields);
    add_block(w, left, 1, 1, yields);
    add_block(w, right, 0, 0, yields);
    if (!rd_dense_invert(w, yields))
        return false;
    add_block(w, left, 1, 0, pulled[0]);
    add_block(w, right, 0, 1, pulled[1]);
    for (size_t end = 0; shape && end < 2; end++) {
        rd_dense_multiply(w, w, w, yields, pulled[end], moved);
        for (size_t i = 0; i < w; i++)
            for (size_t j = 0; j < w; j++)
                shape[(i * 2 + end) * w + j] = -moved[i * w + j];
    }
    return true;
}

/* the shape at a node */
static void at_node(size_t w, size_t end, double *shape)
{
    memset(shape, 0, 2 * w * w * sizeof *shape);
    for (size_t i = 0; i < w; i++)
        shape[(i * 2 + end) * w + i] = 1;
}

/* shape of a tensed beam without the hinge */
static bool beam_shape(const struct rd_element *element, double s, double *shape)
{
    double yields[W * W];
    if (s > 0 && s < element->length)
        return parted(element, s, yields, shape);
    at_node(element->width, s > 0, shape);
    return true;
}

/* its local flexibility: the node further right yields and takes the other along */
static bool beam_local(const struct rd_element *element, double s, double p, double *local)
{
    const size_t w = element->width;
    const double first = fmin(s, p), last = fmax(s, p);
    double yields[W * W], shape[W * N], share[W * W], along[W * W];
    memset(local, 0, w * w * sizeof *local);
    if (first <= 0 || last >= element->length)
        return true;
    struct rd_element part = *element;
    part.length = last;
    if (!parted(element, last, yields, NULL) || !beam_shape(&part, first, shape))
        return false;
    for (size_t i = 0; i < w; i++)
        memcpy(share + i * w, shape + (i * 2 + 1) * w, w * sizeof *share);
    rd_dense_multiply(w, w, w, share, yields, along);
    if (s <= p)
        memcpy(local, along, w * w * sizeof *local);
    else
        rd_dense_transpose(w, w, along, local);
    return true;
}

/* shape without the hinge: u(s) = F(s) u_a + G(s, l) G^-1 (u_b - F u_a) */
static bool closed_shape(const struct rd_element *element, double s, double *shape)
{
    const size_t w = element->width;
    double F[W * W], Fs[W * W], share[W * W], carried[W * W];
    if (is_tensed_beam(element))
        return beam_shape(element, s, shape);
    if (!tip_share(element, s, share))
        return false;
    transfer(element, element->length, F);
    transfer(element, s, Fs);
    rd_dense_multiply(w, w, w, share, F, carried);
    for (size_t i = 0; i < w; i++)
        for (size_t j = 0; j < w; j++) {
            shape[i * 2 * w + j] = Fs[i * w + j] - carried[i * w + j];
            shape[i * 2 * w + w + j] = share[i * w + j];
        }
    return true;
}

/* local flexibility without the hinge: G(s, p) - G(s, l) G^-1 G(l, p); for a string
   (min(s, p) - s p/l)/T */
static bool closed_local(const struct rd_element *element, double s, double p, double *local)
{
    const size_t w = element->width;
    double share[W * W], Glp[W * W], carried[W * W];
    if (is_tensed_beam(element))
        return beam_local(element, s, p, local);
    if (!tip_share(element, s, share))
        return false;
    cantilever(element, s, p, local);
    cantilever(element, element->length, p, Glp);
    rd_dense_multiply(w, w, w, share, Glp, carried);
    for (size_t i = 0; i < w * w; i++)
        local[i] -= carried[i];
    const size_t z = rd_element_find(element, RD_Z);
    if (is_string(element))
        local[z * w + z] = (fmin(s, p) - s * p / element->length) / element->tension;
    return true;
}

/* the stiffness that belongs to the static shape: tension is a string beside other beams */
static bool shape_matrix(const struct rd_element *element, double _Complex *K)
{
    const bool acts = is_string(element) || is_tensed_beam(element);
    return closed_matrix(element, 1, acts ? 1 : 0, K) == RD_OK;
}

enum rd_status rd_element_shape(const struct rd_element *element, double s, double *shape)
{
    assert(0 <= s && s <= element->length);
    double _Complex K[N * N];
    struct opening opening;
    if (!closed_shape(element, s, shape) || !shape_matrix(element, K))
        return RD_NOT_POSITIVE_DEFINITE;
    for (size_t e = 0; e < element->width; e++)
        if (open_hinge(element, e, 1, K, &opening))
            follow(element, &opening, element->width, shape);
    return RD_OK;
}

/* a force at p presses on the held nodes by its shape there, and opens the hinge by that */
enum rd_status rd_element_local(const struct rd_element *element, double s, double p, double *local)
{
    const size_t w = element->width;
    double at_s[W * N], at_p[W * N];
    double _Complex K[N * N];
    struct opening opening;
    if (!closed_local(element, s, p, local) || !closed_shape(element, s, at_s) ||
        !closed_shape(element, p, at_p) || !shape_matrix(element, K))
        return RD_NOT_POSITIVE_DEFINITE;
    for (size_t e = 0; e < w; e++) {
        if (!open_hinge(element, e, 1, K, &opening))
            continue;
        for (size_t i = 0; i < w; i++)
            for (size_t j = 0; j < w; j++)
                local[i * w + j] +=
                    creal(opening.share) * at_s[i * 2 * w + e] * at_p[j * 2 * w + e];
        follow(element, &opening, w, at_s);
        follow(element, &opening, w, at_p);
    }
    return RD_OK;
}
