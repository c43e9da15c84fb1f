/* The count for chains of width 2. */
#define RD_WAVE_WIDTH 2
#define WIDTH(name) rd_##name##_2
#include "count_width.h"
