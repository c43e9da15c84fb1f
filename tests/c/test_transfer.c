/* The triples of continuous elements against their waves in closed form. */
#include "sweep/kernel/transfer.h"

#include "check.h"
#include "element/section.h"
#include "element/triple.h"

#include <string.h>

#pragma GCC diagnostic ignored "-Wpsabi"

enum { W = RD_WIDTH_MAX, LANES = RD_LANES };

static const struct rd_section laid = {
    .axial = 8.5e5, .torsion = 0.1485, .bending = 54.626, .coupling = 120, .slope = 0.3};

/* a rope of one element */
struct span {
    struct rd_chain chain;
    int32_t coordinate[W];
    double length, tension, flexibility[9], inertia[W];
};

static void span_make(struct span *span, const char *names, const struct rd_section *section,
                      double length, double tension, const double *inertia)
{
    static const char all[] = "xzab";
    memset(span, 0, sizeof *span);
    span->length = length;
    span->tension = tension;
    rd_section_flexibility(section, span->flexibility);
    span->chain = (struct rd_chain){.width = strlen(names),
                                    .distinct = 1,
                                    .kind = RD_CONTINUOUS,
                                    .coordinate = span->coordinate,
                                    .length = &span->length,
                                    .tension = &span->tension,
                                    .flexibility = span->flexibility,
                                    .inertia = span->inertia};
    for (size_t i = 0; i < span->chain.width; i++) {
        span->coordinate[i] = (int32_t)(strchr(all, names[i]) - all);
        span->inertia[i] = inertia[span->coordinate[i]];
    }
}

/* the complex factors of one element */
struct factors {
    double complex section, tension, inertia;
};

static cv lanes_of(double complex x)
{
    return c_add(c_real(creal(x)), c_imag(cimag(x)));
}

static void transfer_at(const struct span *span, struct factors factors,
                        struct rd_transfer *transfer)
{
    const cv part[RD_PARTS] = {lanes_of(factors.section), lanes_of(factors.tension), c_real(1),
                               lanes_of(factors.inertia), c_zero()};
    rd_transfer_fill(&span->chain, 0, part, transfer);
}

/* motion and force at the two ends of an element */
struct ends {
    double complex ua[W], fa[W], ub[W], fb[W];
};

/* That u_b = F u_a + G f_b and f_a = F^T f_b - Q u_a, to `tolerance` of what is summed; F is I + D. */
static void check_ends(size_t w, const struct rd_transfer *t, const struct ends *x,
                       double tolerance)
{
    for (size_t i = 0; i < w; i++) {
        double complex u = -x->ub[i], f = -x->fa[i];
        double most_u = cabs(u) + cabs(x->ua[i]), most_f = cabs(f) + cabs(x->fb[i]);
        for (size_t j = 0; j < w; j++) {
            const double complex part[] = {
                t->F[0][i * w + j] * x->ua[j], t->G[0][i * w + j] * x->fb[j],
                t->F[0][j * w + i] * x->fb[j], -t->Q[0][i * w + j] * x->ua[j]};
            u += part[0] + part[1];
            f += part[2] + part[3];
            most_u += cabs(part[0]) + cabs(part[1]);
            most_f += cabs(part[2]) + cabs(part[3]);
        }
        CHECK_ABS(cabs(u), 0, tolerance * most_u, "of the terms that cancel");
        CHECK_ABS(cabs(f), 0, tolerance * most_f, "of the terms that cancel");
    }
}

/* exp(r s) v, exp(r s) f at both ends */
static void check_wave(const struct span *span, const struct rd_transfer *t, double complex r,
                       const double complex *v, const double complex *f, double tolerance)
{
    struct ends x;
    const double complex grown = cexp(r * span->length);
    for (size_t i = 0; i < span->chain.width; i++) {
        x.ua[i] = v[i];
        x.fa[i] = f[i];
        x.ub[i] = grown * v[i];
        x.fb[i] = grown * f[i];
    }
    check_ends(span->chain.width, t, &x, tolerance);
}

static const struct factors damped = {1 + 0.02 * I, 1 + 0.003 * I, -1 + 0.01 * I};

/* what the factors of lambda are: it grows with the frequency, and motion that grows has it negative */
static struct factors at_lambda(struct factors factors, double lambda)
{
    factors.inertia *= lambda;
    return factors;
}

/* Rounding: an exponential series of 24 terms and joints, each some 10 EPS of what it sums, of which
   the triple of twice the length has twice: 2^halvings is at most twice the radians. */
static double rounding(double radians)
{
    return 64 * EPS * (1 + 2 * radians);
}

/* K u'' = q u: F = 1/cos(x), G = tan(x)/(K k), Q = -K k tan(x), x = k l, k^2 = -q/K */
static void rod_is_a_cosine_and_a_tangent(const char *names)
{
    static const double inertia[W] = {0.1, 0.1, 2e-6, 0};
    static const double radians[] = {1e-6, 1e-3, 0.3, 1, 1.5};
    struct span span;
    span_make(&span, names, &(struct rd_section){.axial = 8.5e5, .torsion = 0.1485}, 0.7, 300,
              inertia);
    const double stiffness = *names == 'z' ? 300 : *names == 'x' ? 8.5e5 : 0.1485;
    for (int n = 0; n < 5; n++)
        for (int k = 0; k < 3; k++) {
            const double x = radians[n] / 0.7, lambda = x * x * stiffness / span.inertia[0];
            const struct factors factors = k == 0   ? (struct factors){1, 1, -lambda}
                                           : k == 1 ? (struct factors){1, 1, lambda}
                                                    : at_lambda(damped, lambda);
            struct rd_transfer t;
            transfer_at(&span, factors, &t);
            const double complex K =
                stiffness * (*names == 'z' ? factors.tension : factors.section);
            const double complex wave = csqrt(-factors.inertia * span.inertia[0] / K);
            /* near pi/2 an error of x is one of 1/cos(x)^2 */
            const double allowed = rounding(radians[n]) / pow(cabs(ccos(wave * 0.7)), 2);
            const double complex value[] = {t.F[0][0], t.G[0][0], t.Q[0][0]};
            const double complex exact[] = {1 / ccos(wave * 0.7), ctan(wave * 0.7) / (K * wave),
                                            -K * wave * ctan(wave * 0.7)};
            for (int i = 0; i < 3; i++)
                CHECK_ABS(cabs(value[i] - exact[i]), 0, allowed * cabs(exact[i]),
                          "series and joints");
        }
}

/* With c, s, C, S the circular and hyperbolic functions of x = k l, k^4 = lambda mu/B, and
   d = 1 + c C, Krylov's functions give the cantilever

       F = | c + C      (s + S)/k |     B G = | (s C - c S)/k^3   s S/k^2       |
           | k (S - s)   c + C    |/d         | s S/k^2          (c S + s C)/k  |/d

       Q = -B | k^3 (s C + c S)   k^2 s S       |
              | k^2 s S           k (s C - c S) |/d */
static void beam_has_krylovs_functions(void)
{
    static const double inertia[W] = {0, 0.1, 0, 0};
    const double B = 54.626, l = 0.7;
    struct span span;
    span_make(&span, "zb", &(struct rd_section){.bending = B}, l, 0, inertia);
    for (double x = 0.5; x < 1.8; x += 0.1) {
        const double k = x / l, c = cos(x), s = sin(x), C = cosh(x), S = sinh(x), d = 1 + c * C;
        struct rd_transfer t;
        transfer_at(&span, (struct factors){1, 1, -B * k * k * k * k / 0.1}, &t);
        const double F[] = {c + C, (s + S) / k, k * (S - s), c + C};
        const double G[] = {(s * C - c * S) / (B * k * k * k), s * S / (B * k * k),
                            s * S / (B * k * k), (c * S + s * C) / (B * k)};
        const double Q[] = {-B * k * k * k * (s * C + c * S), -B * k * k * s * S,
                            -B * k * k * s * S, -B * k * (s * C - c * S)};
        /* s C - c S has lost 6 EPS of its digits at 0.5; an error of x has the condition x d'/d */
        const double allowed = rounding(x) * (1 + fabs(x * (c * S - s * C) / d));
        for (int i = 0; i < 4; i++) {
            CHECK_REL(creal(t.F[0][i]), F[i] / d, allowed, "series, joints and the pole");
            CHECK_REL(creal(t.G[0][i]), G[i] / d, allowed, "series, joints and the pole");
            CHECK_REL(creal(t.Q[0][i]), Q[i] / d, allowed, "series, joints and the pole");
        }
    }
}

/* B z'''' = q z'' + lambda mu z, q = T - lambda j: four waves exp(r s) with
   f = q r - B r^3 = -lambda mu/r, m = B r^2, for damping of any part and tension of any sign */
static void tensed_beam_has_its_four_waves(void)
{
    static const double tension[] = {0, 3, 700, 1e5, -20}, lambdas[] = {1e-3, 40, 900, -1e4, 0};
    static const double inertia[W] = {0, 0.1, 0, 2e-4};
    const double B = 54.626, l = 0.6;
    for (int n = 0; n < 5; n++)
        for (int k = 0; k < 5; k++)
            for (int with = 0; with < 2; with++) {
                struct span span;
                span_make(&span, "zb", &(struct rd_section){.bending = B}, l, tension[n], inertia);
                const double lambda = lambdas[k] != 0 ? lambdas[k] : 1e4;
                const struct factors factors =
                    with ? at_lambda(damped, lambda) : (struct factors){1, 1, -lambda};
                struct rd_transfer t;
                transfer_at(&span, factors, &t);
                const double complex b = B * factors.section, load = -factors.inertia * 0.1;
                const double complex q = tension[n] * factors.tension + factors.inertia * 2e-4;
                const double complex root = csqrt(q * q + 4 * b * load);
                for (int i = 0; i < 4; i++) {
                    /* the product of the two r^2 is -load/b: the smaller one without cancelling */
                    const bool same = creal(q * conj(root)) >= 0;
                    const double complex large = (same ? q + root : q - root) / (2 * b);
                    const double complex r2 = i < 2 ? large : -load / (b * large);
                    const double complex r = i % 2 ? csqrt(r2) : -csqrt(r2);
                    const double complex v[] = {1, r}, f[] = {-load / r, b * r2};
                    check_wave(&span, &t, r, v, f, rounding(l * cabs(csqrt(large))));
                }
            }
}

/* S M v = (k^2/lambda) v for axial motion and twist coupled by the lay: f = S^-1 v' */
static void laid_rope_has_two_waves_of_stretch_and_twist(void)
{
    static const double inertia[W] = {0.1, 0, 2e-6, 0};
    struct span span;
    span_make(&span, "xa", &laid, 0.3, 300, inertia);
    const double *S = span.flexibility, l = 0.3;
    const double a = S[0] * 0.1, b = S[1] * 2e-6, c = S[3] * 0.1, d = S[4] * 2e-6;
    const double stiffness = S[0] * S[4] - S[1] * S[3];
    for (int n = 0; n < 4; n++) {
        const double lambda = pow(10, 3 + n);
        struct rd_transfer t;
        transfer_at(&span, (struct factors){1, 1, -lambda}, &t);
        for (int i = 0; i < 4; i++) {
            const double root = hypot(a - d, 2 * sqrt(b * c));
            const double theta = (a + d + (i < 2 ? root : -root)) / 2;
            const double complex r = (i % 2 ? -I : I) * sqrt(lambda * theta);
            /* the row of (S M - theta) whose entries are not small */
            const bool first = fabs(a - theta) > fabs(d - theta);
            const double v0 = first ? b : theta - d, v1 = first ? theta - a : c;
            const double complex v[] = {v0, v1};
            const double complex f[] = {r * (S[4] * v0 - S[1] * v1) / stiffness,
                                        r * (S[0] * v1 - S[3] * v0) / stiffness};
            /* the determinant of S and theta cancel by what S is coupled, 1/(1 - D^2/EA C) */
            check_wave(&span, &t, r, v, f,
                       rounding(l * cabs(r)) * S[0] * S[4] / stiffness * a / fmin(a, d));
        }
    }
}

static const double everywhere[W] = {0.1, 0.1, 2e-6, 3e-5};

static const char *const names[] = {"x", "z", "a", "xz", "za", "zb", "xa", "zab", "xzb", "xzab"};

enum { NAMES = sizeof names / sizeof *names };

/* u_a, f_b at random of the size of the element, u_b and f_a by its triple */
static void random_ends(size_t w, const struct rd_transfer *t, struct ends *x)
{
    for (size_t i = 0; i < w; i++) {
        x->ua[i] = check_random() * sqrt(cabs(t->G[0][i * (w + 1)]));
        x->fb[i] = check_random() / sqrt(cabs(t->G[0][i * (w + 1)]));
    }
    for (size_t i = 0; i < w; i++) {
        x->ub[i] = x->fa[i] = 0;
        for (size_t j = 0; j < w; j++) {
            x->ub[i] += t->F[0][i * w + j] * x->ua[j] + t->G[0][i * w + j] * x->fb[j];
            x->fa[i] += t->F[0][j * w + i] * x->fb[j] - t->Q[0][i * w + j] * x->ua[j];
        }
    }
}

/* Half a turn about z changes the ends: u -> D u, and what was pulled pulls, f -> -D f. */
static void element_is_the_same_from_both_ends(const char *coordinates)
{
    struct span span;
    struct rd_transfer t;
    struct ends x, turned;
    span_make(&span, coordinates, &laid, 0.1, 300, everywhere);
    for (int n = 0; n < 7; n++) {
        transfer_at(&span, at_lambda(damped, n == 0 ? -1e4 : pow(10, n)), &t);
        random_ends(span.chain.width, &t, &x);
        for (size_t i = 0; i < span.chain.width; i++) {
            const double d = span.coordinate[i] == RD_Z ? 1 : -1;
            turned.ua[i] = d * x.ub[i];
            turned.ub[i] = d * x.ua[i];
            turned.fa[i] = -d * x.fb[i];
            turned.fb[i] = -d * x.fa[i];
        }
        /* at most 3 radians; the random ends lose what F and its inverse differ, some 10 */
        check_ends(span.chain.width, &t, &turned, 16 * rounding(3));
    }
}

/* x <- A^-1 x by Gauss with pivots, A destroyed */
static void divide(size_t w, double complex A[W][W], double complex *x)
{
    for (size_t c = 0; c < w; c++) {
        size_t best = c;
        for (size_t i = c; i < w; i++)
            best = cabs(A[i][c]) > cabs(A[best][c]) ? i : best;
        for (size_t j = 0; j < w; j++) {
            const double complex swap = A[c][j];
            A[c][j] = A[best][j];
            A[best][j] = swap;
        }
        const double complex swap = x[c];
        x[c] = x[best];
        x[best] = swap;
        for (size_t i = 0; i < w; i++) {
            const double complex share = i == c ? 0 : A[i][c] / A[c][c];
            x[i] -= share * x[c];
            for (size_t j = 0; j < w; j++)
                A[i][j] -= share * A[c][j];
        }
    }
    for (size_t c = 0; c < w; c++)
        x[c] /= A[c][c];
}

/* f_b of the first goes on: f_c = F^-T (f_b + Q u_b), u_c = F u_b + G f_c */
static void two_elements_are_one_of_both_lengths(const char *coordinates)
{
    struct span span;
    struct rd_transfer t, whole;
    struct ends x, both;
    for (int n = 0; n < 6; n++) {
        const struct factors factors = at_lambda(damped, n == 0 ? -1e4 : pow(10, n));
        span_make(&span, coordinates, &laid, 0.05, 300, everywhere);
        transfer_at(&span, factors, &t);
        span.length = 0.1;
        transfer_at(&span, factors, &whole);
        const size_t w = span.chain.width;
        double complex A[W][W];
        random_ends(w, &t, &x);
        both = x;
        for (size_t i = 0; i < w; i++) {
            both.fb[i] = x.fb[i];
            for (size_t j = 0; j < w; j++) {
                A[i][j] = t.F[0][j * w + i];
                both.fb[i] += t.Q[0][i * w + j] * x.ub[j];
            }
        }
        divide(w, A, both.fb);
        for (size_t i = 0; i < w; i++) {
            both.ub[i] = 0;
            for (size_t j = 0; j < w; j++)
                both.ub[i] += t.F[0][i * w + j] * x.ub[j] + t.G[0][i * w + j] * both.fb[j];
        }
        check_ends(w, &whole, &both, 16 * rounding(3));
    }
}

/* at lambda = 0 it is the static element with tension, whatever the factors, straight or hanging */
static void element_at_rest_is_the_tensed_one(const char *coordinates, double tension, double sag)
{
    struct span span;
    struct rd_transfer t;
    double complex F[W * W], G[W * W], Q[W * W];
    span_make(&span, coordinates, &laid, 0.1, tension, everywhere);
    span.chain.sag = sag != 0 ? &sag : NULL;
    transfer_at(&span, (struct factors){damped.section, damped.tension, 0}, &t);
    const struct rd_element element = {.kind = RD_TENSED,
                                       .width = span.chain.width,
                                       .coordinate = span.coordinate,
                                       .length = 0.1,
                                       .tension = tension,
                                       .sag = sag,
                                       .flexibility = span.flexibility};
    CHECK_INT(rd_triple(&element, damped.section, damped.tension, F, G, Q), RD_OK);
    const size_t w = span.chain.width;
    const double radians = 0.1 * sqrt(tension * span.flexibility[8]);
    for (size_t i = 0; i < w; i++)
        for (size_t j = 0; j < w; j++) {
            const size_t at = i * w + j;
            /* of the entries' units, and a share of the larger ones that lay couples to */
            const double ui = sqrt(cabs(G[i * (w + 1)])), uj = sqrt(cabs(G[j * (w + 1)]));
            const double allowed = 4 * rounding(radians);
            CHECK_ABS(cabs(t.F[0][at] - F[at]), 0, allowed * (ui / uj + cabs(F[at])), "joints");
            CHECK_ABS(cabs(t.G[0][at] - G[at]), 0, allowed * ui * uj, "joints");
            CHECK_ABS(cabs(t.Q[0][at] - Q[at]), 0, allowed * (1 / (ui * uj)), "joints");
        }
}

/* Bending alone is summed by four series of its own (span/beam_slice.h), beside twist by the
   general one, which must agree with it; axial motion and twist, unless they are coupled, do not
   see it. */
static void bending_is_the_same_alone_and_beside_twist(void)
{
    static const double lambdas[] = {-1e4, 0, 1, 1e3, 3e4};
    const struct rd_section straight = {.axial = 8.5e5, .torsion = 0.1485, .bending = 54.626};
    for (int n = 0; n < 5; n++)
        for (int k = 0; k < 3; k++) {
            static const double tension[] = {0, 300, 3e5};
            struct span alone, beside;
            struct rd_transfer one, three;
            span_make(&alone, "zb", &straight, 0.1, tension[k], everywhere);
            span_make(&beside, "zab", &straight, 0.1, tension[k], everywhere);
            transfer_at(&alone, at_lambda(damped, lambdas[n]), &one);
            transfer_at(&beside, at_lambda(damped, lambdas[n]), &three);
            for (int i = 0; i < 2; i++)
                for (int j = 0; j < 2; j++) {
                    const int a = 2 * i + j, b = 6 * i + 2 * j;
                    const double allowed = 2 * rounding(8);
                    CHECK_ABS(cabs(one.F[0][a] - three.F[0][b]), 0, allowed * cabs(one.F[0][a]),
                              "two series");
                    CHECK_ABS(cabs(one.G[0][a] - three.G[0][b]), 0, allowed * cabs(one.G[0][a]),
                              "two series");
                    CHECK_ABS(cabs(one.Q[0][a] - three.Q[0][b]), 0, allowed * cabs(one.Q[0][a]),
                              "two series");
                }
            for (int i = 0; i < 3; i++) {
                CHECK_EXACT(cabs(three.F[0][3 + i]), i == 1 ? cabs(three.F[0][4]) : 0);
                CHECK_EXACT(cabs(three.G[0][3 + i]), i == 1 ? cabs(three.G[0][4]) : 0);
                CHECK_EXACT(cabs(three.Q[0][3 + i]), i == 1 ? cabs(three.Q[0][4]) : 0);
            }
        }
}

/* each lane has factors of its own and is answered as if it were alone with its likes */
static void lanes_do_not_see_each_other(void)
{
    struct span span;
    struct rd_transfer together, alone;
    cv inertia = c_zero();
    span_make(&span, "xzab", &laid, 0.1, 300, everywhere);
    for (int k = 0; k < LANES; k++)
        inertia.re[k] = -1e3 * k;
    const cv part[RD_PARTS] = {c_real(1), c_real(1), c_real(1), inertia, c_zero()};
    rd_transfer_fill(&span.chain, 0, part, &together);
    for (int k = 0; k < LANES; k++) {
        transfer_at(&span, (struct factors){1, 1, -1e3 * k}, &alone);
        for (int i = 0; i < W * W; i++) {
            /* as many halvings as the shortest wave of all needs: other roundings */
            const double u = sqrt(cabs(alone.G[0][i / W * (W + 1)]));
            const double v = sqrt(cabs(alone.G[0][i % W * (W + 1)]));
            CHECK_ABS(cabs(together.G[k][i] - alone.G[0][i]), 0, 4 * rounding(2) * u * v, "joints");
        }
    }
}

int main(void)
{
    rod_is_a_cosine_and_a_tangent("x");
    rod_is_a_cosine_and_a_tangent("z");
    rod_is_a_cosine_and_a_tangent("a");
    beam_has_krylovs_functions();
    tensed_beam_has_its_four_waves();
    laid_rope_has_two_waves_of_stretch_and_twist();
    for (int n = 0; n < NAMES; n++) {
        element_is_the_same_from_both_ends(names[n]);
        two_elements_are_one_of_both_lengths(names[n]);
        element_at_rest_is_the_tensed_one(names[n], 300, 0);
        element_at_rest_is_the_tensed_one(names[n], 3e5, 0);
    }
    static const char *const hanging[] = {"xz", "xzb", "xzab"};
    for (int n = 0; n < 3; n++)
        for (int k = 0; k < 3; k++) {
            element_at_rest_is_the_tensed_one(hanging[n], 300, pow(10, -3 * k));
            element_at_rest_is_the_tensed_one(hanging[n], 3e5, -pow(10, -3 * k));
        }
    bending_is_the_same_alone_and_beside_twist();
    lanes_do_not_see_each_other();
    return check_report("test_transfer");
}
