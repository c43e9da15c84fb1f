/* The kernels of a march for width 3. */
#define RD_WIDTH 3
#include "march/kernel/width.h"
