/* How many modes a chain has. */
#include "chain/inertia.h"

#include "chain/attached.h"

#include "base/lapack.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>

enum { W = RD_WIDTH_MAX };

/* A <- A scaled so that no entry exceeds 1 and every inertia on the diagonal is 1 */
static void equilibrate(size_t n, double *A)
{
    double scale[W];
    for (size_t i = 0; i < n; i++) {
        const double own = fabs(A[i * n + i]);
        scale[i] = own > 0 ? 1 / sqrt(own) : 0;
    }
    for (size_t i = 0; i < n; i++) {
        double largest = 0;
        for (size_t j = 0; j < n; j++)
            largest = fmax(largest, fabs(A[i * n + j]) * (scale[j] > 0 ? scale[j] : 1));
        if (scale[i] == 0 && largest > 0)
            scale[i] = 1 / largest;
    }
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < n; j++)
            A[i * n + j] *= scale[i] * scale[j];
}

/* positive eigenvalues of A (n, n), n <= W, which is destroyed */
static size_t positive(size_t n, double *A)
{
    double value[W], work[8 * W];
    if (n == 0)
        return 0;
    equilibrate(n, A);
    LAPACKE_dsyev_work(LAPACK_COL_MAJOR, 'N', 'L', (int)n, A, (int)n, value, work, 8 * W);
    size_t count = 0;
    for (size_t i = 0; i < n; i++)
        count += value[i] > 8 * DBL_EPSILON;
    return count;
}

/* of one node: no inertia couples two */
static size_t positive_of_term(const struct rd_chain *chain, size_t term)
{
    const size_t w = chain->width;
    const double *mass = chain->mass + term * w * w;
    const uint8_t *held = chain->held + term * w;
    double A[W * W];
    size_t free[W], n = 0;
    for (size_t i = 0; i < w; i++)
        if (!held[i])
            free[n++] = i;
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < n; j++)
            A[i * n + j] = mass[free[i] * w + free[j]];
    return positive(n, A);
}

bool rd_inertia_is_endless(const struct rd_chain *chain)
{
    double most = 0;
    for (size_t i = 0; chain->inertia && i < chain->distinct * chain->width; i++)
        most = fmax(most, chain->inertia[i]);
    return most > 0;
}

size_t rd_inertia_positive(const struct rd_chain *chain)
{
    if (rd_inertia_is_endless(chain) || isinf(rd_attached_highest(chain)))
        return SIZE_MAX;
    size_t count = 0;
    for (size_t k = 0; k < chain->stretches; k++) {
        const size_t each = positive_of_term(chain, (size_t)chain->term[k]);
        count += rd_stretch_nodes(chain, k) * each;
        for (size_t j = rd_attached_first(chain, (size_t)chain->term[k]);
             rd_attached_is_of(chain, j, chain->term[k]); j++)
            count++;
    }
    return count;
}
