/* The count for chains of width 3. */
#define RD_WAVE_WIDTH 3
#define WIDTH(name) rd_##name##_3
#include "modes/count/width.h"
