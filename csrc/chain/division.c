/* Dividing spans into elements. */
#include "chain/division.h"

#include <stdbool.h>
#include <stdlib.h>

static int by_span(const struct rd_span_key *a, const struct rd_span_key *b)
{
    return (a->span > b->span) - (a->span < b->span);
}

static int by_length(const void *left, const void *right)
{
    const struct rd_span_key *a = left, *b = right;
    const int order = (a->length > b->length) - (a->length < b->length);
    return order ? order : by_span(a, b);
}

static int by_group(const void *left, const void *right)
{
    const struct rd_span_key *a = left, *b = right;
    const int order = (a->group > b->group) - (a->group < b->group);
    const int other = (a->rope > b->rope) - (a->rope < b->rope);
    return order ? order : other ? other : by_span(a, b);
}

/* numbers the lengths that differ by more than rounding, from the shortest */
static void group_lengths(const struct rd_spans *spans, double rounding,
                          struct rd_division *division)
{
    struct rd_span_key *key = division->key;
    for (size_t s = 0; s < spans->count; s++) {
        const double length = spans->station[s + 1] - spans->station[s];
        key[s] = (struct rd_span_key){length / (double)spans->elements[s], spans->rope[s], s, 0};
    }
    qsort(key, spans->count, sizeof *key, by_length);
    for (size_t k = 1; k < spans->count; k++)
        key[k].group = key[k - 1].group + (key[k].length - key[k - 1].length > rounding);
    for (size_t k = 0; k < spans->count; k++) {
        division->group[key[k].span] = key[k].group;
        division->total[key[k].group] = division->number[key[k].group] = 0.0;
    }
    for (size_t s = 0; s < spans->count; s++) {
        division->total[division->group[s]] += spans->station[s + 1] - spans->station[s];
        division->number[division->group[s]] += (double)spans->elements[s];
    }
}

/* finds the first span that is like each */
static void find_heads(const struct rd_spans *spans, struct rd_division *division)
{
    struct rd_span_key *key = division->key;
    /* spans that are alike come one after the other, in order */
    qsort(key, spans->count, sizeof *key, by_group);
    for (size_t k = 0; k < spans->count; k++) {
        const bool alike =
            k > 0 && key[k].group == key[k - 1].group && key[k].rope == key[k - 1].rope;
        division->head[key[k].span] = alike ? division->head[key[k - 1].span] : key[k].span;
    }
}

void rd_division_tell(const struct rd_spans *spans, double rounding, struct rd_division *division)
{
    group_lengths(spans, rounding, division);
    find_heads(spans, division);
    size_t distinct = 0, inside = 0;
    for (size_t s = 0; s < spans->count; s++) {
        if (division->head[s] == s) {
            const size_t group = division->group[s];
            division->span[distinct] = (int64_t)s;
            division->length[distinct] = division->total[group] / division->number[group];
            division->term[distinct] = 0;
            division->which[s] = (int32_t)distinct++;
        }
        division->which[s] = division->which[division->head[s]];
        division->term[division->which[s]] |= spans->elements[s] > 1;
    }
    for (size_t e = 0; e < distinct; e++)
        if (division->term[e]) {
            division->term[e] = (int32_t)(spans->count + 1 + inside);
            division->within[inside++] = (int64_t)e;
        }
    division->distinct = distinct;
    division->inside = inside;
}

size_t rd_division_elements(const struct rd_spans *spans)
{
    size_t elements = 0;
    for (size_t s = 0; s < spans->count; s++)
        elements += (size_t)spans->elements[s];
    return elements;
}

size_t rd_division_stretches(const struct rd_spans *spans)
{
    size_t stretches = spans->count + 1;
    for (size_t s = 0; s < spans->count; s++)
        stretches += spans->elements[s] > 1;
    return stretches;
}

void rd_division_lay(const struct rd_spans *spans, const struct rd_division *division,
                     int32_t *first, int32_t *element, int32_t *term, double *x)
{
    size_t stretch = 0, node = 0;
    for (size_t s = 0; s < spans->count; s++) {
        const size_t elements = (size_t)spans->elements[s];
        const double step = (spans->station[s + 1] - spans->station[s]) / (double)elements;
        for (size_t i = 0; i < elements; i++)
            x[node + i] = spans->station[s] + (double)i * step;
        for (size_t i = 0; i < 1 + (elements > 1); i++) {
            first[stretch] = (int32_t)(node + i);
            element[stretch] = division->which[s];
            term[stretch++] = i ? division->term[division->which[s]] : (int32_t)s;
        }
        node += elements;
    }
    first[stretch] = (int32_t)node;
    term[stretch] = (int32_t)spans->count;
    x[node] = spans->station[spans->count];
}
