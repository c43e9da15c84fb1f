/* Where something is pushed or watched. */
#ifndef RD_PORTS_H
#define RD_PORTS_H

#include <stddef.h>
#include <stdint.h>

/* A row over the coordinates of two neighbouring nodes, and one over the internal force between
   them; as a drive the force row is a dislocation. */
struct rd_ports {
    size_t count;
    const int32_t *node; /* (count)            left node */
    const double *row;   /* (count, 2, width)  displacement = row (u_node, u_node+1) */
    const double *force; /* (count, width)     + force f_b on the right end of element `node`,
                                               or NULL */
};

#endif
