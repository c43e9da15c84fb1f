/* Spans between stations divided into equal elements: which differ, and the stretches they make. */
#ifndef RD_DIVISION_H
#define RD_DIVISION_H

#include <stddef.h>
#include <stdint.h>

struct rd_spans {
    size_t count;
    const double *station;   /* (count + 1) increasing [m] */
    const int64_t *elements; /* (count) of each span, at least 1 */
    const int64_t *rope;     /* (count) which rope it is of */
};

/* what tells a span apart */
struct rd_span_key {
    double length; /* of its elements [m] */
    int64_t rope;
    size_t span;
    size_t group; /* of those as long but for rounding */
};

/* room for telling spans apart, and what is told */
struct rd_division {
    struct rd_span_key *key; /* (count) */
    size_t *group;           /* (count) */
    double *total, *number;  /* (count) length [m] and elements of each group */
    size_t *head;            /* (count) the first span like it */
    size_t distinct, inside;
    int32_t *which;  /* (count) the distinct element of each span, in the order they come in */
    int64_t *span;   /* (distinct) the first span of each */
    double *length;  /* (distinct) [m] */
    int32_t *term;   /* (distinct) node term inside spans; those of stations are 0 .. count */
    int64_t *within; /* (inside) distinct elements that have nodes inside spans, increasing */
};

/* Tells the distinct elements: each of one rope, and as long as the others but for `rounding` [m]
   from one to the next in order; its length is the mean of all that are as long. All arrays have
   room for count entries. */
void rd_division_tell(const struct rd_spans *spans, double rounding, struct rd_division *division);

/* Elements of all spans, and stretches of the chain: a station is one, and so are the nodes inside
   a span if there are any. */
size_t rd_division_elements(const struct rd_spans *spans);
size_t rd_division_stretches(const struct rd_spans *spans);

/* The stretches as in chain.h: first and term (stretches), element (stretches - 1); and x
   (elements + 1), where the nodes stand [m]. */
void rd_division_lay(const struct rd_spans *spans, const struct rd_division *division,
                     int32_t *first, int32_t *element, int32_t *term, double *x);

#endif
