/* How the form of continuous elements changes with their numbers. */
#include "energy/span.h"

#include "base/complex_step.h"
#include "graded/family.h"

#include "span/span.h"
#include "sweep/kernel/transfer.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#pragma GCC diagnostic ignored "-Wpsabi"

enum { W = RD_WIDTH_MAX, N = RD_STATE_MAX };

/* The mixed form P = f^T F u_a + (f^T G f - u_a^T Q u_a)/2 of an element, f = f_b, has u_b = dP/df
   and f_a = dP/du_a; Pi = 2 (f^T u_b - P) is stationary in f and in the motion inside, and along the
   element dP/dx = y^T H y/2 with y = (u, f), y' = J H y (span/rate_matrix.h). So

       dPi/dp = - integral of y^T (dH/dp) y,

   each a factor times the integral of a product of two rows of y, as a form of (u_a, f_b). */
static void begin(struct rd_wave_slopes *slopes, size_t property, size_t i, size_t j, cv factor)
{
    size_t k = 0;
    while (k < slopes->forms && (slopes->form[k].i != i || slopes->form[k].j != j))
        k++;
    slopes->number[slopes->numbers++] =
        (struct rd_wave_number){.property = property, .form = k, .factor = factor};
    if (k < slopes->forms)
        return;
    slopes->forms++;
    slopes->form[k].i = i;
    slopes->form[k].j = j;
    memset(slopes->form[k].form, 0, sizeof slopes->form[k].form);
}

/* a rigid element is a beam beside a string, which is not here */
static bool is_beam(const struct rd_chain *chain)
{
    return chain->kind == RD_RIGID && chain->coordinate[chain->width - 1] == RD_BETA;
}

/* both places of an entry of S; T stands in q of beta, of a string as 1/T in S */
static void begin_all(struct rd_wave_slopes *slopes)
{
    const struct rd_chain *chain = slopes->chain;
    const size_t w = chain->width, z = rd_coordinate_find(w, chain->coordinate, RD_Z);
    slopes->forms = slopes->numbers = 0;
    for (size_t i = 0; i < w; i++)
        for (size_t j = 0; j <= i; j++)
            if (i != z && j != z)
                begin(slopes,
                      rd_property_of(rd_channel_of(chain->coordinate[i]),
                                     rd_channel_of(chain->coordinate[j])),
                      w + i, w + j, c_real(i == j ? -1 : -2));
    if (z < w && !is_beam(chain) && slopes->rate.z < 0)
        begin(slopes, RD_OF_TENSION, w + z, w + z,
              c_mul(slopes->rate.S[z][z], slopes->rate.S[z][z]));
    if (z < w && !is_beam(chain) && slopes->rate.z >= 0)
        begin(slopes, RD_OF_TENSION, w - 1, w - 1, c_real(1));
    if (slopes->rate.hangs)
        begin(slopes, RD_OF_SAG, w, 1, c_real(-2));
    for (size_t i = 0; chain->inertia && i < w; i++)
        begin(slopes, RD_OF_INERTIA + i, i, i, c_real(1));
}

/* y (2 width) <- J H y h */
RD_INLINE void differentiate(const struct rate_matrix *rate, size_t w, lanes h, cv *y)
{
    cv d[N];
    for (size_t i = 0; i < w; i++) {
        d[i] = c_zero();
        for (size_t j = 0; j < w; j++)
            if (rate->elastic[i][j])
                d[i] = c_add(d[i], c_mul(rate->S[i][j], y[w + j]));
        d[w + i] = c_mul(rate->q[i], y[i]);
    }
    if (rate->z >= 0) {
        d[rate->z] = c_add(d[rate->z], c_scale_lanes(y[w - 1], rate->lever));
        d[2 * w - 1] = c_sub(d[2 * w - 1], c_scale_lanes(y[w + (size_t)rate->z], rate->lever));
    }
    if (rate->hangs) {
        d[0] = c_add(d[0], c_mul(y[1], rate->sag));
        d[w + 1] = c_sub(d[w + 1], c_mul(y[w], rate->sag));
    }
    for (size_t i = 0; i < 2 * w; i++)
        y[i] = c_scale_lanes(d[i], h);
}

/* The first piece has 2^-FINER of the radians that one of the sweep has. Gauss points on (0, 1) and
   their weights are exact for polynomials of degree 7, and for products of two waves of so few
   radians to 1e-17 of them. */
enum { FINER = 4, POINTS = 4, HANGING = 2 };

static const double point[POINTS] = {0.06943184420297371, 0.33000947820757187, 0.6699905217924281,
                                     0.9305681557970262};
static const double share[POINTS] = {0.17392742256872692, 0.32607257743127307, 0.32607257743127307,
                                     0.17392742256872692};

/* y (POINTS, 2 width of y, 2 width of y_a) at the points, by the series of the exponential */
RD_INLINE void fill_points(const struct rate_matrix *rate, size_t w, double l, int terms,
                           cv (*y)[N][N])
{
    for (size_t c = 0; c < 2 * w; c++) {
        cv d[N], sum[POINTS][N];
        lanes power[POINTS];
        for (size_t i = 0; i < 2 * w; i++)
            d[i] = c_real(i == c);
        for (int k = 0; k < POINTS; k++) {
            power[k] = l_fill(1);
            memcpy(sum[k], d, 2 * w * sizeof *d);
        }
        for (int m = 1; m <= terms; m++) {
            differentiate(rate, w, l_fill(l / m), d);
            for (int k = 0; k < POINTS; k++) {
                power[k] *= point[k];
                for (size_t i = 0; i < 2 * w; i++)
                    sum[k][i] = c_add(sum[k][i], c_scale_lanes(d[i], power[k]));
            }
        }
        for (int k = 0; k < POINTS; k++)
            for (size_t i = 0; i < 2 * w; i++)
                y[k][i][c] = sum[k][i];
    }
}

/* the triple of an element of so many coordinates, D = F - I */
struct triple {
    cv D[W * W], G[W * W], Q[W * W];
};

/* A (w, w) B, A^T B */
RD_INLINE void times(size_t w, const cv *A, const cv *B, cv *C)
{
    for (size_t i = 0; i < w; i++)
        for (size_t j = 0; j < w; j++) {
            cv sum = c_mul(A[i * w], B[j]);
            for (size_t k = 1; k < w; k++)
                sum = c_add(sum, c_mul(A[i * w + k], B[k * w + j]));
            C[i * w + j] = sum;
        }
}

RD_INLINE void transposed_times(size_t w, const cv *A, const cv *B, cv *C)
{
    for (size_t i = 0; i < w; i++)
        for (size_t j = 0; j < w; j++) {
            cv sum = c_mul(A[i], B[j]);
            for (size_t k = 1; k < w; k++)
                sum = c_add(sum, c_mul(A[k * w + i], B[k * w + j]));
            C[i * w + j] = sum;
        }
}

/* rows of y at a point <- the same by (u_a, f_b): f_a = F^T f_b - Q u_a */
RD_INLINE void by_both_ends(const struct triple *t, size_t w, cv (*y)[N])
{
    for (size_t i = 0; i < 2 * w; i++) {
        cv row[N];
        for (size_t j = 0; j < w; j++) {
            row[j] = y[i][j];
            row[w + j] = y[i][w + j];
            for (size_t k = 0; k < w; k++) {
                row[j] = c_sub(row[j], c_mul(y[i][w + k], t->Q[k * w + j]));
                row[w + j] = c_add(row[w + j], c_mul(y[i][w + k], t->D[j * w + k]));
            }
        }
        for (size_t j = 0; j < 2 * w; j++)
            y[i][j] = row[j];
    }
}

/* the forms of the first piece */
static RD_CLONES void fill_slice(struct rd_wave_slopes *slopes, const struct triple *t, double l,
                                 int terms)
{
    const size_t w = slopes->chain->width, n = 2 * w;
    cv y[POINTS][N][N];
    fill_points(&slopes->rate, w, l, terms + (slopes->rate.hangs ? HANGING : 0), y);
    for (int k = 0; k < POINTS; k++) {
        const lanes weight = l_fill(share[k] * l / 2);
        by_both_ends(t, w, y[k]);
        for (size_t p = 0; p < slopes->forms; p++) {
            struct rd_wave_form *of = slopes->form + p;
            const cv *a = y[k][of->i], *b = y[k][of->j];
            for (size_t i = 0; i < n; i++)
                for (size_t j = i; j < n; j++) {
                    const cv both = c_add(c_mul(a[i], b[j]), c_mul(a[j], b[i]));
                    cv *sum = of->form + i * n + j;
                    *sum = c_add(*sum, c_scale_lanes(both, weight));
                }
        }
    }
    for (size_t p = 0; p < slopes->forms; p++)
        for (size_t i = 0; i < n; i++)
            for (size_t j = 0; j < i; j++)
                slopes->form[p].form[i * n + j] = slopes->form[p].form[j * n + i];
}

/* A <- A^-1 by Gauss and Jordan without exchange; whether no pivot was negative or zero */
RD_INLINE bool invert(size_t w, cv *A)
{
    bool positive = true;
    for (size_t k = 0; k < w; k++) {
        for (int lane = 0; lane < RD_LANES; lane++)
            positive &= A[k * (w + 1)].re[lane] > 0 || A[k * (w + 1)].im[lane] != 0;
        const cv pivot = c_inverse(A[k * (w + 1)]);
        A[k * (w + 1)] = c_real(1);
        for (size_t j = 0; j < w; j++)
            A[k * w + j] = c_mul(A[k * w + j], pivot);
        for (size_t i = 0; i < w; i++) {
            if (i == k)
                continue;
            const cv a = A[i * w + k];
            A[i * w + k] = c_zero();
            for (size_t j = 0; j < w; j++)
                A[i * w + j] = c_sub(A[i * w + j], c_mul(a, A[k * w + j]));
        }
    }
    return positive;
}

/* The state between two halves: u_m = U1 u_a + U2 f_b and f_m = P1 u_a + P2 f_b. */
struct middle {
    cv U1[W * W], U2[W * W], P1[W * W], P2[W * W];
};

/* u_m = (I + G Q)^-1 (F u_a + G F^T f_b), f_m = F^T f_b - Q u_m */
RD_INLINE void find_middle(size_t w, const struct triple *t, struct middle *m)
{
    cv M[W * W], F[W * W], FT[W * W], MG[W * W], QU[W * W];
    times(w, t->G, t->Q, M);
    for (size_t i = 0; i < w; i++)
        M[i * (w + 1)] = c_add(M[i * (w + 1)], c_real(1));
    invert(w, M);
    for (size_t i = 0; i < w; i++)
        for (size_t j = 0; j < w; j++) {
            F[i * w + j] = c_add(t->D[i * w + j], c_real(i == j));
            FT[j * w + i] = F[i * w + j];
        }
    times(w, M, F, m->U1);
    times(w, M, t->G, MG);
    times(w, MG, FT, m->U2);
    times(w, t->Q, m->U1, m->P1);
    times(w, t->Q, m->U2, QU);
    for (size_t i = 0; i < w * w; i++) {
        m->P1[i] = c_neg(m->P1[i]);
        m->P2[i] = c_sub(FT[i], QU[i]);
    }
}

/* D = 2 D1 + D1 D1 - F (I + G Q)^-1 G Q F of two equal halves, and so on: by what is between them,
   u_b = u_m + D u_m + G f_b and f_a = f_m + D^T f_m - Q u_a */
RD_INLINE void join_triples(size_t w, const struct middle *m, struct triple *t)
{
    struct triple half = *t;
    cv X[W * W], Y[W * W], Z[W * W], FP[W * W];
    times(w, half.G, m->P1, X); /* u_m - u_a = D u_a + G f_m */
    for (size_t i = 0; i < w * w; i++)
        X[i] = c_add(half.D[i], X[i]);
    times(w, half.D, m->U1, Y);
    times(w, half.D, m->U2, Z);
    transposed_times(w, half.D, m->P1, FP);
    for (size_t i = 0; i < w * w; i++)
        t->D[i] = c_add(X[i], Y[i]);
    for (size_t i = 0; i < w; i++)
        for (size_t j = 0; j < w; j++) {
            const size_t k = i * w + j, l = j * w + i;
            const cv G = c_add(c_add(m->U2[k], m->U2[l]), c_add(Z[k], Z[l]));
            const cv P = c_add(c_add(m->P1[k], m->P1[l]), c_add(FP[k], FP[l]));
            t->G[k] = c_add(half.G[k], c_scale(G, 0.5));
            t->Q[k] = c_sub(half.Q[k], c_scale(P, 0.5));
        }
}

/* The integral over both halves, [I 0; P1 P2]^T X [I 0; P1 P2] + [U1 U2; 0 I]^T X [U1 U2; 0 I] with
   X = [a b; b^T c]. */
RD_INLINE void join_form(size_t w, const struct middle *m, cv *form)
{
    const size_t n = 2 * w;
    cv a[W * W], b[W * W], bT[W * W], c[W * W], V[W * W], cP2[W * W], aU1[W * W], V2[W * W];
    cv sum[W * W], uu[W * W], uf[W * W], ff[W * W];
    for (size_t i = 0; i < w; i++)
        for (size_t j = 0; j < w; j++) {
            a[i * w + j] = form[i * n + j];
            b[i * w + j] = bT[j * w + i] = form[i * n + w + j];
            c[i * w + j] = form[(w + i) * n + w + j];
        }
    times(w, c, m->P1, V);
    times(w, a, m->U2, V2);
    for (size_t i = 0; i < w * w; i++) {
        V[i] = c_add(V[i], bT[i]);
        V2[i] = c_add(V2[i], b[i]);
    }
    times(w, b, m->P1, uu);
    transposed_times(w, m->P1, V, sum);
    times(w, a, m->U1, aU1);
    transposed_times(w, m->U1, aU1, uf);
    for (size_t i = 0; i < w * w; i++)
        uu[i] = c_add(c_add(a[i], uu[i]), c_add(sum[i], uf[i]));
    transposed_times(w, V, m->P2, uf);
    transposed_times(w, m->U1, V2, sum);
    for (size_t i = 0; i < w * w; i++)
        uf[i] = c_add(uf[i], sum[i]);
    times(w, c, m->P2, cP2);
    transposed_times(w, m->P2, cP2, ff);
    transposed_times(w, m->U2, V2, sum);
    for (size_t i = 0; i < w * w; i++)
        ff[i] = c_add(c_add(ff[i], c[i]), sum[i]);
    times(w, bT, m->U2, sum);
    for (size_t i = 0; i < w; i++)
        for (size_t j = 0; j < w; j++) {
            form[i * n + j] = uu[i * w + j];
            form[i * n + w + j] = form[(w + j) * n + i] = uf[i * w + j];
            form[(w + i) * n + w + j] = c_add(ff[i * w + j], sum[i * w + j]);
        }
}

static RD_CLONES void join(struct rd_wave_slopes *slopes, struct triple *t)
{
    const size_t w = slopes->chain->width;
    struct middle middle;
    find_middle(w, t, &middle);
    for (size_t p = 0; p < slopes->forms; p++)
        join_form(w, &middle, slopes->form[p].form);
    join_triples(w, &middle, t);
}

static RD_CLONES bool keep(struct rd_wave_slopes *slopes, const struct triple *t)
{
    const size_t w = slopes->chain->width;
    memcpy(slopes->D, t->D, w * w * sizeof *t->D);
    memcpy(slopes->Q, t->Q, w * w * sizeof *t->Q);
    memcpy(slopes->stiff, t->G, w * w * sizeof *t->G);
    return invert(w, slopes->stiff);
}

/* ---- longer than waves: halves joined by the waves between them ---- */

/* 1/z^2 is near the impedance of what moves: with a^2 - k^2 = T S_bb, a k = (lambda mu S_bb)^1/2
   k (a^2 + k^2)/S_bb of z and (a + k)/S_bb of beta, k/S of the others; waves are no longer than the
   element. Any z will do. */
static void set_scale(struct rd_wave_slopes *slopes, int lane)
{
    const struct rate_matrix *rate = &slopes->rate;
    const size_t w = slopes->chain->width;
    const double least = 1 / slopes->chain->length[slopes->element];
    for (size_t i = 0; i < w; i++) {
        const bool bent = (int)i == rate->z || (rate->z >= 0 && i == w - 1);
        const size_t c = bent ? w - 1 : i, m = bent ? (size_t)rate->z : i;
        const double S = hypot(rate->S[c][c].re[lane], rate->S[c][c].im[lane]);
        const double load = S * hypot(rate->q[m].re[lane], rate->q[m].im[lane]);
        const double half = bent ? S * hypot(rate->q[c].re[lane], rate->q[c].im[lane]) / 2 : 0;
        const double a = fmax(sqrt(half + sqrt(half * half + load)), least);
        const double k = bent ? fmax(sqrt(load) / a, least) : fmax(sqrt(load), least);
        const double stiff = !bent ? k : (int)i == rate->z ? k * (a * a + k * k) : a + k;
        slopes->waves.z[i][lane] = sqrt(S / stiff);
    }
}

/* (n, n) A <- A^-1 by Gauss and Jordan, the largest of a column first, in every lane */
static void invert_apart(size_t n, cv *A)
{
    for (int lane = 0; lane < RD_LANES; lane++) {
        double _Complex X[2 * W * W];
        for (size_t i = 0; i < n; i++)
            for (size_t j = 0; j < n; j++) {
                const cv a = A[i * n + j];
                X[i * 2 * n + j] = CMPLX(a.re[lane], a.im[lane]);
                X[i * 2 * n + n + j] = i == j;
            }
        for (size_t k = 0; k < n; k++) {
            size_t p = k;
            for (size_t i = k + 1; i < n; i++)
                p = cabs(X[i * 2 * n + k]) > cabs(X[p * 2 * n + k]) ? i : p;
            for (size_t j = 0; j < 2 * n; j++) {
                const double _Complex x = X[p * 2 * n + j];
                X[p * 2 * n + j] = X[k * 2 * n + j];
                X[k * 2 * n + j] = x;
            }
            const double _Complex pivot = 1 / X[k * 2 * n + k];
            for (size_t j = k; j < 2 * n; j++)
                X[k * 2 * n + j] *= pivot;
            for (size_t i = 0; i < n; i++) {
                const double _Complex x = X[i * 2 * n + k];
                for (size_t j = k; i != k && j < 2 * n; j++)
                    X[i * 2 * n + j] -= x * X[k * 2 * n + j];
            }
        }
        for (size_t i = 0; i < n; i++)
            for (size_t j = 0; j < n; j++) {
                A[i * n + j].re[lane] = creal(X[i * 2 * n + n + j]);
                A[i * n + j].im[lane] = cimag(X[i * 2 * n + n + j]);
            }
    }
}

/* the same by the adjugate where there are two or fewer, which is what most ropes have */
static RD_CLONES void invert_any(size_t n, cv *A)
{
    if (n > 2) {
        invert_apart(n, A);
        return;
    }
    const cv det = n == 1 ? A[0] : c_sub(c_mul(A[0], A[3]), c_mul(A[1], A[2]));
    const cv s = c_inverse(det), first = n == 1 ? c_real(1) : A[3];
    if (n == 2) {
        A[3] = c_mul(A[0], s);
        A[1] = c_neg(c_mul(A[1], s));
        A[2] = c_neg(c_mul(A[2], s));
    }
    A[0] = c_mul(first, s);
}

/* (u_a, f_b) = C (a_L, a_R): of u_a + i f_a = 2 a_L and u_b - i f_b = 2 a_R in units of z, 1/z,

       | I - i Q   i F^T   |
       | i F       I + i G | (u_a, f_b) = 2 (a_L, i a_R),

   whose Hermitian part is I where nothing is damped */
static RD_CLONES void fill_entry(const struct triple *t, size_t w, const lanes *z, cv *C)
{
    const size_t n = 2 * w;
    for (size_t i = 0; i < w; i++)
        for (size_t j = 0; j < w; j++) {
            const cv one = c_real(i == j);
            const cv F = c_scale_lanes(c_add(t->D[i * w + j], one), z[j] / z[i]);
            C[i * n + j] = c_sub(one, c_times_i(c_scale_lanes(t->Q[i * w + j], z[i] * z[j])));
            C[(w + i) * n + w + j] =
                c_add(one, c_times_i(c_scale_lanes(t->G[i * w + j], 1 / (z[i] * z[j]))));
            C[(w + i) * n + j] = C[j * n + w + i] = c_times_i(F);
        }
    invert(n, C);
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < n; j++) {
            const cv twice = c_scale(C[i * n + j], 2);
            C[i * n + j] = j < w ? twice : c_times_i(twice);
        }
}

/* form <- C^T diag(z, 1/z) form diag(z, 1/z) C */
static RD_CLONES void enter_form(size_t w, const lanes *z, const cv *C, cv *form)
{
    const size_t n = 2 * w;
    cv scaled[N * N], half[N * N];
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < n; j++) {
            const lanes a = i < w ? z[i] : 1 / z[i - w], b = j < w ? z[j] : 1 / z[j - w];
            scaled[i * n + j] = c_scale_lanes(form[i * n + j], a * b);
        }
    times(n, scaled, C, half);
    transposed_times(n, C, half, form);
}

/* b_L = u_a - a_L and b_R = a_R + i f_b */
static RD_CLONES void begin_waves(struct rd_wave_slopes *slopes, const struct triple *t)
{
    const size_t w = slopes->chain->width, n = 2 * w;
    struct rd_scattering *waves = &slopes->waves;
    cv C[N * N];
    for (int lane = 0; lane < RD_LANES; lane++)
        set_scale(slopes, lane);
    fill_entry(t, w, waves->z, C);
    for (size_t p = 0; p < slopes->forms; p++)
        enter_form(w, waves->z, C, slopes->form[p].form);
    for (size_t i = 0; i < w; i++)
        for (size_t j = 0; j < w; j++) {
            const cv one = c_real(i == j);
            waves->S11[i * w + j] = c_sub(C[i * n + j], one);
            waves->S12[i * w + j] = C[i * n + w + j];
            waves->S21[i * w + j] = c_times_i(C[(w + i) * n + j]);
            waves->S22[i * w + j] = c_add(one, c_times_i(C[(w + i) * n + w + j]));
        }
}

/* The waves between two equal parts, d to the right and c to the left: d = U1 a_L + U2 a_R and
   c = P1 a_L + P2 a_R of d = S21 a_L + S22 c, c = S11 d + S12 a_R. */
RD_INLINE void meet_waves(size_t w, const struct rd_scattering *s, struct middle *m)
{
    cv M[W * W], X[W * W];
    times(w, s->S22, s->S11, M);
    for (size_t i = 0; i < w * w; i++)
        M[i] = c_sub(c_real(i % (w + 1) == 0), M[i]);
    invert_any(w, M);
    times(w, M, s->S21, m->U1);
    times(w, s->S22, s->S12, X);
    times(w, M, X, m->U2);
    times(w, s->S11, m->U1, m->P1);
    times(w, s->S11, m->U2, m->P2);
    for (size_t i = 0; i < w * w; i++)
        m->P2[i] = c_add(m->P2[i], s->S12[i]);
}

static RD_CLONES void join_waves(struct rd_wave_slopes *slopes)
{
    const size_t w = slopes->chain->width;
    struct rd_scattering *s = &slopes->waves;
    struct middle m;
    cv X11[W * W], X12[W * W], X21[W * W], X22[W * W];
    meet_waves(w, s, &m);
    for (size_t p = 0; p < slopes->forms; p++)
        join_form(w, &m, slopes->form[p].form);
    times(w, s->S12, m.P1, X11);
    times(w, s->S12, m.P2, X12);
    times(w, s->S21, m.U1, X21);
    times(w, s->S21, m.U2, X22);
    for (size_t i = 0; i < w * w; i++) {
        s->S11[i] = c_add(s->S11[i], X11[i]);
        s->S22[i] = c_add(s->S22[i], X22[i]);
        s->S12[i] = X12[i];
        s->S21[i] = X21[i];
    }
}

/* The left node moves by u_a - C f_a where a hinge opens, u_a = a_L + b_L and f_a = i (b_L - a_L):
   (I + S11) a_L + S12 a_R = u_a; where it is free, f_a is 0 in its place. */
void rd_wave_slopes_hinge(struct rd_wave_slopes *slopes, const double *hinge, cv spring)
{
    const size_t w = slopes->chain->width;
    struct rd_scattering *s = &slopes->waves;
    const cv soft = c_inverse(spring);
    for (size_t i = 0; i < w; i++) {
        const bool free = hinge && isinf(hinge[i]);
        const double C = hinge && !free ? hinge[i] : 0;
        const cv give = c_times_i(c_scale_lanes(soft, C / (s->z[i] * s->z[i])));
        for (size_t j = 0; j < w; j++) {
            const cv one = c_real(i == j), b = s->S11[i * w + j];
            const cv force = c_sub(b, one);
            s->enter[i * w + j] = free ? force : c_sub(c_add(one, b), c_mul(give, force));
        }
    }
    invert_any(w, s->enter);
}

/* what is left of the left node's condition without a_L */
RD_INLINE void fill_left(const struct rd_wave_slopes *slopes, const double *hinge, cv spring,
                         const struct rd_moved *moved, const cv *sent, cv *rest)
{
    const struct rd_scattering *s = &slopes->waves;
    const cv soft = c_inverse(spring);
    for (size_t i = 0; i < slopes->chain->width; i++) {
        const bool free = hinge && isinf(hinge[i]);
        const double C = hinge && !free ? hinge[i] : 0;
        const cv give = c_times_i(c_scale_lanes(soft, C / (s->z[i] * s->z[i])));
        const cv u = c_scale_lanes(moved->u[i], 1 / s->z[i]);
        rest[i] = free ? c_neg(sent[i]) : c_add(c_sub(u, sent[i]), c_mul(give, sent[i]));
    }
}

static RD_CLONES void scatter(const struct rd_wave_slopes *slopes, const double *hinge, cv spring,
                              struct rd_moved *moved)
{
    const struct rd_scattering *s = &slopes->waves;
    const size_t w = slopes->chain->width;
    cv sent[W], rest[W], *in = moved->state;
    for (size_t i = 0; i < w; i++) {
        const cv u = c_scale_lanes(moved->u[w + i], 0.5 / s->z[i]);
        in[w + i] = c_sub(u, c_times_i(c_scale_lanes(moved->right[i], 0.5 * s->z[i])));
    }
    for (size_t i = 0; i < w; i++) {
        sent[i] = c_zero();
        for (size_t j = 0; j < w; j++)
            sent[i] = c_add(sent[i], c_mul(s->S12[i * w + j], in[w + j]));
    }
    fill_left(slopes, hinge, spring, moved, sent, rest);
    for (size_t i = 0; i < w; i++) {
        in[i] = c_zero();
        for (size_t j = 0; j < w; j++)
            in[i] = c_add(in[i], c_mul(s->enter[i * w + j], rest[j]));
    }
    for (size_t i = 0; i < w; i++) {
        cv out = sent[i];
        for (size_t j = 0; j < w; j++)
            out = c_add(out, c_mul(s->S11[i * w + j], in[j]));
        const cv u = c_scale_lanes(c_add(in[i], out), s->z[i]);
        moved->left[i] = c_times_i(c_scale_lanes(c_sub(out, in[i]), 1 / s->z[i]));
        moved->from_left[i] = (c_size(out) + c_size(in[i])) / s->z[i];
        moved->from_right[i] = c_size(moved->right[i]);
        moved->opens[i] = hinge && hinge[i] != 0 ? c_sub(u, moved->u[i]) : c_zero();
        moved->u[i] = u;
    }
}

void rd_wave_slopes_scatter(const struct rd_wave_slopes *slopes, const double *hinge, cv spring,
                            struct rd_moved *moved)
{
    scatter(slopes, hinge, spring, moved);
}

/* ---- tension that grows along the element ---- */

/* the triple of the element with its numbers as they are, and where they have an imaginary step how it
   changes with them as imaginary parts; lines are real */
static enum rd_status graded_triple(const struct rd_wave_slopes *slopes,
                                    const struct rd_lines *lines, const struct rate_matrix *rate,
                                    double more, double steeper, struct triple *t)
{
    const struct rd_chain *chain = slopes->chain;
    const size_t e = slopes->element, w = chain->width;
    const struct rd_field field = {
        .width = w,
        .rate = rate,
        .tension = chain->tension[e],
        .pull = lines->tension,
        .more = more,
        .steeper = steeper,
    };
    struct rd_sizes sizes = {0};
    for (int lane = 0; lane < RD_LANES; lane++) {
        sizes.section = fmax(sizes.section, 1 / fabs(lines->section.re[lane]));
        sizes.tension = fmax(sizes.tension, fabs(lines->tension.re[lane]));
        sizes.inertia = fmax(sizes.inertia, fabs(lines->inertia.re[lane]));
        sizes.dashpot = fmax(sizes.dashpot, fabs(lines->dashpot.re[lane]));
    }
    sizes.section = 1 / sizes.section;
    struct rd_block block[RD_BLOCKS_MOST];
    const size_t blocks = rd_blocks_of(chain, e, &sizes, false, block);
    cv packed[RD_GRADED_TRIPLE];
    rd_family_whole(&field, blocks, block, packed);
    for (size_t i = 0, p = w * w; i < w; i++)
        for (size_t j = 0; j < w; j++) {
            t->D[i * w + j] = packed[i * w + j];
            if (j < i)
                continue;
            t->G[i * w + j] = t->G[j * w + i] = packed[p];
            t->Q[i * w + j] = t->Q[j * w + i] = packed[w * (w + 1) / 2 + p++];
        }
    return blocks > 0 ? RD_OK : RD_SHORT_WAVES;
}

/* dPi/dp = -2 dP/dp = u_a^T Q' u_a - 2 f_b^T F' u_a - f_b^T G' f_b */
static void add_number(struct rd_wave_slopes *slopes, size_t property, cv factor,
                       const struct triple *t)
{
    const size_t w = slopes->chain->width, n = 2 * w, k = slopes->forms++;
    cv *form = slopes->form[k].form;
    slopes->number[slopes->numbers++] =
        (struct rd_wave_number){.property = property, .form = k, .factor = factor};
    for (size_t i = 0; i < w; i++)
        for (size_t j = 0; j < w; j++) {
            const lanes D = t->D[i * w + j].im / RD_COMPLEX_STEP;
            const lanes G = t->G[i * w + j].im / RD_COMPLEX_STEP;
            form[i * n + j] = (cv){t->Q[i * w + j].im / RD_COMPLEX_STEP, (lanes){0}};
            form[(w + i) * n + j] = form[j * n + w + i] = (cv){-D, (lanes){0}};
            form[(w + i) * n + w + j] = (cv){-G, (lanes){0}};
        }
}

static enum rd_status fill_graded(struct rd_wave_slopes *slopes, const struct rd_lines *lines)
{
    const struct rd_chain *chain = slopes->chain;
    const size_t w = chain->width;
    const double h = RD_COMPLEX_STEP;
    const cv one = c_real(1);
    const bool bends = slopes->rate.z >= 0;
    struct rate_matrix rate = slopes->rate;
    struct triple t;
    enum rd_status status = RD_OK;
    slopes->forms = slopes->numbers = 0;
    if (bends) {
        rate.S[w - 1][w - 1].im += h;
        status = graded_triple(slopes, lines, &rate, 0, 0, &t);
        add_number(slopes, rd_property_of(RD_BENDING, RD_BENDING), one, &t);
    }
    for (size_t i = 0; i < w && status == RD_OK; i++) {
        rate = slopes->rate;
        rate.q[i].im += h;
        status = graded_triple(slopes, lines, &rate, 0, 0, &t);
        add_number(slopes, RD_OF_INERTIA + i, one, &t);
    }
    if (status == RD_OK)
        status = graded_triple(slopes, lines, &slopes->rate, h, 0, &t);
    add_number(slopes, RD_OF_TENSION, c_inverse(lines->tension), &t);
    if (status == RD_OK)
        status = graded_triple(slopes, lines, &slopes->rate, 0, h, &t);
    add_number(slopes, RD_OF_SAG, one, &t);
    for (size_t i = 0; i < w * w; i++)
        t.D[i].im = t.G[i].im = t.Q[i].im = (lanes){0};
    return status != RD_OK ? status : keep(slopes, &t) ? RD_OK : RD_INDEFINITE_ELEMENT;
}

/* pieces of one radian by their ends */
enum rd_status rd_wave_slopes_of(const struct rd_chain *chain, size_t e,
                                 const struct rd_lines *lines, bool forces,
                                 struct rd_wave_slopes *slopes)
{
    const cv tension = is_beam(chain) ? c_zero() : lines->tension;
    struct triple triple;
    slopes->chain = chain;
    slopes->element = e;
    rd_rate_fill(chain, e, lines->section, tension, lines->inertia, lines->dashpot, &slopes->rate);
    if (rd_is_graded(chain, e))
        return fill_graded(slopes, lines);
    begin_all(slopes);
    const double radians = rd_transfer_radians(chain, e, &slopes->rate);
    const int halvings = rd_span_halvings(radians, 1) + FINER;
    const int terms = rd_span_terms(ldexp(radians, -halvings));
    const double l = ldexp(chain->length[e], -halvings);
    rd_transfer_slice(chain->width, &slopes->rate, l, terms, triple.D, triple.G, triple.Q);
    fill_slice(slopes, &triple, l, terms);
    const int mixed = forces ? FINER : halvings;
    for (int k = 0; k < mixed; k++)
        join(slopes, &triple);
    if (!forces)
        return keep(slopes, &triple) ? RD_OK : RD_INDEFINITE_ELEMENT;
    begin_waves(slopes, &triple);
    for (int k = mixed; k < halvings; k++)
        join_waves(slopes);
    return RD_OK;
}

/* f_b = G^-1 (u_b - F u_a) and f_a = F^T f_b - Q u_a */
static RD_CLONES void move(const struct rd_wave_slopes *slopes, struct rd_moved *moved)
{
    const size_t w = slopes->chain->width;
    const cv *u = moved->u;
    cv lag[W];
    for (size_t i = 0; i < w; i++) {
        lag[i] = c_sub(u[w + i], u[i]);
        for (size_t j = 0; j < w; j++)
            lag[i] = c_sub(lag[i], c_mul(slopes->D[i * w + j], u[j]));
    }
    for (size_t i = 0; i < w; i++) {
        moved->right[i] = c_zero();
        moved->from_right[i] = (lanes){0};
        for (size_t j = 0; j < w; j++) {
            const lanes both = c_size(u[w + j]) + c_size(u[j]);
            moved->right[i] = c_add(moved->right[i], c_mul(slopes->stiff[i * w + j], lag[j]));
            moved->from_right[i] += c_size(slopes->stiff[i * w + j]) * both;
        }
    }
    for (size_t i = 0; i < w; i++) {
        moved->left[i] = moved->right[i];
        moved->from_left[i] = moved->from_right[i];
        for (size_t j = 0; j < w; j++) {
            const cv force = c_mul(slopes->D[j * w + i], moved->right[j]);
            const cv push = c_mul(slopes->Q[i * w + j], u[j]);
            moved->left[i] = c_add(moved->left[i], c_sub(force, push));
            moved->from_left[i] += c_size(slopes->D[j * w + i]) * moved->from_right[j];
            moved->from_left[i] += c_size(push);
        }
    }
    const size_t z = rd_coordinate_find(w, slopes->chain->coordinate, RD_Z);
    const double l = slopes->chain->length[slopes->element];
    moved->rise = z < w ? c_scale(c_sub(u[w + z], u[z]), 2 / l) : c_zero();
    memcpy(moved->state, u, w * sizeof *u);
    memcpy(moved->state + w, moved->right, w * sizeof *u);
}

void rd_wave_slopes_move(const struct rd_wave_slopes *slopes, struct rd_moved *moved)
{
    move(slopes, moved);
}

/* Without a jump f_a would be m, each radian of it takes k = (F^T G^-1 F + Q)_ee away, so that it is
   C m/(1 + C k), m/k where the hinge is free. */
void rd_wave_slopes_open(const struct rd_wave_slopes *slopes, const double *hinge, cv spring,
                         struct rd_moved *moved)
{
    const size_t w = slopes->chain->width;
    for (size_t e = 0; hinge && e < w; e++) {
        if (hinge[e] == 0)
            continue;
        cv k = slopes->Q[e * (w + 1)], F[W];
        for (size_t i = 0; i < w; i++)
            F[i] = c_add(slopes->D[i * w + e], c_real(i == e));
        for (size_t i = 0; i < w; i++)
            for (size_t j = 0; j < w; j++)
                k = c_add(k, c_mul(c_mul(F[i], slopes->stiff[i * w + j]), F[j]));
        rd_wave_slopes_move(slopes, moved);
        const cv stiff = isinf(hinge[e]) ? k : c_add(c_scale(spring, 1 / hinge[e]), k);
        moved->opens[e] = c_mul(moved->left[e], c_inverse(stiff));
        moved->u[e] = c_add(moved->u[e], moved->opens[e]);
    }
}

static RD_CLONES void add(const struct rd_wave_slopes *slopes, const struct rd_moved *a,
                          const struct rd_moved *b, cv *slope)
{
    const size_t w = slopes->chain->width, n = 2 * w;
    cv dyad[N * N], sum[RD_PROPERTIES];
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < n; j++)
            dyad[i * n + j] = c_mul(a->state[i], b->state[j]);
    for (size_t p = 0; p < slopes->forms; p++) {
        sum[p] = c_zero();
        for (size_t k = 0; k < n * n; k++)
            sum[p] = c_add(sum[p], c_mul(slopes->form[p].form[k], dyad[k]));
    }
    for (size_t p = 0; p < slopes->numbers; p++) {
        const struct rd_wave_number *number = slopes->number + p;
        cv *of = slope + number->property;
        *of = c_add(*of, c_mul(number->factor, sum[number->form]));
    }
    cv at_a[N], at_b[N];
    memcpy(at_a, a->u, w * sizeof(cv));
    memcpy(at_a + w, a->left, w * sizeof(cv));
    memcpy(at_b, b->u, w * sizeof(cv));
    memcpy(at_b + w, b->left, w * sizeof(cv));
    slope[RD_OF_LENGTH] = c_sub(slope[RD_OF_LENGTH], rd_rate_form(&slopes->rate, w, at_a, at_b));
}

void rd_wave_slopes_add(const struct rd_wave_slopes *slopes, const struct rd_moved *a,
                        const struct rd_moved *b, cv *slope)
{
    add(slopes, a, b, slope);
}
