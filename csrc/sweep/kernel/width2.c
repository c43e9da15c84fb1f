/* The sweep's kernel for width 2. */
#define RD_WIDTH 2
#include "sweep/kernel/width.h"
