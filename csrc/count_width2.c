/* The count for chains of width 2. */
#include "fast.h"
#if RD_FAST
#pragma GCC optimize("O3") /* two thirds of the time of -O2 */
#endif
#define RD_WAVE_WIDTH 2
#define WIDTH(name) rd_##name##_2
#include "count_width.h"
