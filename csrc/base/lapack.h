/* The only door to LAPACKE. */
#ifndef RD_LAPACK_H
#define RD_LAPACK_H

#include "base/complex.h"
#undef I /* a name our formulas need */

#define lapack_complex_double double _Complex
#define lapack_complex_float float _Complex
#include <lapacke.h>

#ifdef scipy_LAPACKE_malloc /* the wheel's header: its symbols carry a prefix */
#define LAPACKE_dgbcon_work scipy_LAPACKE_dgbcon_work
#define LAPACKE_dgbtrf_work scipy_LAPACKE_dgbtrf_work
#define LAPACKE_dgbtrs_work scipy_LAPACKE_dgbtrs_work
#define LAPACKE_dgesvd_work scipy_LAPACKE_dgesvd_work
#define LAPACKE_dgetrf_work scipy_LAPACKE_dgetrf_work
#define LAPACKE_dgetrs_work scipy_LAPACKE_dgetrs_work
#define LAPACKE_dpbcon_work scipy_LAPACKE_dpbcon_work
#define LAPACKE_dpbtrf_work scipy_LAPACKE_dpbtrf_work
#define LAPACKE_dsyev_work scipy_LAPACKE_dsyev_work
#define LAPACKE_dsyevr_work scipy_LAPACKE_dsyevr_work
#define LAPACKE_dsytrf_work scipy_LAPACKE_dsytrf_work
#define LAPACKE_dtbtrs_work scipy_LAPACKE_dtbtrs_work
#define LAPACKE_zgbtrf_work scipy_LAPACKE_zgbtrf_work
#define LAPACKE_zgbtrs_work scipy_LAPACKE_zgbtrs_work
#define LAPACKE_zhseqr_work scipy_LAPACKE_zhseqr_work
#define openblas_set_num_threads scipy_openblas_set_num_threads
#endif

extern void openblas_set_num_threads(int threads) __attribute__((weak));

#endif
