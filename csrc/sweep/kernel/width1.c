/* The sweep's kernel for width 1. */
#define RD_WIDTH 1
#include "sweep/kernel/width.h"
