/* Inverse iteration for chains of width 2. */
#include "base/fast.h"
#if RD_FAST
#pragma GCC optimize("O3") /* two thirds of the time of -O2 */
#endif
#define RD_WAVE_WIDTH 2
#define WIDTH(name) rd_##name##_2
#include "modes/refine/width.h"
