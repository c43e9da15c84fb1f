/* The inner operations of a march, one table of them per width. */
#ifndef RD_MARCH_KERNEL_H
#define RD_MARCH_KERNEL_H

#include "march/form/state.h"

/* the kernels, by width */
struct rd_march_kernel {
    enum rd_status (*factor)(struct rd_march *march);
    void (*rest)(struct rd_march *march);
    void (*solve)(struct rd_march *march, const double *p, bool moved, double *u, double *f);
    void (*residual)(struct rd_march *march);
    void (*energy)(const struct rd_march *march, double *energy);
    double (*dissipate)(const struct rd_march *march);
};

extern const struct rd_march_kernel rd_march_kernel_1, rd_march_kernel_2, rd_march_kernel_3,
    rd_march_kernel_4;

#endif
