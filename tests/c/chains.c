/* Chains for tests: a uniform rope from a recipe, every array of its own exact size. */
#include "chains.h"

#include "assembled/assemble.h"
#include "chain/elements.h"
#include "element/element.h"
#include "element/stiffness.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char names[] = "xzab";

const struct recipe long_string = {
    .elements = 1000,
    .coordinates = "z",
    .length = 1e-3,
    .tension = 300,
    .inertia = {[RD_Z] = 1e-4},
    .left = "z",
    .right = "z",
    .more = 1,
};

double long_string_eigenvalue(size_t k)
{
    const double s = sin((double)k * 3.14159265358979323846 / 2000);
    return 4 * 300 / 1e-4 / 1e-3 * s * s;
}

static void *exact_memory(size_t count, size_t size)
{
    void *memory = calloc(count > 0 ? count : 1, size);
    if (memory == NULL) {
        fprintf(stderr, "the test itself is out of memory\n");
        abort();
    }
    return memory;
}

double *zeros(size_t count)
{
    return exact_memory(count, sizeof(double));
}

static void fill_elements(const struct recipe *recipe, struct rope *rope)
{
    for (size_t k = 0; k < rope->chain.distinct; k++) {
        rope->length[k] = recipe->length;
        rope->tension[k] = recipe->tension;
        rd_section_flexibility(&recipe->section, rope->flexibility + 9 * k);
        for (size_t a = 0; a < rope->chain.width; a++)
            rope->inertia[k * rope->chain.width + a] = recipe->inertia[rope->coordinate[a]];
    }
}

static void fill_terms(const struct recipe *recipe, struct rope *rope)
{
    const size_t w = rope->chain.width;
    for (size_t k = 0; k < rope->chain.terms; k++) {
        const bool end = k == LEFT_END || k == RIGHT_END;
        const char *held = k == LEFT_END ? recipe->left : k == RIGHT_END ? recipe->right : "";
        for (size_t a = 0; a < w; a++) {
            const double inertia = recipe->inertia[rope->coordinate[a]];
            const double lumped = recipe->kind == RD_CONTINUOUS ? 0 : inertia;
            rope->mass[k * w * w + a * (w + 1)] = end ? lumped / 2 : lumped;
            rope->held[k * w + a] = strchr(held, recipe->coordinates[a]) != NULL;
        }
    }
}

struct rope rope_make(const struct recipe *recipe)
{
    const size_t w = strlen(recipe->coordinates);
    const size_t nodes = recipe->elements + 1;
    const size_t distinct = recipe->distinct > 0 ? recipe->distinct : 1;
    const size_t terms = MORE + recipe->more;
    struct rope rope = {
        .coordinate = exact_memory(w, sizeof *rope.coordinate),
        .length = exact_memory(distinct, sizeof *rope.length),
        .tension = exact_memory(distinct, sizeof *rope.tension),
        .flexibility = exact_memory(9 * distinct, sizeof *rope.flexibility),
        .inertia = exact_memory(w * distinct, sizeof *rope.inertia),
        .element_of = exact_memory(recipe->elements, sizeof *rope.element_of),
        .mass = exact_memory(terms * w * w, sizeof *rope.mass),
        .stiffness = exact_memory(terms * w * w, sizeof *rope.stiffness),
        .held = exact_memory(terms * w, sizeof *rope.held),
        .term_of = exact_memory(nodes, sizeof *rope.term_of),
        .first = exact_memory(nodes, sizeof *rope.first),
        .stretch_element = exact_memory(nodes, sizeof *rope.stretch_element),
        .stretch_term = exact_memory(nodes, sizeof *rope.stretch_term),
    };
    rope.chain = (struct rd_chain){
        .nodes = nodes,
        .stretches = nodes,
        .width = w,
        .distinct = distinct,
        .terms = terms,
        .kind = recipe->kind,
        .coordinate = rope.coordinate,
        .length = rope.length,
        .tension = rope.tension,
        .flexibility = rope.flexibility,
        .inertia = recipe->kind == RD_CONTINUOUS ? rope.inertia : NULL,
        .first = rope.first,
        .element = rope.element_of,
        .term = rope.term_of,
        .element_of = rope.element_of,
        .mass = rope.mass,
        .stiffness = rope.stiffness,
        .held = rope.held,
        .term_of = rope.term_of,
    };
    for (size_t a = 0; a < w; a++)
        rope.coordinate[a] = (int32_t)(strchr(names, recipe->coordinates[a]) - names);
    for (size_t i = 0; i < nodes; i++)
        rope.first[i] = (int32_t)i;
    for (size_t i = 0; i < nodes; i++)
        rope.term_of[i] = i == 0 ? LEFT_END : i + 1 < nodes ? INNER : RIGHT_END;
    fill_elements(recipe, &rope);
    fill_terms(recipe, &rope);
    return rope;
}

void rope_free(struct rope *rope)
{
    free(rope->coordinate);
    free(rope->length);
    free(rope->tension);
    free(rope->flexibility);
    free(rope->inertia);
    free(rope->element_of);
    free(rope->mass);
    free(rope->stiffness);
    free(rope->held);
    free(rope->term_of);
    free(rope->first);
    free(rope->stretch_element);
    free(rope->stretch_term);
}

void rope_gather(struct rope *rope)
{
    struct rd_chain *chain = &rope->chain;
    const size_t last = chain->nodes - 1;
    chain->stretches = 0;
    for (size_t i = 0; i <= last; i++) {
        if (i > 0 && i < last && rope->term_of[i] == rope->term_of[i - 1] &&
            rope->element_of[i] == rope->element_of[i - 1])
            continue;
        rope->first[chain->stretches] = (int32_t)i;
        rope->stretch_term[chain->stretches] = rope->term_of[i];
        if (i < last)
            rope->stretch_element[chain->stretches] = rope->element_of[i];
        chain->stretches++;
    }
    chain->element = rope->stretch_element;
    chain->term = rope->stretch_term;
}

size_t rope_find(const struct rd_chain *chain, char coordinate)
{
    size_t a = 0;
    while (a < chain->width && names[chain->coordinate[a]] != coordinate)
        a++;
    return a;
}

double *rope_dense(const struct rd_chain *chain, const double *part)
{
    enum { E = 2 * RD_WIDTH_MAX };
    const size_t w = chain->width;
    const size_t n = chain->nodes * w;
    double *dense = zeros(n * n);
    for (size_t i = 0; i + 1 < chain->nodes; i++) {
        double elastic[E * E], tension[E * E];
        const struct rd_element element = rd_chain_span(chain, rd_stretch_of(chain, i, 0));
        rd_element_stiffness(&element, elastic, tension);
        for (size_t a = 0; a < 2 * w; a++)
            for (size_t b = 0; b < 2 * w; b++)
                dense[(i * w + a) * n + i * w + b] += part[RD_ELASTIC] * elastic[a * 2 * w + b] +
                                                      part[RD_STRING] * tension[a * 2 * w + b];
    }
    for (size_t i = 0; i < chain->nodes; i++)
        for (size_t a = 0; a < w; a++)
            for (size_t b = 0; b < w; b++) {
                const size_t at = ((size_t)chain->term_of[i] * w + a) * w + b;
                dense[(i * w + a) * n + i * w + b] +=
                    part[RD_SPRINGS] * chain->stiffness[at] + part[RD_MASS] * chain->mass[at] +
                    (chain->damping ? part[RD_DASHPOTS] * chain->damping[at] : 0);
            }
    return dense;
}

struct rd_workspace exact_workspace(size_t bytes)
{
    char *base = malloc(bytes);
    if (base == NULL && bytes > 0)
        abort();
    return (struct rd_workspace){.base = base, .size = bytes};
}
