/* The kernels of a march for width 1. */
#define RD_WIDTH 1
#include "march/kernel/width.h"
