/* The count for chains of width 2. */
#define RD_WAVE_WIDTH 2
#include "modes/count/width.h"
