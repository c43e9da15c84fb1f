/* A chain made ready for the assembled solvers. */
#ifndef RD_SYSTEM_H
#define RD_SYSTEM_H

#include "assembled/band.h"
#include "base/workspace.h"
#include "chain/ports.h"

struct rd_system {
    struct rd_assembly assembly;
    size_t free;     /* coordinates that can move */
    size_t reach;    /* largest distance of two that meet */
    int32_t *number; /* (nodes, width) number of a free coordinate, -1 where held */
    double *scale;   /* (free) */
};

/* Takes the system's arrays from the workspace; while that measures, nothing is filled. */
enum rd_status rd_system_prepare(const struct rd_chain *chain, struct rd_system *system,
                                 struct rd_workspace *workspace);

/* load (free, complex where stride is 2) <- scale * row^T of port p; the rest is zeroed */
void rd_port_load(const struct rd_system *system, const struct rd_ports *ports, size_t p,
                  size_t stride, double *load);

/* the port's displacement from the scaled u (free, every stride-th number) */
double rd_port_read(const struct rd_system *system, const struct rd_ports *ports, size_t p,
                    size_t stride, const double *u);

#endif
