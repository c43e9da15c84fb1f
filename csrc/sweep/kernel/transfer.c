/* The triples of a whole continuous element, at several lambda or sections side by side. */
#include "sweep/kernel/transfer.h"

#include "graded/family.h"
#include "span/span.h"
#include "sweep/kernel/kernel.h"

#include <math.h>

#pragma GCC diagnostic ignored "-Wpsabi"

enum { W = RD_WIDTH_MAX, PACKED = W * W + 2 * RD_PAIRS_MAX };

static double largest(cv x)
{
    double most = 0;
    for (int k = 0; k < RD_LANES; k++)
        most = fmax(most, hypot(x.re[k], x.im[k]));
    return most;
}

/* a bound of the largest wavenumber: of a matrix its norm after scaling would do too, but entries of
   E are of different units, so the span's own (span/span.h) with the largest of each entry */
static double wavenumber(const struct rd_chain *chain, size_t e, const struct rate_matrix *rate)
{
    const size_t w = chain->width;
    const double *S = chain->flexibility + e * RD_CHANNELS * RD_CHANNELS;
    const bool bends = chain->coordinate[w - 1] == RD_BETA;
    struct rd_span span = {
        .width = w, .coordinate = chain->coordinate, .flexibility = S, .section = 1, .tension = 0};
    double softest = 0;
    for (size_t i = 0; i < w; i++) {
        const size_t c = (size_t)rd_channel_of(chain->coordinate[i]);
        span.load[i] = largest(rate->q[i]);
        if (chain->coordinate[i] != RD_Z)
            softest = fmax(softest, largest(rate->S[i][i]) / S[c * (RD_CHANNELS + 1)]);
        else if (!bends)
            span.tension = 1 / largest(rate->S[i][i]);
    }
    span.section = softest > 0 ? 1 / softest : 1;
    return rd_span_wavenumber(&span);
}

double rd_transfer_radians(const struct rd_chain *chain, size_t e, const struct rate_matrix *rate)
{
    return chain->length[e] * wavenumber(chain, e, rate);
}

static const struct sweep_kernel *const kernels[] = {&rd_sweep_kernel_1, &rd_sweep_kernel_2,
                                                     &rd_sweep_kernel_3, &rd_sweep_kernel_4};

void rd_transfer_slice(size_t width, const struct rate_matrix *rate, double l, int terms, cv *D,
                       cv *G, cv *Q)
{
    const size_t full = width * width, sym = width * (width + 1) / 2;
    cv triple[PACKED];
    kernels[width - 1]->make_span(rate, l, 0, terms, triple);
    for (size_t i = 0, p = full; i < width; i++)
        for (size_t j = 0; j < width; j++) {
            D[i * width + j] = triple[i * width + j];
            if (j < i)
                continue;
            G[i * width + j] = G[j * width + i] = triple[p];
            Q[i * width + j] = Q[j * width + i] = triple[sym + p++];
        }
}

/* one whose tension grows along it, from the pieces of its blocks */
static void graded(const struct rd_chain *chain, size_t e, const struct rate_matrix *rate,
                   const cv *part, cv *triple)
{
    const struct rd_field field = {
        .width = chain->width,
        .rate = rate,
        .tension = chain->tension[e],
        .pull = part[RD_STRING],
    };
    const struct rd_sizes sizes = {
        .section = 1 / largest(c_inverse(part[RD_ELASTIC])),
        .tension = largest(part[RD_STRING]),
        .inertia = largest(part[RD_MASS]),
        .dashpot = largest(part[RD_DASHPOTS]),
    };
    struct rd_block block[RD_BLOCKS_MOST];
    rd_family_whole(&field, rd_blocks_of(chain, e, &sizes, false, block), block, triple);
}

void rd_transfer_fill(const struct rd_chain *chain, size_t e, const cv *part,
                      struct rd_transfer *transfer)
{
    const size_t w = chain->width, full = w * w, sym = w * (w + 1) / 2;
    struct rate_matrix rate;
    cv triple[PACKED];
    rd_rate_fill(chain, e, part[RD_ELASTIC], part[RD_STRING], part[RD_MASS], part[RD_DASHPOTS],
                 &rate);
    if (rd_is_graded(chain, e)) {
        graded(chain, e, &rate, part, triple);
    } else {
        const double radians = rd_transfer_radians(chain, e, &rate);
        const int halvings = rd_span_halvings(radians, 1);
        kernels[w - 1]->make_span(&rate, chain->length[e], halvings,
                                  rd_span_terms(ldexp(radians, -halvings)), triple);
    }
    for (int lane = 0; lane < RD_LANES; lane++)
        for (size_t i = 0, p = 0; i < w; i++)
            for (size_t j = 0; j < w; j++) {
                const cv *d = triple + i * w + j;
                transfer->F[lane][i * w + j] = CMPLX(d->re[lane] + (i == j), d->im[lane]);
                if (j < i)
                    continue;
                const cv *g = triple + full + p, *q = g + sym;
                transfer->G[lane][i * w + j] = transfer->G[lane][j * w + i] =
                    CMPLX(g->re[lane], g->im[lane]);
                transfer->Q[lane][i * w + j] = transfer->Q[lane][j * w + i] =
                    CMPLX(q->re[lane], q->im[lane]);
                p++;
            }
}
