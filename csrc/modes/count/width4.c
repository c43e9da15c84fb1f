/* The count for chains of width 4. */
#define RD_WAVE_WIDTH 4
#include "modes/count/width.h"
