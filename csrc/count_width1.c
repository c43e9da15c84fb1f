/* The count for chains of width 1. */
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC optimize("O3") /* two thirds of the time of -O2 */
#endif
#define RD_WAVE_WIDTH 1
#define WIDTH(name) rd_##name##_1
#include "count_width.h"
