/* LU of a complex band whose rows change places, column by column. */
#include "mixed/lu.h"

#include <math.h>

enum { EACH = 1 << 14 }; /* columns or nodes from one look for Ctrl-C to the next */

bool rd_lu_stops(const struct rd_lu *lu, size_t j)
{
    return j % EACH == 0 && rd_stop_is_asked(&lu->stop);
}

/* a - b c, of finite numbers */
static inline double _Complex less(double _Complex a, double _Complex b, double _Complex c)
{
    const double re = creal(b) * creal(c) - cimag(b) * cimag(c);
    const double im = creal(b) * cimag(c) + cimag(b) * creal(c);
    return CMPLX(creal(a) - re, cimag(a) - im);
}

static double size_of(double _Complex a)
{
    return fabs(creal(a)) + fabs(cimag(a));
}

/* entry (j, j), whose column goes on below it and whose row lies 3 reach apart */
static double _Complex *diagonal(const struct rd_lu *lu, size_t j)
{
    return lu->factor + j * (3 * lu->reach + 1) + 2 * lu->reach;
}

/* how many rows of the band lie below row j */
static size_t below(const struct rd_lu *lu, size_t j)
{
    return lu->size - 1 - j < lu->reach ? lu->size - 1 - j : lu->reach;
}

static size_t largest(const double _Complex *column, size_t count)
{
    size_t best = 0;
    for (size_t i = 1; i <= count; i++)
        if (size_of(column[i]) > size_of(column[best]))
            best = i;
    return best;
}

static void exchange(double _Complex *a, double _Complex *b)
{
    const double _Complex old = *a;
    *a = *b;
    *b = old;
}

enum rd_status rd_lu_factorise(struct rd_lu *lu)
{
    const size_t n = lu->size, apart = 3 * lu->reach;
    size_t right = 0; /* the last column that a row so far reaches */
    for (size_t j = 0; j < n; j++) {
        if (rd_lu_stops(lu, j))
            return RD_INTERRUPTED;
        double _Complex *const own = diagonal(lu, j);
        const size_t rows = below(lu, j), p = largest(own, rows);
        lu->pivot[j] = (int32_t)p;
        if (!(size_of(own[p]) > 0))
            return RD_SINGULAR;
        right = right > j + lu->reach + p ? right : j + lu->reach + p;
        right = right < n ? right : n - 1;
        exchange(own, own + p);
        const double _Complex per = 1 / own[0];
        for (size_t i = 1; i <= rows; i++)
            own[i] = less(0, own[i], -per);
        for (size_t c = 1; c <= right - j; c++) {
            double _Complex *const other = own + c * apart;
            exchange(other, other + p);
            for (size_t i = 1; i <= rows && *other != 0; i++)
                other[i] = less(other[i], own[i], *other);
        }
    }
    return RD_OK;
}

static void solve(const struct rd_lu *lu, double _Complex *x)
{
    for (size_t j = 0; j < lu->size; j++) {
        if (rd_lu_stops(lu, j))
            return;
        const double _Complex *own = diagonal(lu, j);
        exchange(x + j, x + j + lu->pivot[j]);
        for (size_t i = 1; i <= below(lu, j); i++)
            x[j + i] = less(x[j + i], own[i], x[j]);
    }
    for (size_t j = lu->size; j-- > 0;) {
        if (rd_lu_stops(lu, j))
            return;
        const double _Complex *own = diagonal(lu, j);
        const size_t above = j < 2 * lu->reach ? j : 2 * lu->reach;
        x[j] /= own[0];
        for (size_t i = 1; i <= above; i++)
            x[j - i] = less(x[j - i], *(own - i), x[j]);
    }
}

void rd_lu_solve(const struct rd_lu *lu, size_t columns, double _Complex *x)
{
    for (size_t c = 0; c < columns; c++)
        solve(lu, x + c * lu->size);
}
