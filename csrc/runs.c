/* Finding the uniform runs of a chain. */
#include "runs.h"

#include <math.h>

size_t rd_runs_capacity(const struct rd_chain *chain)
{
    return chain->nodes / RD_RUN_LEAST + 1;
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

/* the end of the uniform stretch that begins with element `first` */
static size_t run_end(const struct rd_chain *chain, size_t first)
{
    const size_t elements = chain->nodes - 1;
    const int32_t e = chain->element_of[first];
    size_t last = first + 1;
    if (last >= elements || parts(chain, chain->term_of[last]))
        return last;
    const int32_t t = chain->term_of[last];
    while (last < elements && chain->element_of[last] == e && chain->term_of[last] == t)
        last++;
    return last;
}

static void average(const struct rd_chain *chain, struct rd_runs *runs)
{
    double length = 0.0, tension = 0.0, flexibility[RD_CHANNELS] = {0};
    for (size_t i = 0; i + 1 < chain->nodes; i++) {
        const size_t e = (size_t)chain->element_of[i];
        const double l = chain->length[e];
        length += l;
        tension += l * chain->tension[e];
        for (size_t c = 0; c < RD_CHANNELS; c++)
            flexibility[c] += l * chain->flexibility[9 * e + 4 * c];
    }
    runs->length = length;
    runs->tension = tension / length;
    for (size_t c = 0; c < RD_CHANNELS; c++)
        runs->flexibility[c] = flexibility[c] / length;
}

/* one mass of 1e12 among many must not set the scale of all: a geometric mean */
static void average_mass(const struct rd_chain *chain, struct rd_runs *runs)
{
    const size_t w = chain->width;
    for (size_t c = 0; c < w; c++) {
        double sum = 0.0, nodes = 0.0, last = 0.0;
        int32_t before = -1;
        for (size_t i = 0; i < chain->nodes; i++) {
            const int32_t t = chain->term_of[i];
            const double m = fabs(chain->mass[(size_t)t * w * w + c * (w + 1)]);
            if (t != before)
                last = m > 0.0 ? log(m) : 0.0;
            before = t;
            sum += last;
            nodes += m > 0.0;
        }
        runs->mass[c] = nodes > 0.0 ? exp(sum / nodes) * nodes / runs->length : 0.0;
    }
}

void rd_runs_find(const struct rd_chain *chain, struct rd_run *run, struct rd_runs *runs)
{
    size_t count = 0, longest = 0;
    for (size_t first = 0; first + 1 < chain->nodes;) {
        const size_t last = run_end(chain, first);
        if (last - first >= RD_RUN_LEAST) {
            run[count++] = (struct rd_run){first, last};
            longest = last - first > longest ? last - first : longest;
        }
        first = last;
    }
    *runs = (struct rd_runs){.count = count, .longest = longest, .run = run};
    average(chain, runs);
    average_mass(chain, runs);
    rd_body_find(chain, &runs->body);
}
