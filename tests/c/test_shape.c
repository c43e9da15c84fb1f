/* Shape functions against closed forms in long double, both sides of where the series ends. */
#include "base/complex.h"
#include "check.h"
#include "element/shape.h"

#pragma GCC diagnostic ignored "-Wpsabi"

static cv lanes_of(double complex x)
{
    cv v = {{0}, {0}};
    for (int i = 0; i < RD_LANES; i++) {
        v.re[i] = creal(x);
        v.im[i] = cimag(x);
    }
    return v;
}

static void near_by(cv value, double complex exact, double operations)
{
    for (int i = 0; i < RD_LANES; i++)
        CHECK_ABS(cabs(CMPLX(value.re[i], value.im[i]) - exact), 0.0,
                  operations * EPS * cabs(exact), "so many operations");
}

static void near(cv value, double complex exact)
{
    near_by(value, exact, 8.0);
}

static void test_tensed(double complex phi, double s)
{
    struct shape_lanes p;
    struct shape_series series;
    shape_prepare(lanes_of(phi), &series);
    shape_functions(RD_TENSED, &series, s, &p);
    const double complex theta = phi * s;
    const long double complex x = theta, t = csqrtl(x);
    const long double complex tau = ctanhl(t) / t;
    near(p.tau, (double complex)tau);
    near(p.P0, (double complex)tau);
    if (cabs(theta) > 1e-3) {
        const long double complex h = csinhl(t / 2);
        near(p.P1, (double complex)(2 * h * h / (ccoshl(t) * x)));
        /* valgrind computes long double as double: 1 - tau cancels */
        near_by(p.P2, (double complex)((1 - tau) / x), 8.0 + 8.0 / cabs(theta));
    } else {
        near(p.P1, (double complex)(0.5L - 5 * x / 24 + 61 * x * x / 720));
        near(p.P2, (double complex)(1 / 3.0L - 2 * x / 15 + 17 * x * x / 315));
    }
}

static void test_rigid(double complex theta)
{
    struct shape_lanes p;
    struct shape_series series;
    shape_prepare(lanes_of(theta), &series);
    shape_functions(RD_RIGID, &series, 1.0, &p);
    const double complex q = 1.0 + theta / 3.0;
    near(p.tau, 1.0 / q);
    near(p.P0, (1.0 + theta / 12.0) / q);
    near(p.P1, 0.5 / q);
    near(p.P2, 1.0 / (3.0 * q));
}

int main(void)
{
    /* both sides of where the series has more terms and of where it ends */
    static const double size[] = {1e-9, 1e-5,  1.0 / 512, 1.001 / 512, 1.0 / 64, 1.001 / 64,
                                  0.2,  0.999, 1.001,     7.0,         1e3,      1e5};
    for (size_t i = 0; i < sizeof size / sizeof *size; i++)
        for (int k = -2; k <= 2; k++) {
            const double complex turn = CMPLX(cos(0.7 * k), sin(0.7 * k));
            test_tensed(size[i] * turn, 1.0);
            test_tensed(turn, size[i]);
            test_rigid(size[i] * turn);
        }
    return check_report("shape");
}
