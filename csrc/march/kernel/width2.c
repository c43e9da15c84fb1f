/* The kernels of a march for width 2. */
#define RD_WIDTH 2
#include "march/kernel/width.h"
