/* Inverse iteration for chains of width 1. */
#include "base/fast.h"
#if RD_FAST
#pragma GCC optimize("O3") /* two thirds of the time of -O2 */
#endif
#define RD_WAVE_WIDTH 1
#define WIDTH(name) rd_##name##_1
#include "modes/refine/width.h"
