/* Lines side by side, and the fields whose products are taken there. */
#ifndef RD_LINES_H
#define RD_LINES_H

#include "base/lanes.h"
#include "chain/chain.h"

/* RD_LANES lines of the dynamic stiffness Z, given by its complex factors (sweep/scale.h); a mode is
   one with the factors 1 and inertia = -lambda. Lanes from `count` on repeat the last line. */
struct rd_lines {
    size_t first, count;                           /* among all lines */
    cv section, tension, spring, inertia, dashpot; /* factors */
};

/* Motion (loads, nodes, width) of the nodes at every line, anywhere in memory: strides of doubles.
   Where `forces` are told too it is (loads, nodes, 2, width), with the force on the right end of the
   element on the left of each node, and continuous elements may be of any length.
   A load may slip: element slip[0] of it ends at slip[1] (0: left, 1: right) apart from the node
   there, which moves by 1 more in coordinate slip[2] at the right end and by 1 less at the left. Or,
   slip[1] = RD_PUSHED, it is a unit force on node slip[0] along coordinate slip[2]. */
enum { RD_PUSHED = 2 };

struct rd_fields {
    const double *value;
    size_t loads;
    size_t line, load, entry; /* strides */
    size_t parts;             /* of a number: 1 real, 2 complex */
    _Bool forces;
    const int32_t *slip;  /* (loads, 3), element -1: none; or NULL */
    const double *motion; /* (lines, attached) y of the structures (chain/attached.h), of modes; or
                             NULL: what their feet make of it */
};

/* which load with which */
struct rd_pairs {
    size_t count;
    const int32_t *of; /* (count, 2) */
};

/* numbers of a node */
static inline size_t rd_field_rows(const struct rd_fields *fields, size_t width)
{
    return fields->forces ? 2 * width : width;
}

/* entry i of all of a load in the lanes of these lines */
static inline cv rd_field_at(const struct rd_fields *fields, const struct rd_lines *lines,
                             size_t load, size_t i)
{
    cv x = {{0}, {0}};
    const double *at = fields->value + load * fields->load + i * fields->entry;
    if (lines->count == RD_LANES && fields->line == 2 && fields->parts == 2) {
        at += 2 * lines->first;
        for (size_t k = 0; k < RD_LANES; k++) {
            x.re[k] = at[2 * k];
            x.im[k] = at[2 * k + 1];
        }
        return x;
    }
    for (size_t k = 0; k < RD_LANES; k++) {
        const size_t line = lines->first + (k < lines->count ? k : lines->count - 1);
        x.re[k] = at[line * fields->line];
        x.im[k] = fields->parts == 2 ? at[line * fields->line + 1] : 0;
    }
    return x;
}

#endif
