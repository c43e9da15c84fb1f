/* The count for chains of width 2. */
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC optimize("O3") /* two thirds of the time of -O2 */
#endif
#define RD_WAVE_WIDTH 2
#define WIDTH(name) rd_##name##_2
#include "count_width.h"
