/* Assembled matrices of a chain: block tridiagonal, in parts that damping scales apart. */
#include "assembled/assemble.h"

#include "chain/attached.h"
#include "chain/elements.h"
#include "element/element.h"
#include "element/stiffness.h"

#include <assert.h>
#include <string.h>

enum { N = 2 * RD_WIDTH_MAX };

/* adds K (2 width, 2 width) over nodes i and i + 1 */
static void add_element(const struct rd_blocks *blocks, size_t i, size_t width, const double *K)
{
    const size_t block = width * width;
    for (size_t a = 0; a < width; a++)
        for (size_t b = 0; b < width; b++) {
            const size_t ab = a * width + b;
            blocks->diagonal[i * block + ab] += K[a * 2 * width + b];
            blocks->diagonal[(i + 1) * block + ab] += K[(width + a) * 2 * width + width + b];
            blocks->coupling[i * block + ab] = K[a * 2 * width + width + b];
        }
}

/* real and imaginary part at complex factors; with factor NULL the elastic and the tension part */
static enum rd_status find_element(const struct rd_element *element, const double _Complex *factor,
                                   double *elastic, double *string)
{
    double _Complex K[N * N];
    if (factor == NULL)
        return rd_element_stiffness(element, elastic, string);
    const enum rd_status status =
        rd_element_matrix(element, factor[RD_ELASTIC], factor[RD_STRING], factor[RD_SPRINGS], K);
    for (size_t k = 0; k < 4 * element->width * element->width; k++) {
        elastic[k] = creal(K[k]);
        string[k] = cimag(K[k]);
    }
    return status;
}

static enum rd_status add_elements(const struct rd_chain *chain, const double _Complex *factor,
                                   struct rd_assembly *assembly)
{
    double elastic[N * N], string[N * N];
    for (size_t k = 0; k + 1 < chain->stretches; k++) {
        const struct rd_element element = rd_chain_span(chain, k);
        const enum rd_status status = find_element(&element, factor, elastic, string);
        if (status != RD_OK)
            return status;
        for (size_t i = (size_t)chain->first[k]; i < (size_t)chain->first[k + 1]; i++) {
            add_element(&assembly->elastic, i, chain->width, elastic);
            add_element(&assembly->string, i, chain->width, string);
        }
    }
    return RD_OK;
}

/* what nodes carry, real and imaginary part like that of the elements */
static void add_attached(const struct rd_chain *chain, const double _Complex *factor,
                         struct rd_assembly *assembly)
{
    const size_t block = chain->width * chain->width;
    for (size_t k = 0; k < chain->stretches; k++) {
        double _Complex D[RD_WIDTH_MAX * RD_WIDTH_MAX] = {0};
        const size_t node = (size_t)chain->first[k];
        rd_attached_add(chain, (size_t)chain->term[k], factor[RD_MASS], factor[RD_DASHPOTS], D);
        for (size_t i = 0; i < block; i++) {
            assembly->elastic.diagonal[node * block + i] += creal(D[i]);
            assembly->string.diagonal[node * block + i] += cimag(D[i]);
        }
    }
}

enum rd_status rd_assemble_elements(const struct rd_chain *chain, const double _Complex *factor,
                                    struct rd_assembly *assembly)
{
    const size_t bytes = chain->nodes * chain->width * chain->width * sizeof(double);
    memset(assembly->elastic.diagonal, 0, bytes);
    memset(assembly->string.diagonal, 0, bytes);
    if (factor != NULL && chain->attached > 0)
        add_attached(chain, factor, assembly);
    return add_elements(chain, factor, assembly);
}

enum rd_status rd_assemble(const struct rd_chain *chain, struct rd_assembly *assembly)
{
    const size_t block = chain->width * chain->width;
    assert(chain->nodes > 1 && chain->width > 0 && chain->width <= RD_WIDTH_MAX);
    assembly->nodes = chain->nodes;
    assembly->width = chain->width;
    for (size_t i = 0; i < chain->nodes; i++) {
        const size_t term = (size_t)chain->term_of[i] * block;
        memcpy(assembly->springs + i * block, chain->stiffness + term, block * sizeof(double));
        memcpy(assembly->mass + i * block, chain->mass + term, block * sizeof(double));
        if (chain->damping)
            memcpy(assembly->dashpots + i * block, chain->damping + term, block * sizeof(double));
        else
            memset(assembly->dashpots + i * block, 0, block * sizeof(double));
    }
    return rd_assemble_elements(chain, NULL, assembly);
}
