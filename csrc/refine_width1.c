/* Inverse iteration for chains of width 1. */
#define RD_WAVE_WIDTH 1
#define WIDTH(name) rd_##name##_1
#include "refine_width.h"
