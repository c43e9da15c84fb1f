/* Motions of the whole chain that nothing resists. */
#ifndef RD_RIGID_H
#define RD_RIGID_H

#include "modes/walk/walk.h"

struct rd_rigid {
    size_t count;
    double motion[RD_WIDTH_MAX][RD_WIDTH_MAX]; /* (width, count): of the left end, M-orthonormal */
};

/* The motions c of the left end, carried along by F alone, whose Q, springs and held coordinates
   give no force anywhere. RD_UNSTABLE_MASSLESS where one of them moves no mass. */
enum rd_status rd_rigid_fill(const struct rd_walk *walk, struct rd_rigid *rigid);

/* u (nodes, width) of motion k, and y (attached, of chain/attached.h) of the structures that nodes
   carry */
void rd_rigid_shape(const struct rd_walk *walk, const struct rd_rigid *rigid, size_t k, double *u,
                    double *y);

#endif
