/* The elements of a chain. */
#include "chain/elements.h"

#include <assert.h>

struct rd_element rd_chain_element(const struct rd_chain *chain, size_t i)
{
    assert(i < chain->distinct);
    return (struct rd_element){
        .kind = chain->kind,
        .width = chain->width,
        .coordinate = chain->coordinate,
        .length = chain->length[i],
        .tension = chain->tension[i],
        .sag = chain->sag ? chain->sag[i] : 0,
        .flexibility = chain->flexibility + i * RD_CHANNELS * RD_CHANNELS,
    };
}

bool rd_chain_is_hinged(const struct rd_chain *chain, int32_t term)
{
    const size_t w = chain->width;
    for (size_t a = 0; chain->hinge && a < w; a++)
        if (chain->hinge[(size_t)term * w + a] != 0)
            return true;
    return false;
}

struct rd_element rd_chain_span(const struct rd_chain *chain, size_t stretch)
{
    assert(stretch + 1 < chain->stretches);
    struct rd_element element = rd_chain_element(chain, (size_t)chain->element[stretch]);
    if (rd_chain_is_hinged(chain, chain->term[stretch]))
        element.hinge = chain->hinge + (size_t)chain->term[stretch] * chain->width;
    return element;
}
