/* Plain spans in closed form against their waves. */
#include "base/complex.h"
#include "span/whole.h"

#include "check.h"

#pragma GCC diagnostic ignored "-Wpsabi"

static cv lanes_of(double complex x)
{
    return c_add(c_real(creal(x)), c_imag(cimag(x)));
}

static double complex lane_of(cv x)
{
    return CMPLX(x.re[0], x.im[0]);
}

/* reduced to pi/4 by 107 bits of pi/2, then a series and a sum: an absolute error of EPS, of small
   angles a relative one */
static void circle_is_right_to_the_last_digit(void)
{
    for (int k = 0; k < 4000; k++) {
        const double x = k < 2000 ? ldexp(1 + k / 2000.0, -k % 40) : 0.37 * k * k * (1 + k % 3);
        for (int side = -1; side < 2; side += 2) {
            const struct l_circle f = l_circle_of(l_fill(side * x));
            const long double s = sinl(side * (long double)x), c = cosl(side * (long double)x);
            CHECK_ABS(f.sin[0], (double)s, EPS * fmin(1, x), "a rounding of a sum below 1");
            CHECK_ABS(f.cos[0], (double)c, EPS, "a rounding of a sum below 1");
            const double back = f.quarters[0] * 0x1.921fb54442d18p+0 + f.rest[0];
            CHECK_ABS(back, side * x, 2 * EPS * x, "a product and a sum");
        }
    }
}

static void root_is_in_the_right_half_plane(void)
{
    static const double re[] = {-3, -1e-8, 0, 1e-12, 2, 1e20}, im[] = {-5, -1e-20, 0, 1e-9, 7};
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < 5; j++) {
            const double complex z = CMPLX(re[i], im[j]), x = lane_of(c_root(lanes_of(z)));
            CHECK(creal(x) >= 0);
            CHECK_ABS(cabs(x - csqrt(z)), 0, 4 * EPS * cabs(x), "two roots and a quotient");
        }
}

/* a beam of stiffness 1 in scales of z and beta, and what damps its section, its tension, its motion */
struct span {
    double length, tension, inertia, z, beta;
    double complex section, pull, motion;
};

/* q_z, q_beta and S' */
static void loads_of(const struct span *x, double complex *load, double complex *soft)
{
    load[0] = -x->inertia * x->motion * x->z * x->z;
    load[1] = x->tension * x->pull * x->beta * x->beta;
    *soft = 1 / (x->section * x->beta * x->beta);
}

/* z, beta, F, M of exp(e s) at its larger end, and by what it is less at the other */
static void wave_of(const struct span *x, double complex e, double complex *y)
{
    const double lever = x->beta / x->z;
    double complex load[2], soft;
    loads_of(x, load, &soft);
    y[0] = 1;
    y[1] = e / lever;
    y[3] = e * y[1] / soft;
    y[2] = load[0] / e; /* F' = q z */
}

/* the exponents: +-ik, +-a */
static void exponents_of(const struct span *x, double complex *e)
{
    double complex load[2], soft;
    loads_of(x, load, &soft);
    const double complex half = load[1] * soft / 2;
    const double lever = x->beta / x->z;
    const double complex kappa = -load[0] * soft * lever * lever;
    const double complex R = csqrt(half * half + kappa);
    const double complex larger = creal(half) < 0 ? half - R : half + R;
    e[0] = csqrt(larger);
    e[1] = csqrt(-kappa / larger);
    e[2] = -e[0];
    e[3] = -e[1];
}

/* Rounding of some ten products, and of the phase: radians */
static double rounding(double radians)
{
    return 128 * EPS * (1 + radians);
}

/* sum x_j y_j = 0 to `tolerance` of its terms */
static void check_sum(int count, const double complex *term, double tolerance)
{
    double complex sum = 0;
    double most = 0;
    for (int i = 0; i < count; i++) {
        sum += term[i];
        most += cabs(term[i]);
    }
    CHECK_ABS(cabs(sum), 0, tolerance * most, "of the terms that cancel");
}

static void check_form(const struct bent_span *t, const double complex *a, const double complex *b,
                       double tolerance)
{
    const double complex s[2] = {b[0] - I * b[2], b[1] - I * b[3]};
    for (int i = 0; i < 2; i++) {
        const double complex u[] = {-b[i], lane_of(t->A[i]) * s[0], lane_of(t->A[i + 1]) * s[1],
                                    -I * lane_of(t->B[2 * i]) * a[0],
                                    -I * lane_of(t->B[2 * i + 1]) * a[1]};
        const double complex f[] = {-a[2 + i],
                                    lane_of(t->B[i]) * s[0],
                                    lane_of(t->B[2 + i]) * s[1],
                                    -lane_of(t->C[i]) * a[0],
                                    -lane_of(t->C[i + 1]) * a[1],
                                    -I * a[i]};
        check_sum(5, u, tolerance);
        check_sum(6, f, tolerance);
    }
}

static void check_triple(const struct bent_triple *t, const double complex *a,
                         const double complex *b, double tolerance)
{
    for (int i = 0; i < 2; i++) {
        const double complex u[] = {-b[i],
                                    a[i],
                                    lane_of(t->D[2 * i]) * a[0],
                                    lane_of(t->D[2 * i + 1]) * a[1],
                                    lane_of(t->G[i]) * b[2],
                                    lane_of(t->G[i + 1]) * b[3]};
        const double complex f[] = {-a[2 + i],
                                    b[2 + i],
                                    lane_of(t->D[i]) * b[2],
                                    lane_of(t->D[2 + i]) * b[3],
                                    -lane_of(t->Q[i]) * a[0],
                                    -lane_of(t->Q[i + 1]) * a[1]};
        check_sum(6, u, tolerance);
        check_sum(6, f, tolerance);
    }
}

/* both forms of a span hold for its four waves, which are all the motions that it has */
static void check_span(const struct span *x)
{
    double complex load[2], soft, e[4];
    loads_of(x, load, &soft);
    exponents_of(x, e);
    const cv of[2] = {lanes_of(load[0]), lanes_of(load[1])};
    const struct bent_span whole =
        bent_span_of(lanes_of(soft), of, l_fill(x->beta / x->z), l_fill(x->length));
    const struct bent_triple triple =
        bent_triple_of(lanes_of(soft), of, l_fill(x->beta / x->z), l_fill(x->length));
    for (int i = 0; i < 4; i++) {
        double complex large[4], small[4];
        const double radians = cabs(e[i]) * x->length;
        const bool grows = creal(e[i]) > 0;
        wave_of(x, e[i], large);
        for (int j = 0; j < 4; j++)
            small[j] = large[j] * cexp((grows ? -e[i] : e[i]) * x->length);
        check_form(&whole, grows ? small : large, grows ? large : small, rounding(radians));
        check_triple(&triple, grows ? small : large, grows ? large : small, rounding(radians));
    }
}

/* tensed, slack and compressed, damped in three ways, from much shorter than its waves to much
   longer; k l stays away from resonances of the cantilever */
static void beams_hold_for_their_waves(void)
{
    static const double tension[] = {0, 1e-3, 2, -3, 50, 1e4};
    static const double k[] = {1e-2, 0.3, 0.8, 1.2, 3.1, 6.3, 15.8, 62.8};
    static const double complex damping[] = {1, 1 + 0.02 * I, 0.9 + 0.3 * I};
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < 8; j++)
            for (int d = 0; d < 3; d++) {
                const double a2 = k[j] * k[j] + tension[i];
                if (a2 <= 0)
                    continue;
                const double a = fmax(sqrt(a2), 1), wave = fmax(k[j], 1);
                const struct span x = {.length = 1,
                                       .tension = tension[i],
                                       .inertia = k[j] * k[j] * a2,
                                       .z = 1 / sqrt(wave * (wave * wave + a * a)),
                                       .beta = (d == 1 ? 3 : 1) / sqrt(a),
                                       .section = damping[d],
                                       .pull = d == 2 ? 1 + 0.01 * I : 1,
                                       .motion = d == 2 ? 1 - 0.2 * I : 1};
                check_span(&x);
            }
}

/* u' = S f, f' = q u: F = 1/cos, G = S sin/k, and B = i/(cos + i S sin/k), to its own last digits where
   next to nothing arrives */
static void rods_are_sines_and_keep_the_digits_of_what_decays(void)
{
    static const double complex k[] = {1e-9,        0.2,         1,           3,       40,
                                       2 - 0.1 * I, 30 - 20 * I, 1 - 300 * I, -0.5 * I};
    for (int i = 0; i < 9; i++) {
        const double S = 0.4;
        const double complex q = -k[i] * k[i] / S, s = csin(k[i]) / k[i];
        const struct plain_span t = plain_span_of(c_real(S), lanes_of(q), l_fill(1));
        const struct rod_triple rod = rod_triple_of(c_real(S), lanes_of(q), l_fill(1));
        const double complex B = I / (ccos(k[i]) + I * S * s);
        const double tolerance = rounding(cabs(k[i]));
        CHECK_ABS(cabs(lane_of(t.B) - B), 0, tolerance * cabs(B), "of its own size");
        CHECK_ABS(cabs(lane_of(rod.D) + 1 - 1 / ccos(k[i])), 0, tolerance, "of an entry below 1");
        const double complex G = S * s / ccos(k[i]), Q = q * s / ccos(k[i]);
        CHECK_ABS(cabs(lane_of(rod.G) - G), 0, tolerance * cabs(G), "of its own size");
        CHECK_ABS(cabs(lane_of(rod.Q) - Q), 0, tolerance * cabs(Q), "of its own size");
        /* matched on the right, f_b = i u_b, nothing comes from there */
        const double complex A = (s * S / (s * S - I * ccos(k[i])));
        CHECK_ABS(cabs(lane_of(t.A) - A), 0, tolerance * cabs(A), "of its own size");
    }
}

/* eight spans: real, damped, brief, of decaying waves, compressed */
static void fill_lanes(int from, int step, cv *soft, cv *load, lanes *lever, lanes *length)
{
    static const double k2[] = {0, 10, 900, 0.2, 30, 1e-6, 2500, 4};
    static const double tension[] = {300, 0, 20, 0.1, 1e4, 5, -80, -1};
    static const double damping[] = {0, 0.1, 0, 0, 0.9, 0, 0.02, 0};
    for (int k = 0; k < RD_LANES; k++) {
        const int i = (from + step * k) % RD_LANES;
        const double q = k2[i] * (k2[i] + tension[i]);
        soft->re[k] = 1;
        soft->im[k] = -damping[i];
        load[0].re[k] = -q;
        load[0].im[k] = damping[i] * q;
        load[1].re[k] = tension[i];
        load[1].im[k] = 0;
        (*lever)[k] = 1 + i % 3;
        (*length)[k] = i == 6 ? 12 : 1;
    }
}

static void check_lane(const cv *mixed, int lane, const cv *alone, int count)
{
    for (int i = 0; i < count; i++) {
        CHECK_EXACT(mixed[i].re[lane], alone[i].re[0]);
        CHECK_EXACT(mixed[i].im[lane], alone[i].im[0]);
    }
}

/* what is beside a span decides which branches are taken, and none of its bits */
static void lane_knows_nothing_of_its_neighbours(void)
{
    cv soft, load[2];
    lanes lever, length;
    fill_lanes(0, 1, &soft, load, &lever, &length);
    const struct bent_span span = bent_span_of(soft, load, lever, length);
    const struct bent_triple triple = bent_triple_of(soft, load, lever, length);
    const struct plain_span rod = plain_span_of(soft, load[0], length);
    for (int lane = 0; lane < RD_LANES; lane++) {
        fill_lanes(lane, 0, &soft, load, &lever, &length);
        const struct bent_span own = bent_span_of(soft, load, lever, length);
        const struct bent_triple form = bent_triple_of(soft, load, lever, length);
        const struct plain_span alone = plain_span_of(soft, load[0], length);
        check_lane(span.A, lane, own.A, 3);
        check_lane(span.B, lane, own.B, 4);
        check_lane(span.C, lane, own.C, 3);
        check_lane(triple.D, lane, form.D, 4);
        check_lane(triple.G, lane, form.G, 3);
        check_lane(triple.Q, lane, form.Q, 3);
        check_lane(&rod.A, lane, &alone.A, 1);
        check_lane(&rod.B, lane, &alone.B, 1);
        check_lane(&rod.C, lane, &alone.C, 1);
    }
}

int main(void)
{
    circle_is_right_to_the_last_digit();
    root_is_in_the_right_half_plane();
    beams_hold_for_their_waves();
    rods_are_sines_and_keep_the_digits_of_what_decays();
    lane_knows_nothing_of_its_neighbours();
    return check_report("test_plain");
}
