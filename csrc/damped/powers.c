/* Numbers from the sums of their powers. */
#include "damped/powers.h"

#include "base/lapack.h"

#include <assert.h>
#include <math.h>
#include <string.h>

enum { MOST = RD_POWERS_MOST };

/* With k c_k = -(c_0 m_k + c_1 m_k-1 + .. + c_k-1 m_1) and c_0 = 1 they are the roots of
   c_0 x^n + c_1 x^(n-1) + .. + c_n, the eigenvalues of its companion. */
enum rd_status rd_powers_invert(size_t count, const double _Complex *moment, double _Complex *root)
{
    assert(count <= MOST);
    double _Complex c[MOST + 1] = {1}, companion[MOST * MOST], work[MOST], none;
    for (size_t k = 1; k <= count; k++) {
        double _Complex sum = 0;
        for (size_t i = 1; i <= k; i++)
            sum += c[k - i] * moment[i - 1];
        c[k] = -sum / (double)k;
        if (!isfinite(cabs(c[k])))
            return RD_NO_CONVERGENCE;
    }
    if (count == 1)
        root[0] = -c[1];
    if (count <= 1)
        return RD_OK;
    memset(companion, 0, count * count * sizeof *companion);
    for (size_t k = 0; k < count; k++) {
        companion[k * count] = -c[k + 1];
        if (k + 1 < count)
            companion[k * count + k + 1] = 1;
    }
    const int n = (int)count;
    const int failed = LAPACKE_zhseqr_work(LAPACK_COL_MAJOR, 'E', 'N', n, 1, n, companion, n, root,
                                           &none, 1, work, MOST);
    return failed ? RD_NO_CONVERGENCE : RD_OK;
}
