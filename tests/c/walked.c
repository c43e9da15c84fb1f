/* A chain prepared for walking in memory of exactly its size, and what its dense matrices say. */
#include "walked.h"

#include "assembled/assemble.h"
#include "base/lapack.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static void must(bool holds, const char *what)
{
    if (holds)
        return;
    fprintf(stderr, "the test itself: %s\n", what);
    abort();
}

struct walked walked_make(const struct rd_chain *chain)
{
    struct walked walked = {0};
    rd_walk_fill(chain, &walked.workspace, &walked.walk);
    walked.workspace = exact_workspace(walked.workspace.used);
    must(rd_walk_fill(chain, &walked.workspace, &walked.walk) == RD_OK, "no walk of this chain");
    return walked;
}

void walked_free(struct walked *walked)
{
    free(walked->workspace.base);
}

/* rows and columns of the free coordinates */
static double *only_free(const struct rd_chain *chain, const double *part, size_t *n)
{
    const size_t w = chain->width, all = chain->nodes * w;
    double *dense = rope_dense(chain, part);
    bool *is_free = calloc(all, sizeof *is_free);
    must(is_free != NULL, "out of memory");
    *n = 0;
    for (size_t i = 0; i < all; i++) {
        is_free[i] = !chain->held[(size_t)chain->term_of[i / w] * w + i % w];
        *n += is_free[i];
    }
    double *A = zeros(*n * *n);
    size_t at = 0;
    for (size_t i = 0; i < all; i++)
        for (size_t j = 0; j < all; j++)
            if (is_free[i] && is_free[j])
                A[at++] = dense[i * all + j];
    free(is_free);
    free(dense);
    return A;
}

/* A (n, n), destroyed: its eigenvalues (n), increasing */
static double *eigenvalues(size_t n, double *A)
{
    double *value = zeros(n), *work = zeros(8 * n);
    must(LAPACKE_dsyev_work(LAPACK_COL_MAJOR, 'N', 'U', (int)n, A, (int)n, value, work,
                            8 * (int)n) == 0,
         "no eigenvalues");
    free(work);
    return value;
}

/* A_ij <- A_ij s_i s_j */
static void scale(size_t n, const double *s, double *A)
{
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < n; j++)
            A[i * n + j] *= s[i] * s[j];
}

size_t dense_count(const struct rd_chain *chain, double lambda, double *nearest)
{
    static const double stiffness[RD_PARTS] = {[RD_ELASTIC] = 1, [RD_STRING] = 1, [RD_SPRINGS] = 1};
    static const double inertia[RD_PARTS] = {[RD_MASS] = 1};
    size_t n, count = 0;
    double *A = only_free(chain, stiffness, &n);
    double *M = only_free(chain, inertia, &n);
    double *s = zeros(n);
    for (size_t i = 0; i < n; i++) {
        s[i] = 1 / sqrt(fabs(A[i * (n + 1)]) + fabs(lambda * M[i * (n + 1)]));
        for (size_t j = 0; j < n; j++)
            A[i * n + j] -= lambda * M[i * n + j];
    }
    scale(n, s, A);
    double *value = eigenvalues(n, A);
    *nearest = INFINITY;
    for (size_t i = 0; i < n; i++) {
        count += value[i] < 0;
        *nearest = fmin(*nearest, fabs(value[i]));
    }
    free(value);
    free(s);
    free(M);
    free(A);
    return count;
}

double *dense_modes(const struct rd_chain *chain, size_t *n)
{
    static const double stiffness[RD_PARTS] = {[RD_ELASTIC] = 1, [RD_STRING] = 1, [RD_SPRINGS] = 1};
    static const double inertia[RD_PARTS] = {[RD_MASS] = 1};
    double *A = only_free(chain, stiffness, n);
    double *M = only_free(chain, inertia, n);
    double *s = zeros(*n);
    for (size_t i = 0; i < *n; i++) {
        must(M[i * (*n + 1)] > 0, "a free coordinate without mass");
        s[i] = 1 / sqrt(M[i * (*n + 1)]);
    }
    scale(*n, s, A);
    double *value = eigenvalues(*n, A);
    free(s);
    free(M);
    free(A);
    return value;
}
