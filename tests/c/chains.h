/* Chains for tests: a uniform rope from a recipe, every array of its own exact size. */
#ifndef CHAINS_H
#define CHAINS_H

#include "base/workspace.h"
#include "chain/chain.h"
#include "element/section.h"

/* What the nodes of a chain carry: term 0 the left end, 1 the inner nodes, 2 the right end, and
   from there `more` free copies of term 1 for the test to change. */
enum { LEFT_END, INNER, RIGHT_END, MORE };

struct recipe {
    enum rd_kind kind;
    size_t elements;
    const char *coordinates; /* of "xzab", increasing: x, z, alpha, beta */
    double length;           /* [m] of one element */
    double tension;          /* [N] */
    struct rd_section section;
    double
        inertia[RD_WIDTH_MAX]; /* by enum rd_coordinate: of an inner node, ends carry half; or per
                                     length of continuous elements, whose nodes have none */
    const char *left, *right;  /* held coordinates of the ends, "" where free */
    size_t distinct;           /* copies of the element for the test to change, 0: one */
    size_t more;
};

/* a chain whose arrays may be changed before it is used */
struct rope {
    struct rd_chain chain; /* views of: */
    int32_t *coordinate;
    double *length;
    double *tension;
    double *flexibility;
    double *inertia;
    int32_t *element_of;
    double *mass;
    double *stiffness;
    uint8_t *held;
    int32_t *term_of;
    int32_t *first; /* every node a stretch of its own, until rope_gather */
    int32_t *stretch_element;
    int32_t *stretch_term;
};

/* a thousand elements of 1 mm, 1e-4 kg between them, under 300 N, both ends held */
extern const struct recipe long_string;

/* its eigenvalue k = 1, 2, ...: (4 T/m l) sin^2(k pi/2n) */
double long_string_eigenvalue(size_t k);

struct rope rope_make(const struct recipe *recipe);
void rope_free(struct rope *rope);

/* equal nodes with equal elements on their right become one stretch; after the last change */
void rope_gather(struct rope *rope);

/* position of coordinate 'x', 'z', 'a' or 'b' in a node of the chain */
size_t rope_find(const struct rd_chain *chain, char coordinate);

/* K or M (n, n), n = nodes width, from rd_element_stiffness and the node terms, entry by entry;
   the caller's to free. part: what of it, e.g. { [RD_ELASTIC] = 1 } */
double *rope_dense(const struct rd_chain *chain, const double *part);

/* an empty workspace of exactly `bytes` at the end of a block of its own, so that valgrind and
   AddressSanitizer see every byte written outside; free(workspace.base) */
struct rd_workspace exact_workspace(size_t bytes);

/* `count` numbers of zero, the caller's to free */
double *zeros(size_t count);

#endif
