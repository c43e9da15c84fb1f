/* The sweep's kernel for width 4. */
#define RD_WIDTH 4
#include "sweep/kernel/width.h"
