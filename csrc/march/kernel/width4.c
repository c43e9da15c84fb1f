/* The kernels of a march for width 4. */
#define RD_WIDTH 4
#include "march/kernel/width.h"
