/* What is compiled once for each number of coordinates that move together, WIDE = 3 or 6. */
#ifndef RD_SPACE_WIDTH_H
#define RD_SPACE_WIDTH_H

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

rd_space_triples_of rd_space_triples_3, rd_space_triples_6;
rd_space_respond_of rd_space_respond_3, rd_space_respond_6;
rd_space_count_of rd_space_count_3, rd_space_count_6;

#endif
