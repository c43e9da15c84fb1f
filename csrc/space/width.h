/* What is compiled once for each number of coordinates that move together, WIDE = 3 or 6. */
#ifndef RD_SPACE_WIDTH_H
#define RD_SPACE_WIDTH_H

#include "base/lanes.h"
#include "space/space.h"

#define RD_SPACE_NAMED(verb, wide) rd_space_##verb##_##wide
#define RD_SPACE_NAME(verb, wide) RD_SPACE_NAMED(verb, wide)
#define RD_SPACE_(verb) RD_SPACE_NAME(verb, WIDE)

typedef enum rd_status rd_space_triples_of(const struct rd_space_run *run, size_t lines,
                                           const double _Complex *rates, int doublings,
                                           double gentle, double _Complex *triple, int *reached,
                                           int *whole, struct rd_workspace *workspace);
typedef enum rd_status rd_space_respond_of(const struct rd_space_band *band, size_t columns,
                                           double _Complex *x, struct rd_workspace *workspace);
typedef enum rd_status rd_space_count_of(const struct rd_space *rope, size_t count,
                                         const int32_t *component, const double *lambda,
                                         const double *z, double *below,
                                         struct rd_workspace *workspace);

/* The parts of a piece at RD_LANES real lines: E (fields, 3, width, width, RD_LANES) of the series' fields,
   at (RD_LANES, RD_SPACE_NODES, 3, width, width), doubled as rd_space_triples does. Returns how often; work of
   rd_space_family_room(width) lanes. */
typedef int rd_space_family_of(const struct rd_space_run *run, const lanes *E, int doublings,
                               double gentle, double *at, lanes *work);

static inline size_t rd_space_family_room(size_t width)
{
    return 2 * RD_SPACE_NODES * rd_space_triple(width);
}

rd_space_family_of rd_space_family_3, rd_space_family_6;
rd_space_triples_of rd_space_triples_3, rd_space_triples_6;
rd_space_respond_of rd_space_respond_3, rd_space_respond_6;
rd_space_count_of rd_space_count_3, rd_space_count_6;

#endif
