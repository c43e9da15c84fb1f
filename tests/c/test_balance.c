/* Harmonic balance: slopes by harmonics against sums over all of them, stops against their law. */
#include "balance/balance.h"

#include <math.h>

#include "check.h"

enum { POINTS = 2, HARMONICS = 3, PITCH = POINTS + 1, ORDERS = 2 * HARMONICS + 2 };
enum { WIDTH = 2 * HARMONICS + 1, UNKNOWNS = POINTS * WIDTH };

struct random_balance {
    double _Complex transfer[(HARMONICS + 1) * POINTS * PITCH];
    double _Complex by_u[POINTS * POINTS * ORDERS], by_v[POINTS * POINTS * ORDERS];
    struct rd_balance balance;
};

static void draw(double _Complex *to, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        const double re = check_random(), im = check_random();
        to[i] = CMPLX(re, im);
    }
}

static void random_balance(struct random_balance *given)
{
    draw(given->transfer, sizeof given->transfer / sizeof *given->transfer);
    draw(given->by_u, sizeof given->by_u / sizeof *given->by_u);
    draw(given->by_v, sizeof given->by_v / sizeof *given->by_v);
    /* of real slopes the mean is real */
    for (size_t pair = 0; pair < POINTS * POINTS; pair++) {
        given->by_u[pair * ORDERS] = creal(given->by_u[pair * ORDERS]);
        given->by_v[pair * ORDERS] = creal(given->by_v[pair * ORDERS]);
    }
    given->balance = (struct rd_balance){.points = POINTS,
                                         .harmonics = HARMONICS,
                                         .omega = 1.75,
                                         .transfer = given->transfer,
                                         .pitch = PITCH,
                                         .by_u = given->by_u,
                                         .by_v = given->by_v,
                                         .orders = ORDERS};
}

/* harmonic l of -K..K of a point, from the unknowns */
static double _Complex harmonic(const double *x, size_t point, int l)
{
    const double *own = x + point * WIDTH;
    const int k = abs(l);
    const double im = k == 0 ? 0 : own[HARMONICS + k];
    return CMPLX(own[k], l < 0 ? -im : im);
}

static double _Complex slope(const double _Complex *series, int order)
{
    return order < 0 ? conj(series[-order]) : series[order];
}

/* q_k - H_k times the harmonic k of the forces, term by term */
static double _Complex left(const struct rd_balance *b, const double *x, size_t i, int k)
{
    double _Complex gap = harmonic(x, i, k);
    for (size_t p = 0; p < POINTS; p++)
        for (size_t j = 0; j < POINTS; j++)
            for (int l = -HARMONICS; l <= HARMONICS; l++) {
                const size_t pair = (p * POINTS + j) * ORDERS;
                const double _Complex turn = CMPLX(0, l * b->omega);
                double _Complex whole = slope(b->by_u + pair, k - l);
                if (b->by_v != NULL)
                    whole += turn * slope(b->by_v + pair, k - l);
                gap -=
                    b->transfer[((size_t)k * POINTS + i) * PITCH + p] * whole * harmonic(x, j, l);
            }
    return gap;
}

static void jacobian_is_the_sum_over_all_harmonics(bool turns)
{
    struct random_balance given;
    random_balance(&given);
    if (!turns)
        given.balance.by_v = NULL;
    double work[4 * POINTS * POINTS], jacobian[UNKNOWNS * UNKNOWNS], x[UNKNOWNS];
    rd_balance_jacobian(&given.balance, work, jacobian);
    for (size_t n = 0; n < UNKNOWNS; n++)
        x[n] = check_random();
    for (size_t i = 0; i < POINTS; i++)
        for (int k = 0; k <= HARMONICS; k++) {
            double re = 0, im = 0;
            const double *row = jacobian + (i * WIDTH + (size_t)k) * UNKNOWNS;
            for (size_t n = 0; n < UNKNOWNS; n++) {
                re += row[n] * x[n];
                im += k > 0 ? row[HARMONICS * UNKNOWNS + n] * x[n] : 0;
            }
            const double _Complex exact = left(&given.balance, x, i, k);
            CHECK_ABS(re, creal(exact), 1e-13, "sums of some 50 numbers of up to 10");
            if (k > 0)
                CHECK_ABS(im, cimag(exact), 1e-13, "sums of some 50 numbers of up to 10");
        }
}

static void stop_pushes_as_deep_as_it_is_entered(void)
{
    enum { SAMPLES = 4 };
    const struct rd_balance_stop stop = {.stiffness = 8, .gap = 0.5, .side = -1, .step = 0.25};
    /* away from it, deep in it, and where it is touched in the middle of a sample */
    const double u[SAMPLES] = {0.5, -2.5, -0.5, 0.5}, v[SAMPLES] = {0, 0, 4, 0};
    double force[SAMPLES] = {1}, by_u[SAMPLES] = {0}, by_v[SAMPLES] = {0};
    rd_balance_stopped(&stop, SAMPLES, u, v, force, by_u, by_v);
    CHECK_EXACT(force[0], 1); /* added to what there is */
    CHECK_EXACT(by_u[0], 0);
    CHECK_EXACT(force[1], 16); /* side -1: pushes up, 8 times 2 */
    CHECK_EXACT(by_u[1], -8);
    CHECK_EXACT(by_v[1], 0);
    /* v changes by 4 at most: 1 is what it moves by where it turns */
    const double passing = hypot(4, 1), w = passing * 0.125;
    CHECK_REL(force[2], 8 * 0.25 * w, 8 * EPS, "a few products");
    CHECK_EXACT(by_u[2], -4);
    CHECK_REL(by_v[2], 0.25 * 4 / passing * 8 * 0.125, 8 * EPS, "a few products");
}

/* the slopes are those of the force where velocities do not turn */
static void slopes_are_those_of_the_force(void)
{
    enum { SAMPLES = 2 };
    const struct rd_balance_stop stop = {.stiffness = 3, .gap = 0.5, .side = 1, .step = 0.25};
    const double h = 0x1p-20, v[SAMPLES] = {2, 2};
    for (double a = -0.2; a < 0.3; a += 0.03125) {
        double force[3][SAMPLES] = {{0}}, by_u[SAMPLES] = {0}, by_v[SAMPLES] = {0};
        for (int side = -1; side <= 1; side++) {
            double none[2][SAMPLES] = {{0}};
            const double u[SAMPLES] = {0.5 + a + side * h, 0};
            const bool is_own = side == 0;
            rd_balance_stopped(&stop, SAMPLES, u, v, force[side + 1], is_own ? by_u : none[0],
                               is_own ? by_v : none[1]);
        }
        CHECK_ABS((force[2][0] - force[0][0]) / (2 * h), by_u[0], 1e-5,
                  "where contact begins h shows: k h/4w, 12 h");
    }
}

int main(void)
{
    jacobian_is_the_sum_over_all_harmonics(true);
    jacobian_is_the_sum_over_all_harmonics(false);
    stop_pushes_as_deep_as_it_is_entered();
    slopes_are_those_of_the_force();
    return check_report("test_balance");
}
