/* The sweep's kernel for width 3. */
#define RD_WIDTH 3
#include "sweep/kernel/width.h"
