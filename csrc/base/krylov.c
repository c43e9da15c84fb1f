/* Krylov's functions, of which the motion of beams is made. */
#include "base/krylov.h"

#include <math.h>

/* the series is summed below, |x| = 2, where closed forms cancel */
static const double SMALL = 64;

enum { TERMS = 14 }; /* SMALL^14/56! is nothing beside 1/4! */

static double _Complex fourth_root(double _Complex p)
{
    return csqrt(csqrt(p));
}

/* by Horner: 1/j! (1 + p/((j + 1) .. (j + 4)) (1 + ..)) */
static double _Complex series(double _Complex p, int j)
{
    static const double factorial[] = {1, 1, 2, 6, 24};
    double _Complex sum = 1;
    for (int n = TERMS; n > 0; n--) {
        const double a = 4 * n + j;
        sum = 1 + p * sum / (a * (a - 1) * (a - 2) * (a - 3));
    }
    return sum / factorial[j];
}

/* half of exp(x - growth) -+ exp(-x - growth) */
static double _Complex odd(double _Complex x, double _Complex growth)
{
    return (cexp(x - growth) - cexp(-x - growth)) / 2;
}

static double _Complex even(double _Complex x, double _Complex growth)
{
    return (cexp(x - growth) + cexp(-x - growth)) / 2;
}

/* p = P^4 */
static void unfold(double _Complex P, double _Complex growth, struct rd_krylov *k)
{
    const double _Complex C = even(P, growth), S = odd(P, growth);
    const double _Complex c = even(I * P, growth), s = odd(I * P, growth) / I;
    k->c[0] = (C + c) / 2;
    k->c[1] = (S + s) / (2 * P);
    k->c[2] = (C - c) / (2 * P * P);
    k->c[3] = (S - s) / (2 * P * P * P);
}

/* what cos x and sin x grow by, where it may be large: a small step of complex x leaves it 0 */
static double turning(double _Complex x)
{
    return fabs(cimag(x)) > 1 ? fabs(cimag(x)) : 0;
}

/* p = -4 x^4 */
static void fold(double _Complex x, double _Complex growth, struct rd_krylov *k)
{
    const double own = turning(x);
    const double _Complex C = even(x, growth - own), S = odd(x, growth - own);
    const double _Complex c = own > 0 ? even(I * x, own) : ccos(x);
    const double _Complex s = own > 0 ? odd(I * x, own) / I : csin(x);
    k->c[0] = c * C;
    k->c[1] = (c * S + s * C) / (2 * x);
    k->c[2] = s * S / (2 * x * x);
    k->c[3] = (s * C - c * S) / (4 * x * x * x);
}

struct rd_krylov rd_krylov(double _Complex p, double _Complex growth)
{
    struct rd_krylov k = {.one = cexp(-growth)};
    if (cabs(p) <= SMALL) {
        for (int j = 0; j < 5; j++)
            k.c[j] = series(p, j) * k.one;
        return k;
    }
    if (creal(p) < 0)
        fold(fourth_root(-p / 4), growth, &k);
    else
        unfold(fourth_root(p), growth, &k);
    k.c[4] = (k.c[0] - k.one) / p;
    return k;
}

static double _Complex series_slope(double _Complex p, int j)
{
    static const double factorial[] = {1, 1, 2, 6, 24};
    double _Complex sum = 1, slope = 0;
    for (int n = TERMS; n > 0; n--) {
        const double a = 4 * n + j, under = a * (a - 1) * (a - 2) * (a - 3);
        slope = (sum + p * slope) / under;
        sum = 1 + p * sum / under;
    }
    return slope / factorial[j];
}

/* P^j c_j has the derivative P^(j - 1) c_(j - 1) with respect to P, that of c_0 is P^3 c_3 */
struct rd_krylov rd_krylov_slope(double _Complex p, double _Complex growth)
{
    struct rd_krylov slope = {.one = 0};
    const struct rd_krylov k = rd_krylov(p, growth);
    for (int j = 0; j < 5; j++)
        slope.c[j] = cabs(p) <= SMALL
                         ? series_slope(p, j) * k.one
                         : (k.c[j == 0 ? 3 : j - 1] * (j == 0 ? p : 1) - j * k.c[j]) / (4 * p);
    return slope;
}

double _Complex rd_krylov_growth(double _Complex p)
{
    if (cabs(p) <= SMALL)
        return 0;
    if (creal(p) >= 0)
        return fourth_root(p) - sqrt(sqrt(SMALL));
    const double _Complex x = fourth_root(-p / 4);
    return x - 2 + turning(x);
}
