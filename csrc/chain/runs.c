/* Finding the uniform runs of a chain. */
#include "chain/runs.h"

#include <math.h>

size_t rd_runs_capacity(const struct rd_chain *chain)
{
    const size_t most = chain->inertia ? chain->stretches : chain->nodes / RD_RUN_LEAST + 1;
    return chain->stretches < most ? chain->stretches : most;
}

/* a node that pieces cannot be joined across */
static int parts(const struct rd_chain *chain, int32_t term)
{
    const uint8_t *held = chain->held + (size_t)term * chain->width;
    int any = 0;
    for (size_t i = 0; i < chain->width; i++)
        any |= held[i] || (chain->hinge && chain->hinge[(size_t)term * chain->width + i] != 0.0);
    return any;
}

static void average(const struct rd_chain *chain, struct rd_runs *runs)
{
    double length = 0.0, tension = 0.0, sag = 0.0, flexibility[RD_CHANNELS] = {0},
           rope[RD_WIDTH_MAX] = {0};
    for (size_t k = 0; k + 1 < chain->stretches; k++) {
        const size_t e = (size_t)chain->element[k];
        const double l = (double)rd_stretch_nodes(chain, k) * chain->length[e];
        length += l;
        tension += l * chain->tension[e];
        sag += chain->sag ? l * chain->sag[e] : 0.0;
        for (size_t c = 0; c < RD_CHANNELS; c++)
            flexibility[c] += l * chain->flexibility[9 * e + 4 * c];
        for (size_t i = 0; chain->inertia && i < chain->width; i++)
            rope[i] += l * chain->inertia[e * chain->width + i];
    }
    runs->length = length;
    runs->tension = tension / length;
    runs->sag = sag / length;
    for (size_t c = 0; c < RD_CHANNELS; c++)
        runs->flexibility[c] = flexibility[c] / length;
    for (size_t i = 0; i < chain->width; i++)
        runs->mass[i] = rope[i] / length;
}

/* One mass of 1e12 among many must not set the scale of all: a geometric mean. Few logarithms of
   long products, which stay away from overflow. */
static void average_mass(const struct rd_chain *chain, struct rd_runs *runs)
{
    const size_t w = chain->width;
    for (size_t c = 0; c < w; c++) {
        if (runs->mass[c] > 0.0)
            continue;
        double sum = 0.0, nodes = 0.0, product = 1.0;
        for (size_t k = 0; k < chain->stretches; k++) {
            const double n = (double)rd_stretch_nodes(chain, k);
            const double m = fabs(chain->mass[(size_t)chain->term[k] * w * w + c * (w + 1)]);
            if (m == 0.0)
                continue;
            nodes += n;
            const double next = product * m;
            if (n == 1.0 && next > 1e-300 && next < 1e300) {
                product = next;
            } else {
                sum += log(product) + n * log(m);
                product = 1.0;
            }
        }
        sum += log(product);
        runs->mass[c] = nodes > 0.0 ? exp(sum / nodes) * nodes / runs->length : 0.0;
    }
}

/* every span: equal continuous elements with nothing between them */
static size_t find_spans(const struct rd_chain *chain, struct rd_run *run)
{
    size_t count = 0;
    for (size_t k = 0; k + 1 < chain->stretches; k++) {
        const int32_t e = chain->element[k];
        const size_t first = (size_t)chain->first[k], last = (size_t)chain->first[k + 1];
        if (count > 0 && run[count - 1].element == e && rd_term_is_bare(chain, chain->term[k]))
            run[count - 1].last = last;
        else
            run[count++] = (struct rd_run){first, last, e, RD_NO_TERM};
    }
    return count;
}

/* a stretch, and the node before it where the element on its right is the same */
static size_t find_stretches(const struct rd_chain *chain, struct rd_run *run)
{
    size_t count = 0, end = 0;
    for (size_t k = 0; k + 1 < chain->stretches; k++) {
        const int32_t e = chain->element[k], t = chain->term[k];
        size_t first = (size_t)chain->first[k];
        const size_t last = (size_t)chain->first[k + 1];
        if (first > end && chain->element[k - 1] == e)
            first--;
        if (last - first < RD_RUN_LEAST || parts(chain, t))
            continue;
        run[count++] = (struct rd_run){first, last, e, t};
        end = last;
    }
    return count;
}

void rd_runs_find(const struct rd_chain *chain, struct rd_run *run, struct rd_runs *runs)
{
    *runs = (struct rd_runs){
        .count = chain->inertia ? find_spans(chain, run) : find_stretches(chain, run),
        .least = chain->inertia ? 1 : RD_RUN_LEAST,
        .run = run,
    };
    average(chain, runs);
    average_mass(chain, runs);
    rd_body_find(chain, &runs->body);
}
